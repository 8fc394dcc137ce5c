// SPDX-License-Identifier: Apache-2.0
// Events, callbacks, and the queue that brings both to the interpreter's thread.
#include "rr/error.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {
namespace {

using dynamic::List;
using dynamic::Value;

// On the interpreter's thread.
void deliver(Runtime& runtime, std::uint64_t number, const List& arguments) {
  const UserFunction* const function = runtime.functions().find(number);
  const auto connection = function != nullptr ? function->connection.lock() : nullptr;
  if (!connection) return;
  UserFunctions::run_alone(function->function,
                           write_arguments(function->member, arguments, *connection));
}

// listen(object, event, function): number of the listener
void listen_to_event(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const Resolved& member = object->resolve(call.text(1));
  const auto& connection = object->connection();
  const std::uint64_t number =
      connection->add({.function = Kept(need_function(call[2], member.subject)),
                       .parameter = {},
                       .member = member.member,
                       .connection = connection,
                       .subscription = nullptr});
  try {
    auto subscription = object->object().on_event(
        member.member.name, [&runtime, number, queue = runtime.queue(),
                             has_events = connection->has_events](const List& arguments) {
          if (!*has_events) return;
          queue->push([&runtime, number, arguments] { deliver(runtime, number, arguments); });
        });
    runtime.functions().find(number)->subscription =
        std::make_shared<Subscription>(std::move(subscription));
  } catch (...) {
    connection->remove(number);
    throw;
  }
  call.give(make_number(number));
}

// unlisten(number)
void unlisten(Runtime& runtime, Call& call) {
  const std::uint64_t number = call.handle(0);
  const UserFunction* const function = runtime.functions().find(number);
  if (function == nullptr) return;
  if (const auto connection = function->connection.lock()) {
    connection->remove(number);
  } else {
    runtime.functions().remove(number);
  }
}

// events(object, is_on)
void events(Runtime& runtime, Call& call) {
  *object_of(runtime, call)->connection()->has_events = read_number<bool>(call[1]);
}

// poll(seconds): how many handlers have run
void poll(Runtime& runtime, Call& call) {
  const auto limit = call.has(0) ? call.seconds(0) : std::chrono::milliseconds(0);
  const std::uint64_t served = runtime.served_count;
  std::size_t count = runtime.run_queue();
  const auto is_busy = [&] {
    return runtime.queue()->size() != 0 || runtime.served_count != served;
  };
  if (count == 0 && limit.count() != 0) {
    const bool has_come = runtime.wait_until(is_busy, limit);
    if (has_come) count = runtime.run_queue();
  }
  count += static_cast<std::size_t>(runtime.served_count - served);
  call.give(mxCreateDoubleScalar(static_cast<double>(count)));
}

// poll_prompt(): the same without waiting; mex.cpp does not make a node for it
void poll_prompt(Runtime& runtime, Call& call) {
  call.give(mxCreateDoubleScalar(static_cast<double>(runtime.run_queue())));
}

// lost(): events that were lost because too many waited
void lost(Runtime& runtime, Call& call) {
  call.give(mxCreateDoubleScalar(static_cast<double>(runtime.queue()->lost_count())));
}

std::string callback_key(const ObjectHandle& object, const Resolved& member) {
  return object.object().path() + " " + member.member.name;
}

}  // namespace

mxArray* callback_function(const ObjectHandle& object, const Resolved& member) {
  Connection& connection = *object.connection();
  const auto found = connection.callbacks.find(callback_key(object, member));
  if (found == connection.callbacks.end()) return make_null();
  return mxDuplicateArray(connection.runtime().functions().find(found->second)->function.get());
}

void set_callback(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
                  const mxArray* function) {
  const auto& connection = object.connection();
  const std::string key = callback_key(object, member);
  const dynamic::Callback callback = object.object().callback(member.member.name);
  const auto before = connection->callbacks.find(key);
  if (before != connection->callbacks.end()) {
    connection->remove(before->second);  // first: clear() waits for what runs
    connection->callbacks.erase(before);
    callback.clear();
  }
  if (is_null(function)) return;
  const std::uint64_t number =
      connection->add({.function = Kept(need_function(function, member.subject)),
                       .parameter = {},
                       .is_waited_for = true,
                       .member = member.member,
                       .connection = connection,
                       .subscription = nullptr});
  connection->callbacks.emplace(key, number);
  // Who ends it first says so, then ends what is in the queue; so nothing that is put in waits for
  // ever.
  callback.set(
      [number, queue = runtime.queue(),
       is_open = runtime.functions().find(number)->is_open](const List& arguments) -> Value {
        const auto pending = std::make_shared<PendingCall>(number, arguments);
        queue->push(pending);
        if (!*is_open) queue->abort_calls(number);
        return pending->wait();
      });
}

std::vector<Command> event_commands() {
  return {{"listen", listen_to_event},  {"unlisten", unlisten}, {"events", events}, {"poll", poll},
          {"poll_prompt", poll_prompt}, {"lost", lost}};
}

}  // namespace rr::matlab
