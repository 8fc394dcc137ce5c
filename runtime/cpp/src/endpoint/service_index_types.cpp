// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/endpoint/service_index_types.hpp"

namespace rr::service_index {
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

constexpr std::string_view index_type_name = "RobotRaconteurServiceIndex.ServiceIndex";

std::shared_ptr<Stub> make_stub() { return std::make_shared<IndexStub>(); }

constexpr const RecordType* records[] = {&node_info_type, &service_info_type};
constexpr const ObjectType* objects[] = {&index_type};

}  // namespace

constinit const RecordType node_info_type{RecordKind::struct_,
                                          "RobotRaconteurServiceIndex.NodeInfo", node_info_fields,
                                          record_operations<NodeInfo>};
constinit const RecordType service_info_type{RecordKind::struct_,
                                             "RobotRaconteurServiceIndex.ServiceInfo",
                                             service_info_fields, record_operations<ServiceInfo>};

constinit const Member members[4] = {
    function<ServiceInfos>("GetLocalNodeServices"),
    function<NodeInfos>("GetRoutedNodes"),
    function<NodeInfos>("GetDetectedNodes"),
    event("LocalNodeServicesChanged"),
};

constinit const ObjectType index_type{index_type_name, definition, {}, members, nullptr};
constinit const ObjectType index_stub_type{index_type_name, definition, {}, members, &make_stub};
constinit const Definition definition{service_name, definition_text, {}, {}, records, {}, objects};

IndexStub::IndexStub() : changed_(*this, members[Place::services_changed]) {}

ServiceInfos IndexStub::get_local_node_services() {
  return rr_call<ServiceInfos>(members[local_services], {});
}

NodeInfos IndexStub::get_detected_nodes() {
  return rr_call<NodeInfos>(members[detected_nodes], {});
}

std::string service_url(std::string_view base, const NodeId& node, std::string_view service) {
  std::string url(base);
  const std::size_t scope = url.find('%');
  if (scope != std::string::npos) url.erase(scope, url.find(']', scope) - scope);
  return own_service_url(std::move(url), node, service);
}

std::string own_service_url(std::string base, const NodeId& node, std::string_view service) {
  // One of a local socket or the like may say more than a place already.
  if (base.find('?') == std::string::npos) {
    const std::size_t scheme = base.find("://");
    const std::size_t host = scheme == std::string::npos ? 0 : scheme + 3;
    const bool has_path = base.find('/', host) != std::string::npos;
    base += has_path ? "?" : "/?";
    base += "nodeid=" + node.text();
  }
  if (!service.empty()) base += "&service=" + std::string(service);
  return base;
}

std::string exchange_service(std::string_view url, std::string_view service) {
  const std::size_t question = url.find('?');
  if (question == std::string_view::npos) return std::string(url);
  std::string result(url.substr(0, question + 1));
  std::string_view rest = url.substr(question + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find('&');
    const std::string_view item = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (item.starts_with("service=")) continue;
    if (result.back() != '?') result += '&';
    result += item;
  }
  if (service.empty()) return result;
  if (result.back() != '?') result += '&';
  return result + "service=" + std::string(service);
}

}  // namespace rr::service_index
