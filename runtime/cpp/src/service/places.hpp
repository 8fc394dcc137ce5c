// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/skeleton.hpp"

namespace rr {

namespace service {
class OfferedWire;
class ServiceHost;
}  // namespace service

/// Where an object can be reached: its events go to the clients of each service.
struct Skeleton::Places {
  static Places& of(const Skeleton& skeleton) { return *skeleton.rr_places_; }

  void add(std::weak_ptr<service::ServiceHost> host, std::string path);
  void remove(const service::ServiceHost& host, const std::string& path);
  [[nodiscard]] std::vector<std::pair<std::shared_ptr<service::ServiceHost>, std::string>> all();

  /// One of the object's wires, by its name.
  std::shared_ptr<service::OfferedWire> wire(const Member& member);

 private:
  std::mutex mutex_;
  std::vector<std::pair<std::weak_ptr<service::ServiceHost>, std::string>> places_;
  std::map<std::string_view, std::shared_ptr<service::OfferedWire>> wires_;
};

}  // namespace rr
