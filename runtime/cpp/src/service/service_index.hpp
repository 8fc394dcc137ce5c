// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rr/definition.hpp"
#include "rr/skeleton.hpp"

namespace rr::service {

class Directory;

/// The service that every node has: the list of its services (07, section 15).
class ServiceIndex final : public Skeleton {
 public:
  explicit ServiceIndex(std::weak_ptr<Directory> directory);

  [[nodiscard]] const ObjectType& rr_object_type() const override;
  void rr_dispatch(std::size_t member, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t member, const ObjectIndex& index) override;

  /// Tells clients that the list has changed.
  void fire_changed() const;

 private:
  void answer_local_services(Request& request) const;

  const std::weak_ptr<Directory> directory_;
};

}  // namespace rr::service
