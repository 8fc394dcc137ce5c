// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/service_index.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {
namespace {

using IndexedTexts = std::optional<std::map<std::int32_t, std::string>>;

struct NodeInfo {
  std::string NodeName;                    // NOLINT: named as in the definition
  std::array<std::uint8_t, 16> NodeID{};   // NOLINT
  IndexedTexts ServiceIndexConnectionURL;  // NOLINT
  bool operator==(const NodeInfo&) const = default;
};

struct ServiceInfo {
  std::string Name;                                           // NOLINT
  std::string RootObjectType;                                 // NOLINT
  IndexedTexts RootObjectImplements;                          // NOLINT
  IndexedTexts ConnectionURL;                                 // NOLINT
  std::optional<std::map<std::string, VarValue>> Attributes;  // NOLINT
  bool operator==(const ServiceInfo&) const = default;
};

using NodeInfos = std::optional<std::map<std::int32_t, std::optional<NodeInfo>>>;
using ServiceInfos = std::optional<std::map<std::int32_t, std::optional<ServiceInfo>>>;

extern const RecordType node_info_type;
extern const RecordType service_info_type;

}  // namespace
}  // namespace rr::service

template <>
inline constexpr const rr::Type& rr::type_of<rr::service::NodeInfo> = rr::service::node_info_type;
template <>
inline constexpr const rr::Type& rr::type_of<rr::service::ServiceInfo> =
    rr::service::service_info_type;

namespace rr::service {
namespace {

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Winvalid-offsetof"  // structs that hold maps
constexpr Field node_info_fields[] = {
    field<std::string>("NodeName", offsetof(NodeInfo, NodeName)),
    field<std::array<std::uint8_t, 16>>("NodeID", offsetof(NodeInfo, NodeID)),
    field<IndexedTexts>("ServiceIndexConnectionURL", offsetof(NodeInfo, ServiceIndexConnectionURL)),
};
constexpr Field service_info_fields[] = {
    field<std::string>("Name", offsetof(ServiceInfo, Name)),
    field<std::string>("RootObjectType", offsetof(ServiceInfo, RootObjectType)),
    field<IndexedTexts>("RootObjectImplements", offsetof(ServiceInfo, RootObjectImplements)),
    field<IndexedTexts>("ConnectionURL", offsetof(ServiceInfo, ConnectionURL)),
    field<std::optional<std::map<std::string, VarValue>>>("Attributes",
                                                          offsetof(ServiceInfo, Attributes)),
};
#pragma GCC diagnostic pop

constinit const RecordType node_info_type{RecordKind::struct_,
                                          "RobotRaconteurServiceIndex.NodeInfo", node_info_fields,
                                          record_operations<NodeInfo>};
constinit const RecordType service_info_type{RecordKind::struct_,
                                             "RobotRaconteurServiceIndex.ServiceInfo",
                                             service_info_fields, record_operations<ServiceInfo>};

// As the reference sends it.
constexpr std::string_view definition_text =
    "service RobotRaconteurServiceIndex\n"
    "struct NodeInfo\n"
    "field string NodeName\n"
    "field uint8[16] NodeID\n"
    "field string{int32} ServiceIndexConnectionURL\n"
    "end struct\n"
    "struct ServiceInfo\n"
    "field string Name\n"
    "field string RootObjectType\n"
    "field string{int32} RootObjectImplements\n"
    "field string{int32} ConnectionURL\n"
    "field varvalue{string} Attributes\n"
    "end struct\n"
    "object ServiceIndex\n"
    "function ServiceInfo{int32} GetLocalNodeServices()\n"
    "function NodeInfo{int32} GetRoutedNodes()\n"
    "function NodeInfo{int32} GetDetectedNodes()\n"
    "event LocalNodeServicesChanged()\n"
    "end object\n";

enum Place : std::size_t { local_services, routed_nodes, detected_nodes, services_changed };

constexpr Member members[] = {
    function<ServiceInfos>("GetLocalNodeServices"),
    function<NodeInfos>("GetRoutedNodes"),
    function<NodeInfos>("GetDetectedNodes"),
    event("LocalNodeServicesChanged"),
};

extern const Definition definition;

constinit const ObjectType index_type{
    "RobotRaconteurServiceIndex.ServiceIndex", definition, {}, members, nullptr};
constexpr const RecordType* records[] = {&node_info_type, &service_info_type};
constexpr const ObjectType* objects[] = {&index_type};
constinit const Definition definition{
    service_index_name, definition_text, {}, {}, records, {}, objects};

std::string url_of(std::string_view own_url, const NodeId& node, const std::string& service) {
  return std::string(own_url) + "/?nodeid=" + node.text() + "&service=" + service;
}

}  // namespace

ServiceIndex::ServiceIndex(std::weak_ptr<Directory> directory) : directory_(std::move(directory)) {}

const ObjectType& ServiceIndex::rr_object_type() const { return index_type; }

void ServiceIndex::rr_dispatch(std::size_t member, Request& request) {
  if (member == local_services) {
    answer_local_services(request);
  } else {
    // Nodes behind this one there are none, and what other nodes are about it does not collect.
    const NodeInfos none = NodeInfos::value_type();
    request.answer(&none);
  }
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
    info.ConnectionURL->emplace(1, url_of(own_url, directory->core()->options().id, host->name()));
    info.Attributes = host->attributes();
    services->emplace(key++, std::move(info));
  }
  request.answer(&services);
}

void ServiceIndex::fire_changed() const { rr_fire_event(members[services_changed]); }

}  // namespace rr::service
