// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "rr/definition.hpp"
#include "rr/node_id.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"

/// The definition of the service index (05, section 6), for both of its sides.
namespace rr::service_index {

inline constexpr std::string_view service_name = "RobotRaconteurServiceIndex";

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
extern const ObjectType index_type;
/// The same with a stub. It is not in the definition, where a program's own is to be found.
extern const ObjectType index_stub_type;
extern const Definition definition;

/// Places of the members.
enum Place : std::size_t { local_services, routed_nodes, detected_nodes, services_changed };
extern const Member members[4];

/// Somebody else's index.
class IndexStub final : public virtual Stub {
 public:
  IndexStub();
  [[nodiscard]] const ObjectType& rr_object_type() const override { return index_stub_type; }
  ServiceInfos get_local_node_services();
  NodeInfos get_detected_nodes();
  Event<>& services_changed() { return changed_; }

 private:
  Event<> changed_;
};

/// `rr+tcp://10.0.0.5:2355` as the URL of a service of the node; an IPv6 scope, which means nothing
/// on another machine, is left out. An empty service: none named.
std::string service_url(std::string_view base, const NodeId& node, std::string_view service);
/// The same for this machine: an IPv6 scope stays.
std::string own_service_url(std::string base, const NodeId& node, std::string_view service);
/// A URL of a service as that of another service of the same node; of none when it is empty.
std::string exchange_service(std::string_view url, std::string_view service);

}  // namespace rr::service_index

template <>
inline constexpr const rr::Type& rr::type_of<rr::service_index::NodeInfo> =
    rr::service_index::node_info_type;
template <>
inline constexpr const rr::Type& rr::type_of<rr::service_index::ServiceInfo> =
    rr::service_index::service_info_type;
