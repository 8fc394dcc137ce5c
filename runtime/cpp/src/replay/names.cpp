// SPDX-License-Identifier: Apache-2.0
// Names of numbers on the wire (README and 01, section 5, of the specification).
#include <array>
#include <charconv>
#include <utility>

#include "rr/number.hpp"
#include "runtime/cpp/src/replay/words.hpp"

namespace rr::replay {
namespace {

using Row = std::pair<EntryType, std::string_view>;

constexpr std::array entry_names = {
    Row{EntryType::null, "Null"},
    Row{EntryType::stream_op, "StreamOp"},
    Row{EntryType::stream_op_ret, "StreamOpRet"},
    Row{EntryType::stream_check_capability, "StreamCheckCapability"},
    Row{EntryType::stream_check_capability_ret, "StreamCheckCapabilityRet"},
    Row{EntryType::get_service_desc, "GetServiceDesc"},
    Row{EntryType::get_service_desc_ret, "GetServiceDescRet"},
    Row{EntryType::object_type_name, "ObjectTypeName"},
    Row{EntryType::object_type_name_ret, "ObjectTypeNameRet"},
    Row{EntryType::service_closed, "ServiceClosed"},
    Row{EntryType::service_closed_ret, "ServiceClosedRet"},
    Row{EntryType::connect_client, "ConnectClient"},
    Row{EntryType::connect_client_ret, "ConnectClientRet"},
    Row{EntryType::disconnect_client, "DisconnectClient"},
    Row{EntryType::disconnect_client_ret, "DisconnectClientRet"},
    Row{EntryType::connection_test, "ConnectionTest"},
    Row{EntryType::connection_test_ret, "ConnectionTestRet"},
    Row{EntryType::get_node_info, "GetNodeInfo"},
    Row{EntryType::get_node_info_ret, "GetNodeInfoRet"},
    Row{EntryType::reconnect_client, "ReconnectClient"},
    Row{EntryType::reconnect_client_ret, "ReconnectClientRet"},
    Row{EntryType::node_check_capability, "NodeCheckCapability"},
    Row{EntryType::node_check_capability_ret, "NodeCheckCapabilityRet"},
    Row{EntryType::get_service_attributes, "GetServiceAttributes"},
    Row{EntryType::get_service_attributes_ret, "GetServiceAttributesRet"},
    Row{EntryType::connect_client_combined, "ConnectClientCombined"},
    Row{EntryType::connect_client_combined_ret, "ConnectClientCombinedRet"},
    Row{EntryType::endpoint_check_capability, "EndpointCheckCapability"},
    Row{EntryType::endpoint_check_capability_ret, "EndpointCheckCapabilityRet"},
    Row{EntryType::service_check_capability_req, "ServiceCheckCapabilityReq"},
    Row{EntryType::service_check_capability_ret, "ServiceCheckCapabilityRet"},
    Row{EntryType::client_keep_alive_req, "ClientKeepAliveReq"},
    Row{EntryType::client_keep_alive_ret, "ClientKeepAliveRet"},
    Row{EntryType::client_session_op_req, "ClientSessionOpReq"},
    Row{EntryType::client_session_op_ret, "ClientSessionOpRet"},
    Row{EntryType::service_path_released_req, "ServicePathReleasedReq"},
    Row{EntryType::service_path_released_ret, "ServicePathReleasedRet"},
    Row{EntryType::property_get_req, "PropertyGetReq"},
    Row{EntryType::property_get_res, "PropertyGetRes"},
    Row{EntryType::property_set_req, "PropertySetReq"},
    Row{EntryType::property_set_res, "PropertySetRes"},
    Row{EntryType::function_call_req, "FunctionCallReq"},
    Row{EntryType::function_call_res, "FunctionCallRes"},
    Row{EntryType::generator_next_req, "GeneratorNextReq"},
    Row{EntryType::generator_next_res, "GeneratorNextRes"},
    Row{EntryType::event_req, "EventReq"},
    Row{EntryType::event_res, "EventRes"},
    Row{EntryType::pipe_packet, "PipePacket"},
    Row{EntryType::pipe_packet_ret, "PipePacketRet"},
    Row{EntryType::pipe_connect_req, "PipeConnectReq"},
    Row{EntryType::pipe_connect_ret, "PipeConnectRet"},
    Row{EntryType::pipe_disconnect_req, "PipeDisconnectReq"},
    Row{EntryType::pipe_disconnect_ret, "PipeDisconnectRet"},
    Row{EntryType::pipe_closed, "PipeClosed"},
    Row{EntryType::pipe_closed_ret, "PipeClosedRet"},
    Row{EntryType::callback_call_req, "CallbackCallReq"},
    Row{EntryType::callback_call_ret, "CallbackCallRet"},
    Row{EntryType::wire_packet, "WirePacket"},
    Row{EntryType::wire_packet_ret, "WirePacketRet"},
    Row{EntryType::wire_connect_req, "WireConnectReq"},
    Row{EntryType::wire_connect_ret, "WireConnectRet"},
    Row{EntryType::wire_disconnect_req, "WireDisconnectReq"},
    Row{EntryType::wire_disconnect_ret, "WireDisconnectRet"},
    Row{EntryType::wire_closed, "WireClosed"},
    Row{EntryType::wire_closed_ret, "WireClosedRet"},
    Row{EntryType::memory_read, "MemoryRead"},
    Row{EntryType::memory_read_ret, "MemoryReadRet"},
    Row{EntryType::memory_write, "MemoryWrite"},
    Row{EntryType::memory_write_ret, "MemoryWriteRet"},
    Row{EntryType::memory_get_param, "MemoryGetParam"},
    Row{EntryType::memory_get_param_ret, "MemoryGetParamRet"},
    Row{EntryType::wire_peek_in_value_req, "WirePeekInValueReq"},
    Row{EntryType::wire_peek_in_value_ret, "WirePeekInValueRet"},
    Row{EntryType::wire_peek_out_value_req, "WirePeekOutValueReq"},
    Row{EntryType::wire_peek_out_value_ret, "WirePeekOutValueRet"},
    Row{EntryType::wire_poke_out_value_req, "WirePokeOutValueReq"},
    Row{EntryType::wire_poke_out_value_ret, "WirePokeOutValueRet"},
};

}  // namespace

std::string name_of(EntryType type) {
  for (const auto& [known, name] : entry_names) {
    if (known == type) return std::string(name);
  }
  return "EntryType" + std::to_string(static_cast<unsigned>(type));
}

std::optional<EntryType> entry_type_of(std::string_view name) {
  for (const auto& [type, known] : entry_names) {
    if (known == name) return type;
  }
  std::uint16_t number = 0;
  const char* const end = name.data() + name.size();
  const auto result = std::from_chars(name.data(), end, number);
  if (name.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return static_cast<EntryType>(number);
}

std::string name_of_exchange(EntryType request) {
  std::string name = name_of(request);
  if (name.ends_with("Req")) name.resize(name.size() - 3);
  return name;
}

std::string name_of(ElementType type) {
  const std::string_view known = word_of(type);
  return known.empty() ? "type" + std::to_string(static_cast<unsigned>(type)) : std::string(known);
}

}  // namespace rr::replay
