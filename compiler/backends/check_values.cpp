// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/check_values.hpp"

#include <variant>
#include <vector>

namespace robdef {
namespace {

using model::Type;

class Checker {
 public:
  Checker(const ValueRules& rules, Report& report) : rules_(rules), report_(report) {}

  void check(const model::Definition& definition) {
    check(definition.constants);
    for (const model::Record& record : definition.records) {
      check(record.constants);
      for (const model::Field& field : record.fields) value(field.type);
      if (record.kind == model::RecordKind::namedarray && record.number_count == 0) {
        refuse(record.span, "a namedarray without numbers");
      }
    }
    for (const model::Object& object : definition.objects) {
      check(object.constants);
      for (const model::Member& member : object.members) check(member);
    }
  }

 private:
  void check(const std::vector<model::Constant>& constants) {
    for (const model::Constant& constant : constants) {
      if (constant.type.container == model::ContainerForm::none) continue;
      refuse(constant.span, "a constant that is a container");
    }
  }

  void check(const model::Member& member) {
    if (member.kind != model::MemberKind::objref) value(member.type);
    for (const model::Parameter& parameter : member.parameters) value(parameter.type);
    if (member.generator_parameter) value(member.generator_parameter->type);
  }

  void value(const Type& type) {
    if (std::holds_alternative<const model::Object*>(type.base) ||
        std::holds_alternative<model::VarObject>(type.base)) {
      refuse(type.span, "an object as a value");
      return;
    }
    const std::string fault = rules_.judge(type);
    if (!fault.empty()) refuse(type.span, fault);
  }

  void refuse(Span span, const std::string& what) {
    report_.add(Code::R0902, span, what + " cannot be expressed in " + rules_.language);
  }

  const ValueRules& rules_;
  Report& report_;
};

}  // namespace

void check_values(const model::Definition& definition, const ValueRules& rules, Report& report) {
  Checker(rules, report).check(definition);
}

}  // namespace robdef
