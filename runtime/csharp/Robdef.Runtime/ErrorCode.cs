// SPDX-License-Identifier: Apache-2.0
namespace Robdef.Runtime;

/// <summary>
/// Error codes of the protocol. Receivers decide by the code; the name matters for
/// <see cref="UnknownError"/> and <see cref="RemoteError"/> only.
/// </summary>
public enum ErrorCode
{
#pragma warning disable CS1591 // Each is called what it is.
    /// <summary>No error.</summary>
    None = 0,
    /// <summary>There is no connection, or it was lost.</summary>
    ConnectionError = 1,
    /// <summary>The other side has broken the rules of the protocol.</summary>
    ProtocolError = 2,
    /// <summary>There is no service of this name.</summary>
    ServiceNotFound = 3,
    /// <summary>There is no object at this path.</summary>
    ObjectNotFound = 4,
    /// <summary>The session is not, or no longer, there.</summary>
    InvalidEndpoint = 5,
    /// <summary>The session cannot go on.</summary>
    EndpointCommunicationFatalError = 6,
    /// <summary>There is no node of this id or name at the address.</summary>
    NodeNotFound = 7,
    /// <summary>The service does not do what was asked for.</summary>
    ServiceError = 8,
    /// <summary>The object has no such member.</summary>
    MemberNotFound = 9,
    /// <summary>The member exists, and is of another kind.</summary>
    MemberFormatMismatch = 10,
    /// <summary>A value of another type than declared.</summary>
    DataTypeMismatch = 11,
    /// <summary>A value that is no value of its type: length, dims, keys.</summary>
    DataTypeError = 12,
    /// <summary>Bytes that are no elements.</summary>
    DataSerializationError = 13,
    /// <summary>A message without an entry that it must have.</summary>
    MessageEntryNotFound = 14,
    /// <summary>An argument, a field or a part of a value is missing.</summary>
    MessageElementNotFound = 15,
    /// <summary>An error without a code of its own: see its name.</summary>
    UnknownError = 16,
    /// <summary>Not in this state, or not twice.</summary>
    InvalidOperation = 17,
    /// <summary>An argument that makes no sense.</summary>
    InvalidArgument = 18,
    /// <summary>Tried, and failed.</summary>
    OperationFailed = 19,
    /// <summary>Null where a value must be.</summary>
    NullValue = 20,
    /// <summary>A mistake in the runtime.</summary>
    InternalError = 21,
    /// <summary>The system does not allow it.</summary>
    SystemResourcePermissionDenied = 22,
    /// <summary>No memory, threads or descriptors left.</summary>
    OutOfSystemResource = 23,
    /// <summary>The system has refused.</summary>
    SystemResourceError = 24,
    /// <summary>A file or another thing of the system is not there.</summary>
    ResourceNotFound = 25,
    /// <summary>Reading or writing has failed.</summary>
    IOError = 26,
    /// <summary>A queue is full, or something is larger than a limit.</summary>
    BufferLimitViolation = 27,
    /// <summary>A definition has a mistake, or differs from the program's.</summary>
    ServiceDefinitionError = 28,
    /// <summary>An index, position or number outside of what there is.</summary>
    OutOfRange = 29,
    /// <summary>A map has no such key.</summary>
    KeyNotFound = 30,
    /// <summary>Options, users, rights or certificates are wrong.</summary>
    InvalidConfiguration = 31,
    /// <summary>The object is not in a state for it.</summary>
    InvalidState = 32,
    /// <summary>An exception of a definition; the name says which.</summary>
    RemoteError = 100,
    /// <summary>No answer in time.</summary>
    RequestTimeout = 101,
    /// <summary>Setting or sending what is readonly.</summary>
    ReadOnlyMember = 102,
    /// <summary>Getting or receiving what is writeonly.</summary>
    WriteOnlyMember = 103,
    /// <summary>The service leaves this member out.</summary>
    NotImplementedError = 104,
    /// <summary>The member is in use.</summary>
    MemberBusy = 105,
    /// <summary>A wire has no value yet, or only one that has expired.</summary>
    ValueNotSet = 106,
    /// <summary>For a generator: break off.</summary>
    AbortOperation = 107,
    /// <summary>Ended before it was done, by this side or the other.</summary>
    OperationAborted = 108,
    /// <summary>A generator has come to its end: no failure.</summary>
    StopIteration = 109,
    /// <summary>The time to wait is over.</summary>
    OperationTimeout = 110,
    /// <summary>Ended by a cancellation token, or by CancelCalls.</summary>
    OperationCancelled = 111,
    /// <summary>A login was refused, or none was sent.</summary>
    AuthenticationError = 150,
    /// <summary>Another user or session has locked the object.</summary>
    ObjectLockedError = 151,
    /// <summary>The user may not do this.</summary>
    PermissionDenied = 152,
#pragma warning restore CS1591
}
