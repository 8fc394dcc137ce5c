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
  void_ = 0,                       ///< null, or an empty varvalue
  double_ = 1,                     ///< IEEE 754, 8 bytes
  single = 2,                      ///< IEEE 754, 4 bytes
  int8 = 3,                        ///< 1 byte
  uint8 = 4,                       ///< 1 byte
  int16 = 5,                       ///< 2 bytes
  uint16 = 6,                      ///< 2 bytes
  int32 = 7,                       ///< 4 bytes
  uint32 = 8,                      ///< 4 bytes
  int64 = 9,                       ///< 8 bytes
  uint64 = 10,                     ///< 8 bytes
  string = 11,                     ///< bytes of UTF-8
  cdouble = 12,                    ///< two doubles: real and imaginary part
  csingle = 13,                    ///< two singles: real and imaginary part
  bool_ = 14,                      ///< 1 byte: 0 is false
  structure = 101,                 ///< a struct: fields by name
  vector = 102,                    ///< map with int32 keys
  dictionary = 103,                ///< map with string keys
  list = 108,                      ///< items numbered from 0
  pod = 109,                       ///< one pod, as an item of an array
  pod_array = 110,                 ///< pods
  pod_multidimarray = 111,         ///< pods, with dims
  namedarray_array = 115,          ///< numbers of namedarrays, one after the other
  namedarray_multidimarray = 116,  ///< the same, with dims
  multidimarray = 117,             ///< numbers, with dims
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
  null = 0,                             ///< no entry
  stream_op = 1,                        ///< what a connection is to be: its format, TLS
  stream_op_ret = 2,                    ///< the answer
  stream_check_capability = 3,          ///< what the other side's connections can do
  stream_check_capability_ret = 4,      ///< the answer
  get_service_desc = 101,               ///< the text of a definition
  get_service_desc_ret = 102,           ///< the answer
  object_type_name = 103,               ///< the type of an object
  object_type_name_ret = 104,           ///< the answer
  service_closed = 105,                 ///< to clients: the service is closed
  service_closed_ret = 106,             ///< reserved
  connect_client = 107,                 ///< a client connects to a service
  connect_client_ret = 108,             ///< the answer
  disconnect_client = 109,              ///< a client leaves
  disconnect_client_ret = 110,          ///< the answer
  connection_test = 111,                ///< shows that a connection is alive
  connection_test_ret = 112,            ///< the answer
  get_node_info = 113,                  ///< id and name of the other node
  get_node_info_ret = 114,              ///< the answer
  reconnect_client = 115,               ///< reserved
  reconnect_client_ret = 116,           ///< reserved
  node_check_capability = 117,          ///< what a node can do
  node_check_capability_ret = 118,      ///< the answer
  get_service_attributes = 119,         ///< attributes of a service
  get_service_attributes_ret = 120,     ///< the answer
  connect_client_combined = 121,        ///< the steps of connecting in one
  connect_client_combined_ret = 122,    ///< the answer
  endpoint_check_capability = 501,      ///< what an endpoint can do
  endpoint_check_capability_ret = 502,  ///< the answer
  service_check_capability_req = 1101,  ///< what a service can do
  service_check_capability_ret = 1102,  ///< the answer
  client_keep_alive_req = 1105,         ///< a client shows that it is there
  client_keep_alive_ret = 1106,         ///< the answer
  client_session_op_req = 1107,         ///< logins, locks, monitors
  client_session_op_ret = 1108,         ///< the answer
  service_path_released_req = 1109,     ///< to clients: an object is released
  service_path_released_ret = 1110,     ///< reserved
  property_get_req = 1111,              ///< gets a property
  property_get_res = 1112,              ///< the answer
  property_set_req = 1113,              ///< sets a property
  property_set_res = 1114,              ///< the answer
  function_call_req = 1121,             ///< calls a function
  function_call_res = 1122,             ///< the answer
  generator_next_req = 1123,            ///< a step of a generator, or its end
  generator_next_res = 1124,            ///< the answer
  event_req = 1131,                     ///< an event, to clients
  event_res = 1132,                     ///< reserved
  pipe_packet = 1141,                   ///< packets of a pipe
  pipe_packet_ret = 1142,               ///< acknowledges packets
  pipe_connect_req = 1143,              ///< connects an endpoint of a pipe
  pipe_connect_ret = 1144,              ///< the answer
  pipe_disconnect_req = 1145,           ///< a client closes an endpoint
  pipe_disconnect_ret = 1146,           ///< the answer
  pipe_closed = 1147,                   ///< the service closes an endpoint
  pipe_closed_ret = 1148,               ///< reserved
  callback_call_req = 1151,             ///< calls a function of a client
  callback_call_ret = 1152,             ///< the answer
  wire_packet = 1161,                   ///< a value of a wire
  wire_packet_ret = 1162,               ///< reserved
  wire_connect_req = 1163,              ///< connects a wire
  wire_connect_ret = 1164,              ///< the answer
  wire_disconnect_req = 1165,           ///< a client closes a wire
  wire_disconnect_ret = 1166,           ///< the answer
  wire_closed = 1167,                   ///< the service closes a wire
  wire_closed_ret = 1168,               ///< reserved
  memory_read = 1171,                   ///< reads a part of a memory
  memory_read_ret = 1172,               ///< the answer, and that of memory_write
  memory_write = 1173,                  ///< writes a part of a memory
  memory_write_ret = 1174,              ///< accepted as an answer to memory_write
  memory_get_param = 1175,              ///< length, dims and limits of a memory
  memory_get_param_ret = 1176,          ///< the answer
  wire_peek_in_value_req = 1181,        ///< asks for the service's value of a wire
  wire_peek_in_value_ret = 1182,        ///< the answer
  wire_peek_out_value_req = 1183,       ///< asks for the value that clients have sent
  wire_peek_out_value_ret = 1184,       ///< the answer
  wire_poke_out_value_req = 1185,       ///< gives the service a value of a wire
  wire_poke_out_value_ret = 1186,       ///< the answer
};

/// The two message formats, `v2` and `v4`. Every connection starts in v2 and may agree on v4.
enum class MessageVersion : std::uint8_t { v2 = 2, v4 = 4 };

/// Bounds that are checked before anything is believed. Exceeding one while reading fails the
/// message, which closes the connection.
struct Limits {
  /// The deepest nesting of elements in any message.
  static constexpr std::uint32_t deepest = 64;

  std::uint32_t message_size = 12 * 1024 * 1024;  ///< bytes; senders stop 100 bytes earlier
  /// Nesting of elements: those of an entry are at depth 1. Never more than `deepest`.
  std::uint32_t depth = deepest;
};

}  // namespace rr
