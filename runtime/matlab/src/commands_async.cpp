// SPDX-License-Identifier: Apache-2.0
// Members that are called without waiting: `object.async_move(arguments..., handler, parameter,
// seconds)`.
#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/matlab/src/access.hpp"
#include "runtime/matlab/src/completions.hpp"

namespace rr::matlab {
namespace {

using dynamic::Value;

struct AsyncCall {
  std::shared_ptr<ObjectHandle> object;
  const Resolved* member;
  std::vector<const mxArray*> arguments;
};

void start_value(const AsyncCall& call, const Completions& completions,
                 const std::function<void(dynamic::Done<Value>)>& start) {
  start([completions, object = call.object, plan = call.member->plan](std::exception_ptr error,
                                                                      const Value& value) {
    completions.end(std::move(error), [object, plan, value]() -> mxArray* {
      if (plan == nullptr) return make_null();
      return to_mex(value, *plan, object->connection()->plans);
    });
  });
}

void start(Runtime& runtime, const AsyncCall& call, const Completions& completions) {
  const dynamic::Object& object = call.object->object();
  const Resolved& member = *call.member;
  const std::string& name = member.member.name;
  switch (member.use) {
    case Use::get:
      return start_value(call, completions,
                         [&](auto done) { object.async_get(name, std::move(done)); });
    case Use::set: {
      if (call.arguments.size() != 1) {
        throw Error(ErrorCode::invalid_argument, member.subject + ": expected one value");
      }
      const Value value = read_value(*call.object, call.arguments[0], member.plan, member.subject);
      return object.async_set(name, value, [completions](std::exception_ptr error) {
        completions.end(std::move(error), [] { return make_null(); });
      });
    }
    case Use::call: {
      const dynamic::List arguments = read_arguments(*call.object, member, call.arguments);
      return start_value(call, completions,
                         [&](auto done) { object.async_call(name, arguments, std::move(done)); });
    }
    case Use::generate: {
      const dynamic::List arguments = read_arguments(*call.object, member, call.arguments);
      return object.async_generate(
          name, arguments,
          [&runtime, completions, from = call.object, member](std::exception_ptr error,
                                                              const dynamic::Generator& generator) {
            completions.end(std::move(error), [&runtime, from, member, generator] {
              return call_function("RobotRaconteurGenerator",
                                   {give_generator(runtime, *from, member, generator)});
            });
          });
    }
    case Use::object: {
      const Value index = read_index(member, call.arguments.empty() ? nullptr : call.arguments[0]);
      return object.async_object(name, index,
                                 [&runtime, completions, connection = call.object->connection()](
                                     std::exception_ptr error, const dynamic::Object& found) {
                                   completions.end(std::move(error), [&runtime, connection, found] {
                                     return wrap_object(give_object(runtime, connection, found));
                                   });
                                 });
    }
    default:
      throw Error(ErrorCode::member_format_mismatch,
                  member.subject + ": it has no asynchronous form");
  }
}

// How many arguments stand before the handler.
std::size_t parameter_count(const Resolved& member) {
  if (member.use == Use::set) return 1;
  if (member.use == Use::object) return member.member.index == IndexForm::none ? 0 : 1;
  return member.parameters.size();
}

// async(object, name, arguments..., function, function's parameter, seconds)
void async(Runtime& runtime, Call& call) {
  start_member(runtime, object_of(runtime, call), call.text(1), call.rest(2));
}

}  // namespace

void start_member(Runtime& runtime, const std::shared_ptr<ObjectHandle>& object,
                  const std::string& name, std::span<const mxArray* const> given) {
  const Resolved& member = object->resolve(name);
  const std::size_t count = std::min(parameter_count(member), given.size());
  const auto behind = given.subspan(count);
  if (behind.size() > 3) {
    throw Error(ErrorCode::invalid_argument, "async_" + name + ": expected " +
                                                 std::to_string(count) +
                                                 " arguments, then handler, parameter, seconds");
  }
  const auto seconds = behind.size() > 2 ? to_milliseconds(read_number<double>(behind[2]))
                                         : std::chrono::milliseconds::max();
  const mxArray* const none = make_null();
  const Handler handler{behind.empty() ? none : behind[0], behind.size() > 1 ? behind[1] : none};
  const AsyncCall made{
      object, &member, {given.begin(), given.begin() + static_cast<std::ptrdiff_t>(count)}};
  start_call(runtime, object->connection(), handler, seconds,
             [&](const Completions& completions) { start(runtime, made, completions); });
}

std::vector<Command> async_commands() { return {{"async", async}}; }

}  // namespace rr::matlab
