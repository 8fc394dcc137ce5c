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
      [&](auto done) { handle->generator.async_next(parameter, std::move(done)); });
  call.give(mxCreateLogicalScalar(value.has_value()));
  call.give(value ? handle->write(*value) : make_null());
}

// What an array takes in memory, with what is in it: bytes.
std::size_t memory_of(const mxArray* array) {
  constexpr std::size_t header = 96;  // of each array, about
  std::size_t total = header;
  const std::size_t count = count_of(array);
  if (mxIsCell(array)) {
    for (std::size_t i = 0; i < count; ++i) {
      const mxArray* const cell = mxGetCell(array, static_cast<mwIndex>(i));
      total += sizeof(void*) + (cell != nullptr ? memory_of(cell) : 0);
    }
  } else if (mxIsStruct(array)) {
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < mxGetNumberOfFields(array); ++k) {
        const mxArray* const field = mxGetFieldByNumber(array, static_cast<mwIndex>(i), k);
        total += sizeof(void*) + (field != nullptr ? memory_of(field) : 0);
      }
    }
  } else if (mxIsNumeric(array) || mxIsLogical(array) || mxIsChar(array)) {
    total += count * mxGetElementSize(array);
  }
  return total;
}

// generator_all(generator, bytes): all values that are left, in cells. `[]` for bytes: the limit of
// the node's sessions.
void all(Runtime& runtime, Call& call) {
  const auto handle = generator_of(runtime, call);
  double limit = static_cast<double>(runtime.generator_limit);
  if (call.has(1) && !is_null(call[1])) limit = read_number<double>(call[1]);
  std::vector<mxArray*> values;
  double received = 0;
  while (true) {
    const auto value = runtime.call<std::optional<Value>>(
        [&] { return handle->generator.next(); },
        [&](auto done) { handle->generator.async_next({}, std::move(done)); });
    if (!value) return call.give(make_cells(values));
    values.push_back(handle->write(*value));
    received += static_cast<double>(memory_of(values.back()));
    if (!(received <= limit)) break;
  }
  for (mxArray* const value : values) mxDestroyArray(value);
  throw Error(ErrorCode::out_of_system_resource,
              "all values of `" + handle->member.name + "` are more than " +
                  std::to_string(static_cast<std::uint64_t>(limit)) +
                  " bytes; NextAll takes a limit, and Next has none");
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
  runtime.call<>([&] { is_abort ? generator.abort() : generator.close(); },
                 [&](auto done) {
                   is_abort ? generator.async_abort(std::move(done))
                            : generator.async_close(std::move(done));
                 });
}

}  // namespace

mxArray* give_generator(Runtime& runtime, const ObjectHandle& object, const Resolved& member,
                        Generator generator) {
  return give_handle(runtime,
                     std::make_shared<GeneratorHandle>(object, member, std::move(generator)));
}

std::vector<Command> generator_commands() {
  return {{"generator_next", next},
          {"generator_all", all},
          {"generator_async_next", async_next},
          {"generator_end", end}};
}

}  // namespace rr::matlab
