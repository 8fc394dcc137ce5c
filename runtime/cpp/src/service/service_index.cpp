// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/service_index.hpp"

#include <cstdint>
#include <string>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {

using namespace service_index;

namespace {

// What others may be told: numbers, arrays of them and strings (05, section 6.1).
bool may_be_listed(const VarValue& attribute) {
  if (attribute.is_null()) return false;
  const auto type = static_cast<std::uint16_t>(attribute.type()->element_type());
  return type > static_cast<std::uint16_t>(ElementType::void_) &&
         type < static_cast<std::uint16_t>(ElementType::structure);
}

}  // namespace

ServiceIndex::ServiceIndex(std::weak_ptr<Directory> directory) : directory_(std::move(directory)) {}

const ObjectType& ServiceIndex::rr_object_type() const { return index_type; }

void ServiceIndex::rr_dispatch(std::size_t member, Request& request) {
  if (member == local_services) {
    answer_local_services(request);
    return;
  }
  NodeInfos nodes = NodeInfos::value_type();  // behind this one there are none
  const auto directory = directory_.lock();
  if (member == detected_nodes && directory) {
    std::int32_t key = 0;
    for (const DetectedNode& node : directory->detected_nodes()) {
      NodeInfo info;
      info.NodeName = node.name;
      info.NodeID = node.id.bytes;
      info.ServiceIndexConnectionURL.emplace();
      std::int32_t url_key = 1;
      for (const std::string& url : node.urls) {
        info.ServiceIndexConnectionURL->emplace(url_key++, url);
      }
      nodes->emplace(key++, std::move(info));
    }
  }
  request.answer(&nodes);
}

std::shared_ptr<Skeleton> ServiceIndex::rr_child(std::size_t /*member*/,
                                                 const ObjectIndex& /*index*/) {
  return nullptr;
}

void ServiceIndex::answer_local_services(Request& request) const {
  const auto directory = directory_.lock();
  const ServerEndpoint* const asker = ServerEndpoint::current();
  const std::string own_url = asker != nullptr ? asker->connection().local_url() : std::string();
  if (!directory || own_url.empty()) {
    throw Error(ErrorCode::service_error, "this connection has no address that others could use");
  }
  ServiceInfos services = ServiceInfos::value_type();
  std::int32_t key = 0;
  for (const auto& host : directory->all()) {
    ServiceInfo info;
    info.Name = host->name();
    const ObjectType& type = host->root().rr_object_type();
    info.RootObjectType = type.name;
    info.RootObjectImplements.emplace();
    std::int32_t implements_key = 0;
    for (const std::string_view other : type.implements) {
      info.RootObjectImplements->emplace(implements_key++, other);
    }
    info.ConnectionURL.emplace();
    info.ConnectionURL->emplace(
        1, service_url(own_url, directory->core()->options().id, host->name()));
    info.Attributes = host->attributes();
    std::erase_if(*info.Attributes,
                  [](const auto& attribute) { return !may_be_listed(attribute.second); });
    services->emplace(key++, std::move(info));
  }
  request.answer(&services);
}

void ServiceIndex::fire_changed() const { rr_fire_event(members[services_changed]); }

}  // namespace rr::service
