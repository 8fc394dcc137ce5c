// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/cpp/src/discovery/matching.hpp"
#include "runtime/cpp/src/subscription/services.hpp"

namespace rr::discovery {

/// Services of some types that are found: a subscription connects to them.
class TypeSource final : public MatchingServices,
                         public subscription::FindingSource,
                         public std::enable_shared_from_this<TypeSource> {
 public:
  TypeSource(std::shared_ptr<ServiceWatch> watch, std::shared_ptr<endpoint::Core> core,
             std::weak_ptr<subscription::Services> services, std::vector<std::string> types,
             ServiceFilter filter);

  void look_for(std::vector<std::string> types,
                std::shared_ptr<const subscription::Filter> filter) override;
  void end() override;

 private:
  void came(const std::string& key, const FoundService& service) override;
  void changed(const std::string& key, const FoundService& service) override;
  void went(const std::string& key, const FoundService& service, bool is_silent) override;

  const std::shared_ptr<ServiceWatch> watch_;
  const std::weak_ptr<subscription::Services> services_;
};

}  // namespace rr::discovery
