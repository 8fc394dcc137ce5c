// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/members.hpp"

namespace rr::matlab {
namespace {

using dynamic::Memory;
using dynamic::Value;

// Positions and counts.
Memory::Numbers numbers_of(const mxArray* given) { return read_vector<std::uint64_t>(given); }

// memory_dims(object, name): a row of sizes
void dims(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const Resolved& member = object->resolve(call.text(1));
  const dynamic::Memory memory = object->object().memory(member.member.name);
  const Memory::Numbers sizes = runtime.call_directly([&] { return memory.dims(); });
  std::vector<double> row(sizes.begin(), sizes.end());
  call.give(make_numbers<double>(row, {1, static_cast<mwSize>(row.size())}));
}

// memory_length(object, name), memory_dim_count(object, name): as the service says
void length(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const dynamic::Memory memory = object->object().memory(object->resolve(call.text(1)).member.name);
  const std::uint64_t items = runtime.call_directly([&] { return memory.length(); });
  call.give(mxCreateDoubleScalar(static_cast<double>(items)));
}
void dim_count(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const dynamic::Memory memory = object->object().memory(object->resolve(call.text(1)).member.name);
  const std::uint64_t count = runtime.call_directly([&] { return memory.dim_count(); });
  call.give(mxCreateDoubleScalar(static_cast<double>(count)));
}

// memory_is_flat(object, name): whether it is declared with one dimension
void is_flat(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  call.give(mxCreateLogicalScalar(!object->resolve(call.text(1)).plan->has_dims));
}

// memory_read(object, name, position, count): array; positions count from 0
void read(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const Resolved& member = object->resolve(call.text(1));
  const dynamic::Memory memory = object->object().memory(member.member.name);
  const Memory::Numbers position = numbers_of(call[2]);
  const Memory::Numbers count = numbers_of(call[3]);
  const Value items =
      runtime.call<Value>([&] { return memory.read(position, count); },
                          [&](auto done) { memory.async_read(position, count, std::move(done)); });
  call.give(to_mex(items, *member.plan, object->connection()->plans));
}

// memory_write(object, name, position, array)
void write(Runtime& runtime, Call& call) {
  const auto object = object_of(runtime, call);
  const Resolved& member = object->resolve(call.text(1));
  const dynamic::Memory memory = object->object().memory(member.member.name);
  const Memory::Numbers position = numbers_of(call[2]);
  const Value items = read_value(*object, call[3], member.plan, member.subject);
  runtime.call<>([&] { memory.write(position, items); },
                 [&](auto done) { memory.async_write(position, items, std::move(done)); });
}

}  // namespace

std::vector<Command> memory_commands() {
  return {{"memory_dims", dims},       {"memory_length", length}, {"memory_dim_count", dim_count},
          {"memory_is_flat", is_flat}, {"memory_read", read},     {"memory_write", write}};
}

}  // namespace rr::matlab
