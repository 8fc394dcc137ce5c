// SPDX-License-Identifier: Apache-2.0
namespace Robdef.Runtime;

/// <summary>
/// Error codes of the protocol. Receivers decide by the code; the name matters for
/// <see cref="UnknownError"/> and <see cref="RemoteError"/> only.
/// </summary>
public enum ErrorCode
{
#pragma warning disable CS1591 // Each is called what it is.
    None = 0,
    ConnectionError = 1,
    ProtocolError = 2,
    ServiceNotFound = 3,
    ObjectNotFound = 4,
    InvalidEndpoint = 5,
    EndpointCommunicationFatalError = 6,
    NodeNotFound = 7,
    ServiceError = 8,
    MemberNotFound = 9,
    MemberFormatMismatch = 10,
    DataTypeMismatch = 11,
    DataTypeError = 12,
    DataSerializationError = 13,
    MessageEntryNotFound = 14,
    MessageElementNotFound = 15,
    UnknownError = 16,
    InvalidOperation = 17,
    InvalidArgument = 18,
    OperationFailed = 19,
    NullValue = 20,
    InternalError = 21,
    SystemResourcePermissionDenied = 22,
    OutOfSystemResource = 23,
    SystemResourceError = 24,
    ResourceNotFound = 25,
    IOError = 26,
    BufferLimitViolation = 27,
    ServiceDefinitionError = 28,
    OutOfRange = 29,
    KeyNotFound = 30,
    InvalidConfiguration = 31,
    InvalidState = 32,
    RemoteError = 100,
    RequestTimeout = 101,
    ReadOnlyMember = 102,
    WriteOnlyMember = 103,
    NotImplementedError = 104,
    MemberBusy = 105,
    ValueNotSet = 106,
    AbortOperation = 107,
    OperationAborted = 108,
    StopIteration = 109,
    OperationTimeout = 110,
    OperationCancelled = 111,
    AuthenticationError = 150,
    ObjectLockedError = 151,
    PermissionDenied = 152,
#pragma warning restore CS1591
}
