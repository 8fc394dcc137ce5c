// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <rr/dynamic.hpp>
#include <string>

#include "conformance/runners/cpp/binding.hpp"

namespace rr::conformance {

/// Plans are played by names and run-time values: nothing was generated for their definitions.
class DynamicBinding final : public Binding {
 public:
  void prepare(Node& node) override;
  Connected connect(Node& node, const std::string& url, ConnectOptions options) override;
  std::unique_ptr<Caller> caller(const Held& held) override;
  Json write(const VarValue& value) override;
  VarValue read(const Json& json) override;

 private:
  const Adapters none_;
  dynamic::Client* newest_ = nullptr;  ///< whose definitions name what varvalues hold
};

}  // namespace rr::conformance
