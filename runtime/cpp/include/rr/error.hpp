// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <string>
#include <string_view>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

class VarValue;

/// Error codes of the protocol. Receivers decide by the code; the name matters for unknown_error
/// and remote_error only.
enum class ErrorCode : std::uint16_t {
  none = 0,
  connection_error = 1,
  protocol_error = 2,
  service_not_found = 3,
  object_not_found = 4,
  invalid_endpoint = 5,
  endpoint_communication_fatal_error = 6,
  node_not_found = 7,
  service_error = 8,
  member_not_found = 9,
  member_format_mismatch = 10,
  data_type_mismatch = 11,
  data_type_error = 12,
  data_serialization_error = 13,
  message_entry_not_found = 14,
  message_element_not_found = 15,
  unknown_error = 16,
  invalid_operation = 17,
  invalid_argument = 18,
  operation_failed = 19,
  null_value = 20,
  internal_error = 21,
  system_resource_permission_denied = 22,
  out_of_system_resource = 23,
  system_resource_error = 24,
  resource_not_found = 25,
  io_error = 26,
  buffer_limit_violation = 27,
  service_definition_error = 28,
  out_of_range = 29,
  key_not_found = 30,
  invalid_configuration = 31,
  invalid_state = 32,
  remote_error = 100,
  request_timeout = 101,
  read_only_member = 102,
  write_only_member = 103,
  not_implemented_error = 104,
  member_busy = 105,
  value_not_set = 106,
  abort_operation = 107,
  operation_aborted = 108,
  stop_iteration = 109,
  operation_timeout = 110,
  operation_cancelled = 111,
  authentication_error = 150,
  object_locked_error = 151,
  permission_denied = 152,
};

/// `RobotRaconteur.ConnectionError` for connection_error, and so on; empty for codes without a
/// fixed name.
std::string_view error_name(ErrorCode code);

/// Any failure of the runtime or of a peer: a code, a name, a sub-name, a message and an optional
/// parameter value, the same on both sides of the wire. An `exception` of a definition is a class
/// derived from it.
class Error : public std::exception {
 public:
  /// With the code's own name.
  Error(ErrorCode code, std::string message);
  Error(ErrorCode code, std::string name, std::string message, std::string subname = {});
  Error(ErrorCode code, std::string name, std::string message, std::string subname,
        const VarValue& parameter);
  Error(const Error&) = default;
  Error& operator=(const Error&) = default;
  ~Error() override;

  [[nodiscard]] ErrorCode code() const { return code_; }
  /// Qualified: `RobotRaconteur.OutOfRange`, `example.probe.ProbeFault`.
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& message() const { return message_; }
  [[nodiscard]] const std::string& subname() const { return subname_; }
  /// Null when the error carries none.
  [[nodiscard]] const VarValue& parameter() const;
  /// `name: message`
  [[nodiscard]] const char* what() const noexcept override { return what_.c_str(); }

 private:
  ErrorCode code_;
  std::string name_;
  std::string message_;
  std::string subname_;
  std::string what_;
  std::shared_ptr<const VarValue> parameter_;
};

}  // namespace rr
