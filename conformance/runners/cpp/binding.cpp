// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/binding.hpp"

#include <utility>

#include "conformance/runners/cpp/script.hpp"

namespace rr::conformance {

void GeneratedBinding::prepare(Node& node) {
  for (const auto& [name, definition] : adapters_.definitions()) node.add_definition(*definition);
}

Binding::Connected GeneratedBinding::connect(Node& node, const std::string& url,
                                             ConnectOptions options) {
  auto client = std::make_unique<Client<Stub>>(node.connect<Stub>(url, std::move(options)));
  const std::shared_ptr<Stub> root = client->stub();
  return {std::move(client), {root, root->rr_object_type().name}};
}

std::unique_ptr<Caller> GeneratedBinding::caller(const Held& held) {
  return adapters_.object(held.type).call(adapters_, held.stub);
}

Json GeneratedBinding::write(const VarValue& value) { return to_json(adapters_, value); }

VarValue GeneratedBinding::read(const Json& json) {
  return made_from_json<VarValue>(adapters_, json);
}

Service GeneratedBinding::offer(Node& node, const std::string& name, const std::string& type,
                                Json script, ServiceOptions options) {
  const auto told = std::make_shared<Script>(adapters_, std::move(script));
  return node.register_service(name, adapters_.object(type).serve(told), std::move(options));
}

}  // namespace rr::conformance
