// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <rr/node.hpp>
#include <string>

#include "conformance/runners/shared/binding.hpp"

namespace rr::conformance {

/// `serve`: a node whose services do what service.json says.
class ServedNode {
 public:
  explicit ServedNode(Binding& binding) : binding_(binding) {}

  /// {do: start, ...} gives {port}; {do: close_service, service} gives {done}.
  Json answer(const Json& request);

 private:
  Json start(const Json& request);
  void offer(const Json& service, const Json& all);

  Binding& binding_;
  std::map<std::string, Service> services_;
  std::unique_ptr<Node> node_;
};

}  // namespace rr::conformance
