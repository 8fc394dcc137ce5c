// SPDX-License-Identifier: Apache-2.0
namespace Robdef.Runtime;

/// <summary>Exceptions of the classes that their codes have.</summary>
internal static class Errors
{
    /// <summary>An error with the code's own name.</summary>
    public static RobdefException Of(ErrorCode code, string message) => Of(code, RobdefException.NameOf(code), message, "", null);

    /// <summary>An error with all that travels. A code that the protocol does not have is a plain RobdefException.</summary>
    public static RobdefException Of(ErrorCode code, string name, string message, string subName, VarValue? parameter) => code switch
    {
        ErrorCode.ConnectionError => new ConnectionException(message, subName, parameter),
        ErrorCode.ProtocolError => new ProtocolException(message, subName, parameter),
        ErrorCode.ServiceNotFound => new ServiceNotFoundException(message, subName, parameter),
        ErrorCode.ObjectNotFound => new ObjectNotFoundException(message, subName, parameter),
        ErrorCode.InvalidEndpoint => new InvalidEndpointException(message, subName, parameter),
        ErrorCode.EndpointCommunicationFatalError => new EndpointCommunicationFatalException(message, subName, parameter),
        ErrorCode.NodeNotFound => new NodeNotFoundException(message, subName, parameter),
        ErrorCode.ServiceError => new ServiceException(message, subName, parameter),
        ErrorCode.MemberNotFound => new MemberNotFoundException(message, subName, parameter),
        ErrorCode.MemberFormatMismatch => new MemberFormatMismatchException(message, subName, parameter),
        ErrorCode.DataTypeMismatch => new DataTypeMismatchException(message, subName, parameter),
        ErrorCode.DataTypeError => new DataTypeException(message, subName, parameter),
        ErrorCode.DataSerializationError => new DataSerializationException(message, subName, parameter),
        ErrorCode.MessageEntryNotFound => new MessageEntryNotFoundException(message, subName, parameter),
        ErrorCode.MessageElementNotFound => new MessageElementNotFoundException(message, subName, parameter),
        ErrorCode.UnknownError => new UnknownException(message, name, subName, parameter),
        ErrorCode.InvalidOperation => new RobdefInvalidOperationException(message, subName, parameter),
        ErrorCode.InvalidArgument => new InvalidArgumentException(message, subName, parameter),
        ErrorCode.OperationFailed => new OperationFailedException(message, subName, parameter),
        ErrorCode.NullValue => new NullValueException(message, subName, parameter),
        ErrorCode.InternalError => new InternalErrorException(message, subName, parameter),
        ErrorCode.SystemResourcePermissionDenied => new SystemResourcePermissionDeniedException(message, subName, parameter),
        ErrorCode.OutOfSystemResource => new OutOfSystemResourceException(message, subName, parameter),
        ErrorCode.SystemResourceError => new SystemResourceException(message, subName, parameter),
        ErrorCode.ResourceNotFound => new ResourceNotFoundException(message, subName, parameter),
        ErrorCode.IOError => new RobdefIOException(message, subName, parameter),
        ErrorCode.BufferLimitViolation => new BufferLimitViolationException(message, subName, parameter),
        ErrorCode.ServiceDefinitionError => new ServiceDefinitionException(message, subName, parameter),
        ErrorCode.OutOfRange => new OutOfRangeException(message, subName, parameter),
        ErrorCode.KeyNotFound => new RobdefKeyNotFoundException(message, subName, parameter),
        ErrorCode.InvalidConfiguration => new InvalidConfigurationException(message, subName, parameter),
        ErrorCode.InvalidState => new InvalidStateException(message, subName, parameter),
        ErrorCode.RemoteError => new RemoteException(message, name, subName, parameter),
        ErrorCode.RequestTimeout => new RequestTimeoutException(message, subName, parameter),
        ErrorCode.ReadOnlyMember => new ReadOnlyMemberException(message, subName, parameter),
        ErrorCode.WriteOnlyMember => new WriteOnlyMemberException(message, subName, parameter),
        ErrorCode.NotImplementedError => new RobdefNotImplementedException(message, subName, parameter),
        ErrorCode.MemberBusy => new MemberBusyException(message, subName, parameter),
        ErrorCode.ValueNotSet => new ValueNotSetException(message, subName, parameter),
        ErrorCode.AbortOperation => new AbortOperationException(message, subName, parameter),
        ErrorCode.OperationAborted => new OperationAbortedException(message, subName, parameter),
        ErrorCode.StopIteration => new StopIterationException(message, subName, parameter),
        ErrorCode.OperationTimeout => new OperationTimeoutException(message, subName, parameter),
        ErrorCode.OperationCancelled => new OperationCancelledException(message, subName, parameter),
        ErrorCode.AuthenticationError => new RobdefAuthenticationException(message, subName, parameter),
        ErrorCode.ObjectLockedError => new ObjectLockedException(message, subName, parameter),
        ErrorCode.PermissionDenied => new PermissionDeniedException(message, subName, parameter),
        _ => new RobdefException(code, name, message, subName, parameter),
    };
}
