// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "runtime/cpp/src/subscription/links.hpp"
#include "runtime/cpp/src/subscription/waits.hpp"

namespace rr::subscription {

/// An object at all clients of a subscription; who asks gets that of the default client.
class ObjectLinks final : public Links, public Waits {
 public:
  ObjectLinks(std::shared_ptr<endpoint::Core> core, std::weak_ptr<Services> services,
              std::string_view path)
      : Links(core, services, {}, path), Waits(std::move(core)), services_(std::move(services)) {}

  std::shared_ptr<Stub> find(const ObjectType* type) override;

 private:
  struct ObjectLink final : Link {
    using Link::Link;
    std::shared_ptr<Stub> object;
  };

  static ObjectLink& as_object(Link& link) { return static_cast<ObjectLink&>(link); }
  LinkPointer make_link(std::shared_ptr<const LiveClient> client) override RR_REQUIRES(mutex_);
  void connect(const LinkPointer& link, const std::shared_ptr<Stub>& object) override;
  void use(Link& /*link*/) override {}
  void leave(Link& /*link*/) override {}
  void changed() override { Waits::changed(); }

  [[nodiscard]] bool has_ended() const override { return !is_open(); }
  [[nodiscard]] std::optional<Error> why_none() const override;
  std::shared_ptr<Waits> share() override {
    return std::static_pointer_cast<ObjectLinks>(shared_from_this());
  }

  const std::weak_ptr<Services> services_;
};

}  // namespace rr::subscription
