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
  none = 0,               ///< no error
  connection_error = 1,   ///< there is no connection, or it was lost
  protocol_error = 2,     ///< the other side has broken the rules of the protocol
  service_not_found = 3,  ///< there is no service of this name
  object_not_found = 4,   ///< there is no object at this path
  invalid_endpoint = 5,   ///< the session is not, or no longer, there
  /// the session cannot go on
  endpoint_communication_fatal_error = 6,
  node_not_found = 7,              ///< there is no node of this id or name at the address
  service_error = 8,               ///< the service does not do what was asked for
  member_not_found = 9,            ///< the object has no such member
  member_format_mismatch = 10,     ///< the member exists, and is of another kind
  data_type_mismatch = 11,         ///< a value of another type than declared
  data_type_error = 12,            ///< a value that is no value of its type: length, dims, keys
  data_serialization_error = 13,   ///< bytes that are no elements
  message_entry_not_found = 14,    ///< a message without an entry that it must have
  message_element_not_found = 15,  ///< an argument, a field or a part of a value is missing
  unknown_error = 16,              ///< an error without a code of its own: see its name
  invalid_operation = 17,          ///< not in this state, or not twice
  invalid_argument = 18,           ///< an argument that makes no sense
  operation_failed = 19,           ///< tried, and failed
  null_value = 20,                 ///< null where a value must be
  internal_error = 21,             ///< a mistake in the runtime
  system_resource_permission_denied = 22,  ///< the system does not allow it
  out_of_system_resource = 23,             ///< no memory, threads or descriptors left
  system_resource_error = 24,              ///< the system has refused
  resource_not_found = 25,                 ///< a file or another thing of the system is not there
  io_error = 26,                           ///< reading or writing has failed
  buffer_limit_violation = 27,             ///< a queue is full, or something is larger than a limit
  /// a definition has a mistake, or differs from the program's
  service_definition_error = 28,
  out_of_range = 29,            ///< an index, position or number outside of what there is
  key_not_found = 30,           ///< a map has no such key
  invalid_configuration = 31,   ///< options, users, rights or certificates are wrong
  invalid_state = 32,           ///< the object is not in a state for it
  remote_error = 100,           ///< an exception of a definition; the name says which
  request_timeout = 101,        ///< no answer in time
  read_only_member = 102,       ///< setting or sending what is readonly
  write_only_member = 103,      ///< getting or receiving what is writeonly
  not_implemented_error = 104,  ///< the service leaves this member out
  member_busy = 105,            ///< the member is in use
  value_not_set = 106,          ///< a wire has no value yet, or only one that has expired
  abort_operation = 107,        ///< for a generator: break off
  operation_aborted = 108,      ///< ended before it was done, by this side or the other
  stop_iteration = 109,         ///< a generator has come to its end: no failure
  operation_timeout = 110,      ///< the time to wait is over
  operation_cancelled = 111,    ///< ended by a stop token or cancel_calls()
  authentication_error = 150,   ///< a login was refused, or none was sent
  object_locked_error = 151,    ///< another user or session has locked the object
  permission_denied = 152,      ///< the user may not do this
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
  /// With a name: of an exception of a definition, qualified, with remote_error.
  Error(ErrorCode code, std::string name, std::string message, std::string subname = {});
  /// The same with a parameter. It cannot be of a named type.
  Error(ErrorCode code, std::string name, std::string message, std::string subname,
        const VarValue& parameter);
  /// Copies share the parameter.
  Error(const Error&) = default;
  /// Copies share the parameter.
  Error& operator=(const Error&) = default;
  ~Error() override;

  /// What receivers decide by.
  [[nodiscard]] ErrorCode code() const { return code_; }
  /// Qualified: `RobotRaconteur.OutOfRange`, `example.probe.ProbeFault`.
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Text for people.
  [[nodiscard]] const std::string& message() const { return message_; }
  /// A second name inside of name(); mostly empty.
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
