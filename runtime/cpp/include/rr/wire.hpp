// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "rr/visibility.hpp"

/// Numbers of the wire protocol (01 section 5, README of the specification).
namespace RR_VISIBLE rr {

/// What an element holds (01, section 5).
enum class ElementType : std::uint16_t {
  void_ = 0,
  double_ = 1,
  single = 2,
  int8 = 3,
  uint8 = 4,
  int16 = 5,
  uint16 = 6,
  int32 = 7,
  uint32 = 8,
  int64 = 9,
  uint64 = 10,
  string = 11,
  cdouble = 12,
  csingle = 13,
  bool_ = 14,
  structure = 101,
  vector = 102,      ///< map with int32 keys
  dictionary = 103,  ///< map with string keys
  list = 108,
  pod = 109,
  pod_array = 110,
  pod_multidimarray = 111,
  namedarray_array = 115,
  namedarray_multidimarray = 116,
  multidimarray = 117,
};

/// Bytes of one item of a primitive type: 1 for string, 0 for void and nested types.
constexpr std::size_t item_size(ElementType type) {
  switch (type) {
    case ElementType::double_:
    case ElementType::int64:
    case ElementType::uint64:
    case ElementType::csingle:
      return 8;
    case ElementType::single:
    case ElementType::int32:
    case ElementType::uint32:
      return 4;
    case ElementType::int16:
    case ElementType::uint16:
      return 2;
    case ElementType::int8:
    case ElementType::uint8:
    case ElementType::string:
    case ElementType::bool_:
      return 1;
    case ElementType::cdouble:
      return 16;
    default:
      return 0;
  }
}

/// True for the types whose payload is a list of elements.
constexpr bool is_nested(ElementType type) {
  const auto number = static_cast<std::uint16_t>(type);
  return (number >= 101 && number <= 103) || (number >= 108 && number <= 111) ||
         (number >= 115 && number <= 117);
}

/// What an entry asks or answers. A response is its request plus one; MemoryWrite alone is answered
/// with MemoryReadRet.
enum class EntryType : std::uint16_t {
  null = 0,
  stream_op = 1,
  stream_op_ret = 2,
  stream_check_capability = 3,
  stream_check_capability_ret = 4,
  get_service_desc = 101,
  get_service_desc_ret = 102,
  object_type_name = 103,
  object_type_name_ret = 104,
  service_closed = 105,
  service_closed_ret = 106,
  connect_client = 107,
  connect_client_ret = 108,
  disconnect_client = 109,
  disconnect_client_ret = 110,
  connection_test = 111,
  connection_test_ret = 112,
  get_node_info = 113,
  get_node_info_ret = 114,
  reconnect_client = 115,
  reconnect_client_ret = 116,
  node_check_capability = 117,
  node_check_capability_ret = 118,
  get_service_attributes = 119,
  get_service_attributes_ret = 120,
  connect_client_combined = 121,
  connect_client_combined_ret = 122,
  endpoint_check_capability = 501,
  endpoint_check_capability_ret = 502,
  service_check_capability_req = 1101,
  service_check_capability_ret = 1102,
  client_keep_alive_req = 1105,
  client_keep_alive_ret = 1106,
  client_session_op_req = 1107,
  client_session_op_ret = 1108,
  service_path_released_req = 1109,
  service_path_released_ret = 1110,
  property_get_req = 1111,
  property_get_res = 1112,
  property_set_req = 1113,
  property_set_res = 1114,
  function_call_req = 1121,
  function_call_res = 1122,
  generator_next_req = 1123,
  generator_next_res = 1124,
  event_req = 1131,
  event_res = 1132,
  pipe_packet = 1141,
  pipe_packet_ret = 1142,
  pipe_connect_req = 1143,
  pipe_connect_ret = 1144,
  pipe_disconnect_req = 1145,
  pipe_disconnect_ret = 1146,
  pipe_closed = 1147,
  pipe_closed_ret = 1148,
  callback_call_req = 1151,
  callback_call_ret = 1152,
  wire_packet = 1161,
  wire_packet_ret = 1162,
  wire_connect_req = 1163,
  wire_connect_ret = 1164,
  wire_disconnect_req = 1165,
  wire_disconnect_ret = 1166,
  wire_closed = 1167,
  wire_closed_ret = 1168,
  memory_read = 1171,
  memory_read_ret = 1172,
  memory_write = 1173,
  memory_write_ret = 1174,
  memory_get_param = 1175,
  memory_get_param_ret = 1176,
  wire_peek_in_value_req = 1181,
  wire_peek_in_value_ret = 1182,
  wire_peek_out_value_req = 1183,
  wire_peek_out_value_ret = 1184,
  wire_poke_out_value_req = 1185,
  wire_poke_out_value_ret = 1186,
};

/// The two message formats. Every connection starts in v2 and may agree on v4.
enum class MessageVersion : std::uint8_t { v2 = 2, v4 = 4 };

/// Bounds that are checked before anything is believed. Exceeding one while reading fails the
/// message, which closes the connection.
struct Limits {
  static constexpr std::uint32_t deepest = 64;

  std::uint32_t message_size = 12 * 1024 * 1024;  ///< bytes; senders stop 100 bytes earlier
  /// Nesting of elements: those of an entry are at depth 1. Never more than `deepest`.
  std::uint32_t depth = deepest;
};

}  // namespace rr
