// SPDX-License-Identifier: Apache-2.0
// Structs, pods and namedarrays of generated functions: made and checked without a connection.
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {
namespace {

std::string service_of(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? name : name.substr(0, dot);
}

// record_known(name): whether its definition was given
void record_known(Runtime& runtime, Call& call) {
  const bool is_known = runtime.records.find(service_of(call.text(0))) != runtime.records.end();
  call.give(mxCreateLogicalScalar(is_known));
}

// record_define(name, texts): the definition of a record, and what it imports
void record_define(Runtime& runtime, Call& call) {
  std::vector<std::string> texts;
  for (const mxArray* const cell : read_cells(call[1])) texts.push_back(read_text(cell));
  runtime.records[service_of(call.text(0))] =
      std::make_unique<RecordTypes>(dynamic::Definitions(texts));
}

// record(name): a value with nothing in it; record(name, value): the value as one is received
void record(Runtime& runtime, Call& call) {
  const std::string name = call.text(0);
  const auto known = runtime.records.find(service_of(name));
  if (known == runtime.records.end()) {
    throw Error(ErrorCode::invalid_operation, "the definition of `" + name + "` is not known");
  }
  RecordTypes& types = *known->second;
  const TypePlan& plan = *types.plans.plan(types.definitions, name);
  if (!call.has(1)) return call.give(make_empty(plan));
  const dynamic::Value value = as_subject(name, [&] {
    return from_mex(call[1], plan, {types.plans, types.definitions});
  });
  call.give(to_mex(plan.type.convert(value, name), plan, types.plans));
}

}  // namespace

std::vector<Command> record_commands() {
  return {{"record_known", record_known}, {"record_define", record_define}, {"record", record}};
}

}  // namespace rr::matlab
