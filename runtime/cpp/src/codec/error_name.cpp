// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"

namespace rr {

std::string_view error_name(ErrorCode code) {
  switch (code) {
    case ErrorCode::none:
    case ErrorCode::unknown_error:
    case ErrorCode::remote_error:
      return {};
    case ErrorCode::connection_error:
      return "RobotRaconteur.ConnectionError";
    case ErrorCode::protocol_error:
      return "RobotRaconteur.ProtocolError";
    case ErrorCode::service_not_found:
      return "RobotRaconteur.ServiceNotFound";
    case ErrorCode::object_not_found:
      return "RobotRaconteur.ObjectNotFound";
    case ErrorCode::invalid_endpoint:
      return "RobotRaconteur.InvalidEndpoint";
    case ErrorCode::endpoint_communication_fatal_error:
      return "RobotRaconteur.EndpointCommunicationFatalError";
    case ErrorCode::node_not_found:
      return "RobotRaconteur.NodeNotFound";
    case ErrorCode::service_error:
      return "RobotRaconteur.ServiceError";
    case ErrorCode::member_not_found:
      return "RobotRaconteur.MemberNotFound";
    case ErrorCode::member_format_mismatch:
      return "RobotRaconteur.MemberFormatMismatch";
    case ErrorCode::data_type_mismatch:
      return "RobotRaconteur.DataTypeMismatch";
    case ErrorCode::data_type_error:
      return "RobotRaconteur.DataTypeError";
    case ErrorCode::data_serialization_error:
      return "RobotRaconteur.DataSerializationError";
    case ErrorCode::message_entry_not_found:
      return "RobotRaconteur.MessageEntryNotFound";
    case ErrorCode::message_element_not_found:
      return "RobotRaconteur.MessageElementNotFound";
    case ErrorCode::invalid_operation:
      return "RobotRaconteur.InvalidOperation";
    case ErrorCode::invalid_argument:
      return "RobotRaconteur.InvalidArgument";
    case ErrorCode::operation_failed:
      return "RobotRaconteur.OperationFailed";
    case ErrorCode::null_value:
      return "RobotRaconteur.NullValue";
    case ErrorCode::internal_error:
      return "RobotRaconteur.InternalError";
    case ErrorCode::system_resource_permission_denied:
      return "RobotRaconteur.SystemResourcePermissionDenied";
    case ErrorCode::out_of_system_resource:
      return "RobotRaconteur.OutOfSystemResource";
    case ErrorCode::system_resource_error:
      return "RobotRaconteur.SystemResourceError";
    case ErrorCode::resource_not_found:
      return "RobotRaconteur.ResourceNotFound";
    case ErrorCode::io_error:
      return "RobotRaconteur.IOError";
    case ErrorCode::buffer_limit_violation:
      return "RobotRaconteur.BufferLimitViolation";
    case ErrorCode::service_definition_error:
      return "RobotRaconteur.ServiceDefinitionError";
    case ErrorCode::out_of_range:
      return "RobotRaconteur.OutOfRange";
    case ErrorCode::key_not_found:
      return "RobotRaconteur.KeyNotFound";
    case ErrorCode::invalid_configuration:
      return "RobotRaconteur.InvalidConfiguration";
    case ErrorCode::invalid_state:
      return "RobotRaconteur.InvalidState";
    case ErrorCode::request_timeout:
      return "RobotRaconteur.RequestTimeout";
    case ErrorCode::read_only_member:
      return "RobotRaconteur.ReadOnlyMember";
    case ErrorCode::write_only_member:
      return "RobotRaconteur.WriteOnlyMember";
    case ErrorCode::not_implemented_error:
      return "RobotRaconteur.NotImplementedError";
    case ErrorCode::member_busy:
      return "RobotRaconteur.MemberBusy";
    case ErrorCode::value_not_set:
      return "RobotRaconteur.ValueNotSet";
    case ErrorCode::abort_operation:
      return "RobotRaconteur.AbortOperation";
    case ErrorCode::operation_aborted:
      return "RobotRaconteur.OperationAborted";
    case ErrorCode::stop_iteration:
      return "RobotRaconteur.StopIteration";
    case ErrorCode::operation_timeout:
      return "RobotRaconteur.OperationTimeout";
    case ErrorCode::operation_cancelled:
      return "RobotRaconteur.OperationCancelled";
    case ErrorCode::authentication_error:
      return "RobotRaconteur.AuthenticationError";
    case ErrorCode::object_locked_error:
      return "RobotRaconteur.ObjectLockedError";
    case ErrorCode::permission_denied:
      return "RobotRaconteur.PermissionDenied";
  }
  return {};  // a code from the wire that no enumerator stands for
}

}  // namespace rr
