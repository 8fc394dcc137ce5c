// SPDX-License-Identifier: Apache-2.0
// Members that are called without waiting: `object.async_move(arguments..., handler, parameter,
// seconds)`.
#include "rr/error.hpp"
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
                                                              dynamic::Generator generator) {
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

// async(object, name, function, function's parameter, seconds, arguments...)
void async(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  AsyncCall made{object, &object->resolve(call.text(1)), {}};
  for (std::size_t i = 5; i < call.size(); ++i) made.arguments.push_back(call[i]);
  start_call(runtime, object->connection(), {call[2], call[3]}, call.seconds(4),
             [&](const Completions& completions) { start(runtime, made, completions); });
}

// parameter_count(object, name): how many arguments stand before the handler
void parameter_count(Runtime& runtime, Call& call) {
  const Resolved& member = object_of(runtime, call)->resolve(call.text(1));
  std::size_t count = member.parameters.size();
  if (member.use == Use::set) count = 1;
  if (member.use == Use::object) count = member.member.index == IndexForm::none ? 0 : 1;
  call.give(mxCreateDoubleScalar(static_cast<double>(count)));
}

}  // namespace

std::vector<Command> async_commands() {
  return {{"async", async}, {"parameter_count", parameter_count}};
}

}  // namespace rr::matlab
