// SPDX-License-Identifier: Apache-2.0
// What model::written() prints, with links in it.
#include "compiler/docs/signatures.hpp"

#include <type_traits>
#include <variant>

#include "compiler/model/print.hpp"

namespace robdef::docs {

using model::MemberKind;

Place place_of(const model::Base& base) {
  return std::visit(
      [](const auto& one) -> Place {
        if constexpr (std::is_pointer_v<std::decay_t<decltype(one)>>) {
          return {one->definition, one->name};
        } else {
          return {};
        }
      },
      base);
}

std::string Signatures::base(const model::Type& type) const {
  std::string label = markup_.text(model::written_base(type, definition_));
  const Place place = place_of(type.base);
  if (place.definition == nullptr) return label;
  return markup_.link(label, addresses_.address(definition_, place));
}

std::string Signatures::type(const model::Type& type) const {
  return base(type) + markup_.text(type.suffix());
}

std::string Signatures::modifiers(const std::vector<model::Modifier>& modifiers) const {
  std::string text;
  for (const model::Modifier& modifier : modifiers) {
    text += text.empty() ? " [" : ", ";
    text += modifier.name;
    for (std::size_t i = 0; i < modifier.arguments.size(); ++i) {
      text += (i == 0 ? "(" : ", ") + modifier.arguments[i];
    }
    if (!modifier.arguments.empty()) text += ')';
  }
  return markup_.text(text.empty() ? "" : text + "]");
}

std::string Signatures::parameters(const model::Member& member) const {
  const std::string generator = markup_.text(model::text_of(model::ContainerForm::generator));
  std::string text;
  const auto add = [&](const model::Parameter& parameter, const std::string& container) {
    text += text.empty() ? "" : ", ";
    text += type(parameter.type) + container + ' ' + markup_.text(parameter.name);
  };
  for (const model::Parameter& parameter : member.parameters) add(parameter, "");
  if (member.generator_parameter) add(*member.generator_parameter, generator);
  return markup_.text("(") + text + markup_.text(")");
}

std::string Signatures::member(const model::Object& object, const model::Member& member) const {
  std::string text(model::name_of(member.kind));
  if (member.kind != MemberKind::event) text += ' ' + type(member.type);
  const bool returns = member.generator == model::GeneratorForm::returns ||
                       member.generator == model::GeneratorForm::both;
  if (returns) text += markup_.text(model::text_of(model::ContainerForm::generator));
  if (member.index == model::IndexForm::int32) text += markup_.text("{int32}");
  if (member.index == model::IndexForm::string) text += markup_.text("{string}");
  text += ' ' + name(member.name, object.name + "." + member.name);
  const bool has_parameters = member.kind == MemberKind::function ||
                              member.kind == MemberKind::event ||
                              member.kind == MemberKind::callback;
  if (has_parameters) text += parameters(member);
  return text + modifiers(member.modifiers);
}

std::string Signatures::field(const model::Record& record, const model::Field& field) const {
  return "field " + type(field.type) + ' ' + name(field.name, record.name + "." + field.name) +
         modifiers(field.modifiers);
}

std::string Signatures::constant(const model::Constant& constant, std::string_view owner) const {
  const std::string title = name(constant.name, std::string(owner) + constant.name);
  if (const auto* fields = std::get_if<std::vector<model::StructValueField>>(&constant.value)) {
    std::string text;
    for (const model::StructValueField& field : *fields) {
      text += (text.empty() ? "" : ", ") + markup_.text(field.field + ": ");
      if (field.constant == nullptr) continue;
      const Place place{&definition_, std::string(owner) + field.constant->name};
      text +=
          markup_.link(markup_.text(field.constant->name), addresses_.address(definition_, place));
    }
    return "constant struct " + title + ' ' + markup_.text("{") + text + markup_.text("}");
  }
  return "constant " + markup_.text(constant.type.text()) + ' ' + title + ' ' +
         markup_.text(model::written_value(constant));
}

std::string Signatures::name(const std::string& raw, const std::string& anchor) const {
  return markup_.name(raw, addresses_.address(definition_, {&definition_, anchor}));
}

std::string Signatures::block(std::string_view keyword, const std::string& raw) const {
  return std::string(keyword) + ' ' + name(raw, raw);
}

std::string Signatures::place(const Place& place) const {
  std::string label = place.anchor;
  if (place.definition != &definition_) label = place.definition->name + "." + label;
  return markup_.link(markup_.text(label), addresses_.address(definition_, place));
}

std::string Signatures::object(const model::Object& object) const {
  return markup_.link(markup_.text(model::written(object, definition_)),
                      addresses_.address(definition_, {object.definition, object.name}));
}

std::string Signatures::member_of(const model::Object& object, const std::string& name) const {
  const Place place{object.definition, object.name + "." + name};
  return markup_.link(markup_.text(model::written(object, definition_) + "." + name),
                      addresses_.address(definition_, place));
}

}  // namespace robdef::docs
