// SPDX-License-Identifier: Apache-2.0
using System;

namespace Robdef.Runtime;

// A class for each error of the protocol, thrown by whichever side: what a handler throws is what its peer
// catches. Where System has a class of the same name ours begins with `Robdef`, so that both can be used in one file.

/// <summary>There is no connection, or it was lost.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ConnectionException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ConnectionError, NameOf(ErrorCode.ConnectionError), message, subName, parameter, innerException);

/// <summary>A message does not follow the protocol.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ProtocolException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ProtocolError, NameOf(ErrorCode.ProtocolError), message, subName, parameter, innerException);

/// <summary>The node has no such service, or it was closed.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ServiceNotFoundException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ServiceNotFound, NameOf(ErrorCode.ServiceNotFound), message, subName, parameter, innerException);

/// <summary>The service has no object at the path.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ObjectNotFoundException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ObjectNotFound, NameOf(ErrorCode.ObjectNotFound), message, subName, parameter, innerException);

/// <summary>The session does not exist any more.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class InvalidEndpointException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.InvalidEndpoint, NameOf(ErrorCode.InvalidEndpoint), message, subName, parameter, innerException);

/// <summary>The session cannot go on.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class EndpointCommunicationFatalException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.EndpointCommunicationFatalError, NameOf(ErrorCode.EndpointCommunicationFatalError), message, subName, parameter, innerException);

/// <summary>The message was for another node.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class NodeNotFoundException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.NodeNotFound, NameOf(ErrorCode.NodeNotFound), message, subName, parameter, innerException);

/// <summary>The service cannot do what was asked of it.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ServiceException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ServiceError, NameOf(ErrorCode.ServiceError), message, subName, parameter, innerException);

/// <summary>The object has no such member.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class MemberNotFoundException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.MemberNotFound, NameOf(ErrorCode.MemberNotFound), message, subName, parameter, innerException);

/// <summary>The member is of another form than the request wants.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class MemberFormatMismatchException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.MemberFormatMismatch, NameOf(ErrorCode.MemberFormatMismatch), message, subName, parameter, innerException);

/// <summary>A value is not of the type that the member has.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class DataTypeMismatchException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.DataTypeMismatch, NameOf(ErrorCode.DataTypeMismatch), message, subName, parameter, innerException);

/// <summary>A value may not travel, or is of no known type.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class DataTypeException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.DataTypeError, NameOf(ErrorCode.DataTypeError), message, subName, parameter, innerException);

/// <summary>Bytes are not a value.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class DataSerializationException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.DataSerializationError, NameOf(ErrorCode.DataSerializationError), message, subName, parameter, innerException);

/// <summary>A message lacks an entry.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class MessageEntryNotFoundException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.MessageEntryNotFound, NameOf(ErrorCode.MessageEntryNotFound), message, subName, parameter, innerException);

/// <summary>A message lacks an element.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class MessageElementNotFoundException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.MessageElementNotFound, NameOf(ErrorCode.MessageElementNotFound), message, subName, parameter, innerException);

/// <summary>A failure of which nothing else is known; its name counts.</summary>
/// <param name="message">For people.</param>
/// <param name="name">Qualified, which receivers see.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class UnknownException(string message, string name = "RobotRaconteur.UnknownError", string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.UnknownError, name, message, subName, parameter, innerException);

/// <summary>The operation does not fit the state. Not System.InvalidOperationException.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class RobdefInvalidOperationException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.InvalidOperation, NameOf(ErrorCode.InvalidOperation), message, subName, parameter, innerException);

/// <summary>An argument is wrong.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class InvalidArgumentException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.InvalidArgument, NameOf(ErrorCode.InvalidArgument), message, subName, parameter, innerException);

/// <summary>The operation has failed.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class OperationFailedException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.OperationFailed, NameOf(ErrorCode.OperationFailed), message, subName, parameter, innerException);

/// <summary>A value is null that may not be.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class NullValueException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.NullValue, NameOf(ErrorCode.NullValue), message, subName, parameter, innerException);

/// <summary>The peer has a fault.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class InternalErrorException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.InternalError, NameOf(ErrorCode.InternalError), message, subName, parameter, innerException);

/// <summary>The system does not let the peer have a resource.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class SystemResourcePermissionDeniedException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.SystemResourcePermissionDenied, NameOf(ErrorCode.SystemResourcePermissionDenied), message, subName, parameter, innerException);

/// <summary>A resource of the peer, or what it grants a client, is used up.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class OutOfSystemResourceException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.OutOfSystemResource, NameOf(ErrorCode.OutOfSystemResource), message, subName, parameter, innerException);

/// <summary>A resource of the peer's system has failed.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class SystemResourceException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.SystemResourceError, NameOf(ErrorCode.SystemResourceError), message, subName, parameter, innerException);

/// <summary>There is no such resource.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ResourceNotFoundException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ResourceNotFound, NameOf(ErrorCode.ResourceNotFound), message, subName, parameter, innerException);

/// <summary>Reading or writing has failed. Not System.IO.IOException.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class RobdefIOException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.IOError, NameOf(ErrorCode.IOError), message, subName, parameter, innerException);

/// <summary>Something is larger than a buffer, or a queue is full.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class BufferLimitViolationException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.BufferLimitViolation, NameOf(ErrorCode.BufferLimitViolation), message, subName, parameter, innerException);

/// <summary>A service definition is wrong or unknown.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ServiceDefinitionException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ServiceDefinitionError, NameOf(ErrorCode.ServiceDefinitionError), message, subName, parameter, innerException);

/// <summary>An index or number is out of its range.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class OutOfRangeException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.OutOfRange, NameOf(ErrorCode.OutOfRange), message, subName, parameter, innerException);

/// <summary>There is nothing of that key. Not System.Collections.Generic.KeyNotFoundException.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class RobdefKeyNotFoundException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.KeyNotFound, NameOf(ErrorCode.KeyNotFound), message, subName, parameter, innerException);

/// <summary>A setting is wrong.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class InvalidConfigurationException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.InvalidConfiguration, NameOf(ErrorCode.InvalidConfiguration), message, subName, parameter, innerException);

/// <summary>The object is in another state than the operation needs.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class InvalidStateException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.InvalidState, NameOf(ErrorCode.InvalidState), message, subName, parameter, innerException);

/// <summary>A peer's exception that no class of this program stands for; its name counts.</summary>
/// <param name="message">For people.</param>
/// <param name="name">Qualified, which receivers see.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class RemoteException(string message, string name = "", string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.RemoteError, name, message, subName, parameter, innerException);

/// <summary>There was no answer in time.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class RequestTimeoutException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.RequestTimeout, NameOf(ErrorCode.RequestTimeout), message, subName, parameter, innerException);

/// <summary>The member can only be read.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ReadOnlyMemberException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ReadOnlyMember, NameOf(ErrorCode.ReadOnlyMember), message, subName, parameter, innerException);

/// <summary>The member can only be written.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class WriteOnlyMemberException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.WriteOnlyMember, NameOf(ErrorCode.WriteOnlyMember), message, subName, parameter, innerException);

/// <summary>The member is not implemented. Not System.NotImplementedException.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class RobdefNotImplementedException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.NotImplementedError, NameOf(ErrorCode.NotImplementedError), message, subName, parameter, innerException);

/// <summary>The member is in use.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class MemberBusyException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.MemberBusy, NameOf(ErrorCode.MemberBusy), message, subName, parameter, innerException);

/// <summary>There is no value yet.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ValueNotSetException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ValueNotSet, NameOf(ErrorCode.ValueNotSet), message, subName, parameter, innerException);

/// <summary>The operation is to be broken off.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class AbortOperationException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.AbortOperation, NameOf(ErrorCode.AbortOperation), message, subName, parameter, innerException);

/// <summary>The operation was broken off.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class OperationAbortedException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.OperationAborted, NameOf(ErrorCode.OperationAborted), message, subName, parameter, innerException);

/// <summary>A generator has come to its end.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class StopIterationException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.StopIteration, NameOf(ErrorCode.StopIteration), message, subName, parameter, innerException);

/// <summary>The operation has not ended in time.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class OperationTimeoutException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.OperationTimeout, NameOf(ErrorCode.OperationTimeout), message, subName, parameter, innerException);

/// <summary>The operation was cancelled. What a CancellationToken ends throws System.OperationCanceledException.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class OperationCancelledException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.OperationCancelled, NameOf(ErrorCode.OperationCancelled), message, subName, parameter, innerException);

/// <summary>Nobody could be logged in. Not System.Security.Authentication.AuthenticationException.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class RobdefAuthenticationException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.AuthenticationError, NameOf(ErrorCode.AuthenticationError), message, subName, parameter, innerException);

/// <summary>Another user or session has locked the object.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class ObjectLockedException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.ObjectLockedError, NameOf(ErrorCode.ObjectLockedError), message, subName, parameter, innerException);

/// <summary>The user may not do that.</summary>
/// <param name="message">For people.</param>
/// <param name="subName">A finer name, or empty.</param>
/// <param name="parameter">Any value, or null.</param>
/// <param name="innerException">The cause, which stays on this side.</param>
public class PermissionDeniedException(string message, string subName = "", VarValue? parameter = null, Exception? innerException = null)
    : RobdefException(ErrorCode.PermissionDenied, NameOf(ErrorCode.PermissionDenied), message, subName, parameter, innerException);
