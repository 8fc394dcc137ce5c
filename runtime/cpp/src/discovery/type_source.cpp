// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/type_source.hpp"

#include <utility>

#include "rr/error.hpp"

namespace rr::discovery {

TypeSource::TypeSource(std::shared_ptr<ServiceWatch> watch, std::shared_ptr<endpoint::Core> core,
                       std::weak_ptr<subscription::Services> services,
                       std::vector<std::string> types, ServiceFilter filter)
    : MatchingServices(std::move(core), std::move(types), std::move(filter)),
      watch_(std::move(watch)),
      services_(std::move(services)) {}

void TypeSource::look_for(std::vector<std::string> types,
                          std::shared_ptr<const subscription::Filter> filter) {
  watch_->run([self = shared_from_this(), types = std::move(types), filter = std::move(filter)] {
    self->MatchingServices::look_for(types, filter);
  });
}

void TypeSource::end() { watch_->remove(*this); }

void TypeSource::came(const std::string& key, const FoundService& service) {
  const auto services = services_.lock();
  if (!services) return;
  try {
    services->appear(key, service, true);
  } catch (const Error&) {
    // It has been closed meanwhile.
  }
}

void TypeSource::changed(const std::string& key, const FoundService& service) {
  came(key, service);
}

// That a node is not heard any more need not mean that its connections are gone.
void TypeSource::went(const std::string& key, const FoundService& /*service*/, bool is_silent) {
  const auto services = services_.lock();
  if (!services) return;
  if (is_silent) {
    services->fade(key);
  } else {
    services->disappear(key);
  }
}

}  // namespace rr::discovery
