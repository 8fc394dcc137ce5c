// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <rr/dynamic.hpp>
#include <string>
#include <utility>
#include <vector>

#include "conformance/runners/shared/binding.hpp"

namespace rr::conformance {

/// Plans and scripts are played by names and run-time values: nothing was generated for their
/// definitions.
class DynamicBinding final : public Binding {
 public:
  /// The texts of definitions are for services.
  explicit DynamicBinding(std::vector<std::string> texts = {}) : texts_(std::move(texts)) {}
  void prepare(Node& node) override;
  Connected connect(Node& node, const std::string& url, ConnectOptions options) override;
  std::unique_ptr<Caller> caller(const Held& held) override;
  Json write(const VarValue& value) override;
  VarValue read(const Json& json) override;
  Service offer(Node& node, const std::string& name, const std::string& type, Json script,
                ServiceOptions options) override;

 private:
  const std::vector<std::string> texts_;
  const Adapters none_;
  dynamic::Client* newest_ = nullptr;  ///< whose definitions name what varvalues hold
};

}  // namespace rr::conformance
