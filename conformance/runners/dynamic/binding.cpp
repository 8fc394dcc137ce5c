// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/binding.hpp"

#include <rr/dynamic_service.hpp>
#include <stdexcept>

#include "conformance/runners/dynamic/caller.hpp"
#include "conformance/runners/dynamic/notation.hpp"
#include "conformance/runners/dynamic/script.hpp"
#include "conformance/runners/dynamic/texts.hpp"

namespace rr::conformance {

// The clients of the node before are gone.
void DynamicBinding::prepare(Node&) { newest_ = nullptr; }

Binding::Connected DynamicBinding::connect(Node& node, const std::string& url,
                                           ConnectOptions options) {
  auto client = std::make_unique<dynamic::Client>(dynamic::connect(node, url, std::move(options)));
  const dynamic::Object root = client->root();
  newest_ = client.get();
  return {std::move(client), {root.shared_stub(), root.type_name()}};
}

std::unique_ptr<Caller> DynamicBinding::caller(const Held& held) {
  return std::make_unique<DynamicCaller>(none_, dynamic::Object::of(held.stub));
}

Json DynamicBinding::write(const VarValue& value) {
  if (newest_ == nullptr) return to_json(none_, value);
  return json_of_any(newest_->types(), newest_->value(value));
}

VarValue DynamicBinding::read(const Json& json) {
  const dynamic::Definitions known = newest_ == nullptr ? dynamic::Definitions() : newest_->types();
  return dynamic::to_varvalue(value_of_json(known, known.type("varvalue"), json));
}

Service DynamicBinding::offer(Node& node, const std::string& name, const std::string& type,
                              Json script, ServiceOptions options) {
  const dynamic::Definitions definitions(with_imports(texts_, type.substr(0, type.rfind('.'))));
  return dynamic::register_service(
      node, name, DynamicScript::serve(definitions, type, std::move(script)), std::move(options));
}

}  // namespace rr::conformance
