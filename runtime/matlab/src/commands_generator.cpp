// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"
#include "runtime/matlab/src/completions.hpp"
#include "runtime/matlab/src/members.hpp"

namespace rr::matlab {
namespace {

using dynamic::Generator;
using dynamic::Value;

struct GeneratorHandle final : MemberHandle {
  GeneratorHandle(const ObjectHandle& object, const Resolved& of, Generator given)
      : MemberHandle(object, of),
        generator(std::move(given)),
        parameter(connection->plans.plan(of.member.generator_parameter)) {}
  Generator generator;
  const TypePlan* const parameter;
};

std::shared_ptr<GeneratorHandle> generator_of(Runtime& runtime, Call& call) {
  return handle_of<GeneratorHandle>(runtime, call);
}

Value parameter_of(const GeneratorHandle& handle, Call& call, std::size_t index) {
  if (!call.has(index)) return {};
  if (handle.parameter == nullptr) {
    throw Error(ErrorCode::invalid_argument, handle.subject + ": its steps take no value");
  }
  return handle.read(call[index], handle.parameter);
}

// generator_next(generator [, parameter]): [is_there, value]
void next(Runtime& runtime, Call& call) {
  const auto handle = generator_of(runtime, call);
  const Value parameter = parameter_of(*handle, call, 1);
  const auto value = runtime.call<std::optional<Value>>(
      [&] { return handle->generator.next(parameter); },
      [&](auto done) { handle->generator.async_next(parameter, done); });
  call.give(mxCreateLogicalScalar(value.has_value()));
  call.give(value ? handle->write(*value) : make_null());
}

// generator_async_next(generator, function, function's parameter, seconds [, parameter])
void async_next(Runtime& runtime, Call& call) {
  const auto handle = generator_of(runtime, call);
  const Value parameter = parameter_of(*handle, call, 4);
  start_call(runtime, handle->connection, {call[1], call[2]}, call.seconds(3),
             [&](const Completions& completions) {
               handle->generator.async_next(
                   parameter, [completions, handle](std::exception_ptr error,
                                                    const std::optional<Value>& value) {
                     if (!error && !value) {
                       error = std::make_exception_ptr(
                           Error(ErrorCode::stop_iteration, "the generator has ended"));
                     }
                     completions.end(error, [handle, value] { return handle->write(*value); });
                   });
             });
}

// generator_end(generator, is_abort)
void end(Runtime& runtime, Call& call) {
  const auto handle = generator_of(runtime, call);
  const bool is_abort = read_number<bool>(call[1]);
  Generator& generator = handle->generator;
  runtime.call<>(
      [&] { is_abort ? generator.abort() : generator.close(); },
      [&](auto done) { is_abort ? generator.async_abort(done) : generator.async_close(done); });
}

}  // namespace

mxArray* give_generator(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
                        Generator generator) {
  return give_handle(runtime,
                     std::make_shared<GeneratorHandle>(object, member, std::move(generator)));
}

std::vector<Command> generator_commands() {
  return {{"generator_next", next}, {"generator_async_next", async_next}, {"generator_end", end}};
}

}  // namespace rr::matlab
