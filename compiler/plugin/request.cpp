// SPDX-License-Identifier: Apache-2.0
// Model -> the document that a plug-in reads; docs/howto/plugins.md describes it.
#include <cstddef>
#include <string>
#include <utility>
#include <variant>

#include "compiler/backends/backend.hpp"
#include "compiler/backends/implements.hpp"
#include "compiler/backends/member_facts.hpp"
#include "compiler/model/dump.hpp"
#include "compiler/output/json.hpp"
#include "compiler/output/view_type.hpp"
#include "compiler/plugin/plugin.hpp"

namespace robdef::plugin {
namespace {

constexpr int request_version = 1;

/// What types are declared in: nothing for those of the language.
struct DeclaredIn {
  const model::Definition* operator()(const model::Record* one) const { return one->definition; }
  const model::Definition* operator()(const model::Enum* one) const { return one->definition; }
  const model::Definition* operator()(const model::Object* one) const { return one->definition; }
  template <class Other>
  const model::Definition* operator()(const Other&) const {
    return nullptr;
  }
};

/// What every backend wants to know, and the model does not say.
class Facts : public model::DumpAdditions {
 public:
  void exception(JsonWriter& json, const model::Exception& exception) const override {
    json.member("wire_name", exception.definition->name + "." + exception.name);
  }
  void enumeration(JsonWriter& json, const model::Enum& enumeration) const override {
    json.member("wire_name", enumeration.definition->name + "." + enumeration.name);
  }
  void record(JsonWriter& json, const model::Record& record) const override {
    json.member("wire_name", record.qualified_name());
  }
  void object(JsonWriter& json, const model::Object& object) const override {
    json.member("wire_name", object.qualified_name());
  }

  void member(JsonWriter& json, const model::Object& object,
              const model::Member& member) const override {
    MemberFacts facts;
    // A plug-in decides for itself what it cannot serve.
    describe(facts, object, member, everything);
    facts.number = std::to_string(&member - object.members.data());
    const model::Object* const base = origin(object, member.name);
    json.key("origin");
    if (base == nullptr) {
      json.null();
    } else {
      json.value(base->qualified_name());
    }
    json.member("full_name", full_name(object, member)).key("facts");
    static const ViewType type = MemberFacts::fields<MemberFacts>();
    write_json(json, type, &facts);
  }

  void type(JsonWriter& json, const model::Type& type) const override {
    const model::Definition* const definition = std::visit(DeclaredIn{}, type.base);
    json.member("element_count", type.element_count()).key("definition");
    if (definition == nullptr) {
      json.null();
    } else {
      json.value(definition->name);
    }
  }
};

}  // namespace

std::string request_text(const Plugin& plugin, const model::Model& model, const Sources& sources) {
  JsonWriter json(JsonWriter::Layout::one_line);
  json.begin_object().member("robdef_plugin", request_version).key("options").begin_object();
  for (const auto& [key, value] : plugin.options) json.member(key, value);
  json.end_object();
  model::dump_definitions(json, model, sources, Facts());
  json.end_object();
  return std::move(json).text() + '\n';
}

}  // namespace robdef::plugin
