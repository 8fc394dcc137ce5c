// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/skeleton.hpp"

namespace rr {

namespace service {
class OfferedWire;
class PipePlace;
class ServiceHost;
struct ServedObject;
}  // namespace service

/// Where an object can be reached: its events go to the clients of each service.
struct Skeleton::Places {
  static Places& of(const Skeleton& skeleton) { return *skeleton.rr_places_; }

  Places() = default;
  /// The functions of the object's pipes end with it, though they may hold their pipes.
  ~Places();
  Places(const Places&) = delete;
  Places& operator=(const Places&) = delete;

  /// One of them.
  template <class Host>
  struct Place {
    Host host;
    std::string path;
    std::uint32_t owner;  ///< the client whose own it is there; 0: of all
  };

  void add(std::weak_ptr<service::ServiceHost> host, const service::ServedObject& object);
  void remove(const service::ServiceHost& host, const service::ServedObject& object);
  [[nodiscard]] std::vector<Place<std::shared_ptr<service::ServiceHost>>> all();
  /// What all clients' endpoints of a pipe have in common.
  std::shared_ptr<service::PipePlace> pipe(std::string_view name);

  /// One of the object's wires, by its name.
  std::shared_ptr<service::OfferedWire> wire(const Member& member);

  /// Whether each client is to have one of its own.
  std::atomic<bool> is_per_client{false};

 private:
  Mutex mutex_;
  std::vector<Place<std::weak_ptr<service::ServiceHost>>> places_ RR_GUARDED_BY(mutex_);
  std::map<std::string_view, std::shared_ptr<service::OfferedWire>> wires_ RR_GUARDED_BY(mutex_);
  std::map<std::string, std::shared_ptr<service::PipePlace>, std::less<>> pipes_
      RR_GUARDED_BY(mutex_);
};

}  // namespace rr
