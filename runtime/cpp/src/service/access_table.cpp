// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/access_table.hpp"

#include <array>
#include <cstddef>

namespace rr::service {
namespace {

constexpr RightSet none = 0;
constexpr RightSet right(Right one) { return static_cast<RightSet>(one); }

using enum EntryType;

constexpr std::array received{
    // Special requests, before there is a session
    AccessRow{get_node_info, Needs::nothing, none},
    AccessRow{node_check_capability, Needs::nothing, none},
    AccessRow{connection_test, Needs::nothing, none},
    AccessRow{get_service_desc, Needs::nothing, none},
    AccessRow{get_service_attributes, Needs::nothing, none},
    AccessRow{connect_client, Needs::nothing, none},
    AccessRow{connect_client_combined, Needs::nothing, none},
    AccessRow{disconnect_client, Needs::nothing, none},
    // Of the session itself
    AccessRow{client_keep_alive_req, Needs::session, none},
    AccessRow{endpoint_check_capability, Needs::user, none},
    AccessRow{service_check_capability_req, Needs::user, none},
    AccessRow{object_type_name, Needs::user, right(Right::describe)},
    // Of members
    AccessRow{property_get_req, Needs::user, right(Right::get), Locked::refused_to_read, "get"},
    AccessRow{property_set_req, Needs::user, right(Right::set), Locked::refused, "set"},
    AccessRow{function_call_req, Needs::user, right(Right::call), Locked::refused, "call"},
    AccessRow{generator_next_req, Needs::user, right(Right::call), Locked::refused, "call"},
    AccessRow{pipe_connect_req, Needs::user, right(Right::connect), Locked::refused, "connect"},
    AccessRow{pipe_disconnect_req, Needs::user, none, Locked::refused, "disconnect"},
    AccessRow{pipe_packet, Needs::user, right(Right::send)},
    AccessRow{pipe_packet_ret, Needs::user, right(Right::connect)},
    AccessRow{wire_connect_req, Needs::user, right(Right::connect), Locked::refused, "connect"},
    AccessRow{wire_disconnect_req, Needs::user, none, Locked::refused, "disconnect"},
    AccessRow{wire_packet, Needs::user, right(Right::send)},
    AccessRow{wire_peek_in_value_req, Needs::user, right(Right::peek), Locked::refused, "peek"},
    AccessRow{wire_peek_out_value_req, Needs::user, right(Right::peek), Locked::refused, "peek"},
    AccessRow{wire_poke_out_value_req, Needs::user, right(Right::poke), Locked::refused, "poke"},
    AccessRow{memory_read, Needs::user, right(Right::read), Locked::refused_to_read, "read"},
    AccessRow{memory_write, Needs::user, right(Right::write), Locked::refused, "write"},
    AccessRow{memory_get_param, Needs::user, Right::read | Right::write, Locked::refused_to_read,
              "read"},
    AccessRow{callback_call_ret, Needs::user, right(Right::callback)},
};

constexpr std::array sent{
    AccessRow{event_req, Needs::user, right(Right::event)},
    AccessRow{pipe_packet, Needs::user, right(Right::connect)},
    AccessRow{wire_packet, Needs::user, right(Right::connect)},
    AccessRow{callback_call_req, Needs::user, right(Right::callback)},
    AccessRow{service_path_released_req, Needs::user, right(Right::describe)},
    AccessRow{service_closed, Needs::user, none},
};

// What nobody knows is answered with an error, to those who may use the service.
constexpr AccessRow unknown{null, Needs::user, none};

struct OperationRow {
  std::string_view operation;
  AccessRow row;
};
constexpr RightSet lock = right(Right::lock);
constexpr std::array operations{
    OperationRow{"AuthenticateUser", {client_session_op_req, Needs::session, none}},
    OperationRow{"LogoutUser", {client_session_op_req, Needs::session, none}},
    OperationRow{"RequestObjectLock", {client_session_op_req, Needs::user_always, lock}},
    OperationRow{"RequestClientObjectLock", {client_session_op_req, Needs::user_always, lock}},
    OperationRow{"ReleaseObjectLock", {client_session_op_req, Needs::user_always, lock}},
    OperationRow{"MonitorEnter", {client_session_op_req, Needs::user, lock}},
    OperationRow{"MonitorContinueEnter", {client_session_op_req, Needs::user, lock}},
    OperationRow{"MonitorExit", {client_session_op_req, Needs::user, none}},
};
// Others are answered with an error.
constexpr AccessRow unknown_operation{client_session_op_req, Needs::session, none};

// Entry types to places in a table, from 1: 0 is not there.
constexpr std::size_t type_limit = 1200;
using Index = std::array<std::uint8_t, type_limit>;
template <std::size_t Size>
constexpr Index index_of(const std::array<AccessRow, Size>& rows) {
  Index index{};
  for (std::size_t i = 0; i < Size; ++i) {
    index[static_cast<std::size_t>(rows[i].type)] = static_cast<std::uint8_t>(i + 1);
  }
  return index;
}
constexpr Index received_index = index_of(received);
constexpr Index sent_index = index_of(sent);

template <std::size_t Size>
const AccessRow& find(const std::array<AccessRow, Size>& rows, const Index& index, EntryType type) {
  const auto number = static_cast<std::size_t>(type);
  const std::size_t place = number < type_limit ? index[number] : 0;
  return place == 0 ? unknown : rows[place - 1];
}

}  // namespace

[[gnu::hot]] const AccessRow& row_of_received(EntryType type, std::string_view member) {
  if (type != client_session_op_req) return find(received, received_index, type);
  for (const OperationRow& each : operations) {
    if (each.operation == member) return each.row;
  }
  return unknown_operation;
}

const AccessRow& row_of_sent(EntryType type) { return find(sent, sent_index, type); }

}  // namespace rr::service
