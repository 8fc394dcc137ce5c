// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/cpp/binding.hpp"

#include <utility>

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

}  // namespace rr::conformance
