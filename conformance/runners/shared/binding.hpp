// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <rr/node.hpp>
#include <string>

#include "conformance/runners/shared/adapters.hpp"
#include "conformance/runners/shared/caller.hpp"

namespace rr::conformance {

/// What plans and scripts are played with: clients and services made of generated code, or such as
/// need none.
class Binding {
 public:
  virtual ~Binding() = default;
  /// Called for a new node, before it connects.
  virtual void prepare(Node& node) = 0;
  struct Connected {
    std::unique_ptr<ClientBase> client;
    Held root;
  };
  virtual Connected connect(Node& node, const std::string& url, ConnectOptions options) = 0;
  virtual std::unique_ptr<Caller> caller(const Held& held) = 0;
  virtual Json write(const VarValue& value) = 0;
  virtual VarValue read(const Json& json) = 0;
  /// Offers an object of this type that does what a node of service.json says.
  virtual Service offer(Node& node, const std::string& name, const std::string& type, Json script,
                        ServiceOptions options) = 0;
};

/// With the generated classes that the adapters know.
class GeneratedBinding final : public Binding {
 public:
  explicit GeneratedBinding(const Adapters& adapters) : adapters_(adapters) {}
  void prepare(Node& node) override;
  Connected connect(Node& node, const std::string& url, ConnectOptions options) override;
  std::unique_ptr<Caller> caller(const Held& held) override;
  Json write(const VarValue& value) override;
  VarValue read(const Json& json) override;
  Service offer(Node& node, const std::string& name, const std::string& type, Json script,
                ServiceOptions options) override;

 private:
  const Adapters& adapters_;
};

}  // namespace rr::conformance
