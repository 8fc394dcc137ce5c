// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/member_facts.hpp"

#include <string>
#include <utility>
#include <variant>

#include "compiler/backends/backend.hpp"
#include "compiler/backends/implements.hpp"

namespace robdef {

using model::MemberKind;

template <>
const ViewType& view_type<ParameterFacts>() {
  static const ViewType type = ParameterFacts::fields<ParameterFacts>();
  return type;
}

std::vector<std::string> access_words(const model::Access& access,
                                      const std::array<std::string_view, 7>& words) {
  const std::array<bool, 7> is_set = {
      access.is_readonly,   access.is_writeonly, access.is_unreliable, access.is_nolock,
      access.is_nolockread, access.is_perclient, access.is_urgent};
  std::vector<std::string> found;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (is_set[i]) found.emplace_back(words[i]);
  }
  return found;
}

void describe(MemberKindFacts& facts, const model::Member& member) {
  facts.wire_name = member.name;
  facts.kind = model::name_of(member.kind);
  facts.is_property = member.kind == MemberKind::property;
  facts.is_function = member.kind == MemberKind::function;
  facts.is_event = member.kind == MemberKind::event;
  facts.is_objref = member.kind == MemberKind::objref;
  facts.is_pipe = member.kind == MemberKind::pipe;
  facts.is_callback = member.kind == MemberKind::callback;
  facts.is_wire = member.kind == MemberKind::wire;
  facts.is_memory = member.kind == MemberKind::memory;
}

void describe(MemberFacts& facts, const model::Object& object, const model::Member& member,
              const Abilities& abilities) {
  describe(facts, member);
  facts.is_served = abilities.serve(member);
  facts.is_inherited = origin(object, member.name) != nullptr;
  static_cast<model::Access&>(facts) = member.access;
  facts.can_get = facts.is_property && !member.access.is_writeonly;
  facts.can_set = facts.is_property && !member.access.is_readonly;
  facts.robdef_type = member.type.text();
  facts.has_result = !facts.is_objref && !facts.is_event && !member.type.is_void();
  facts.has_parameters = !member.parameters.empty();
  facts.is_multi = facts.is_memory && member.type.array == model::ArrayForm::any_shape;
  facts.is_generator = member.generator != model::GeneratorForm::none;
  facts.is_source = member.generator == model::GeneratorForm::returns;
  facts.is_sink = member.generator == model::GeneratorForm::takes;
  facts.is_filter = member.generator == model::GeneratorForm::both;
  if (facts.is_objref) {
    const auto* const target = std::get_if<const model::Object*>(&member.type.base);
    facts.is_varobject = target == nullptr;
    if (target != nullptr) facts.object_type = (*target)->qualified_name();
  }
  facts.has_index = member.index != model::IndexForm::none;
  facts.has_int32_index = member.index == model::IndexForm::int32;
  facts.has_string_index = member.index == model::IndexForm::string;
}

void describe(ParameterFacts& facts, const model::Parameter& parameter, std::string name) {
  facts.wire_name = parameter.name;
  facts.name = std::move(name);
  facts.robdef_type = parameter.type.text();
}

void describe(RecordFacts& facts, const model::Record& record) {
  facts.wire_name = record.qualified_name();
  facts.kind = model::name_of(record.kind);
  facts.is_struct = record.kind == model::RecordKind::struct_;
  facts.is_pod = record.kind == model::RecordKind::pod;
  facts.is_namedarray = record.kind == model::RecordKind::namedarray;
  if (facts.is_namedarray) facts.number_count = std::to_string(record.number_count);
  facts.has_fields = !record.fields.empty();
}

}  // namespace robdef
