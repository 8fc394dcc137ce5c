// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/plans.hpp"

#include <charconv>
#include <functional>
#include <numeric>

namespace rr::matlab {

using dynamic::Kind;

std::vector<std::size_t> fixed_dims(const std::string& type_text) {
  std::vector<std::size_t> dims;
  const std::size_t open = type_text.find('[');
  if (open == std::string::npos) return dims;
  const char* at = type_text.data() + open + 1;
  const char* const end = type_text.data() + type_text.size();
  while (at != end && *at != ']') {
    std::size_t dim = 0;
    const auto [stop, error] = std::from_chars(at, end, dim);
    if (error != std::errc() || stop == end || *stop == '-') return {};
    dims.push_back(dim);
    at = *stop == ',' ? stop + 1 : stop;
  }
  return dims;
}

const TypePlan* Plans::plan(const dynamic::ValueType& type) {
  if (type.node() == nullptr) return nullptr;
  const auto known = plans_.find(type.node());
  if (known != plans_.end()) return known->second.get();
  TypePlan& added = *plans_.emplace(type.node(), std::make_unique<TypePlan>()).first->second;
  added.type = type;
  fill(added);
  return &added;
}

const TypePlan* Plans::plan(const dynamic::Definitions& types, const std::string& text) {
  return plan(types.type(text));
}

// A type may contain itself: it is in plans_ already.
void Plans::fill(TypePlan& plan) {
  const dynamic::ValueType& type = plan.type;
  plan.kind = type.kind();
  plan.number = type.number();
  plan.name = type.name();
  plan.has_dims = type.has_dims();
  if (plan.kind == Kind::array) plan.rank = fixed_dims(type.text()).size();
  plan.item = this->plan(type.item());
  if (plan.kind != Kind::record) return;
  plan.record_kind = type.record_kind();
  for (const dynamic::Field& field : type.fields()) {
    plan.names.push_back(field.name);
    plan.fields.push_back(this->plan(field.type));
  }
  for (const std::string& name : plan.names) plan.name_pointers.push_back(name.c_str());
  if (plan.record_kind != RecordKind::namedarray) return;
  for (const TypePlan* field : plan.fields) {
    const auto dims = fixed_dims(field->type.text());
    const TypePlan& one = field->kind == Kind::array ? *field->item : *field;
    plan.numbers += (one.kind == Kind::record ? one.numbers : 1) *
                    std::accumulate(dims.begin(), dims.end(), std::size_t{1}, std::multiplies<>());
  }
}

}  // namespace rr::matlab
