// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdint.h>

class __FlashStringHelper;

namespace rr {

/// How a member ended. The numbers are those of the errors that clients get (07, section 14). An
/// exception of the definition has a number from 192 on, which the generated header names.
enum class Status : uint8_t {
  Ok = 0,
  ProtocolError = 2,
  ObjectNotFound = 4,
  MemberNotFound = 9,
  DataTypeMismatch = 11,
  DataSerializationError = 13,
  InvalidOperation = 17,
  InvalidArgument = 18,
  OperationFailed = 19,
  NullValue = 20,
  InternalError = 21,
  IOError = 26,
  BufferLimitViolation = 27,
  OutOfRange = 29,
  InvalidState = 32,
  RequestTimeout = 101,
  ReadOnlyMember = 102,
  WriteOnlyMember = 103,
  NotImplemented = 104,
  MemberBusy = 105,
  ValueNotSet = 106,
  OperationAborted = 108,
};

/// Why the member that is being called refuses; null: it does not say. In flash.
extern const char* refusalReason;

/// What a member gives that refuses a request and says why, for people:
///
///   return rr::refuse(rr::Status::OutOfRange, F("a fade takes at most 60 seconds"));
///
/// Clients get the text, UTF-8, with the error. Outside of members it does nothing.
inline Status refuse(Status status, const __FlashStringHelper* reason) {
  refusalReason = reinterpret_cast<const char*>(reason);
  return status;
}

}  // namespace rr
