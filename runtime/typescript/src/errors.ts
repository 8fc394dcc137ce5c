// SPDX-License-Identifier: Apache-2.0
// Errors as they travel (07, section 14): one class for each code, all of them RRError.

/** Codes of errors. */
export const ErrorCode = {
  /** There is no connection, or it was lost. */
  ConnectionError: 1,
  /** The other side has broken the rules of the protocol. */
  ProtocolError: 2,
  /** There is no service of this name. */
  ServiceNotFound: 3,
  /** There is no object at this path. */
  ObjectNotFound: 4,
  /** The session is not, or no longer, there. */
  InvalidEndpoint: 5,
  /** The session cannot go on. */
  EndpointCommunicationFatalError: 6,
  /** There is no node of this id or name at the address. */
  NodeNotFound: 7,
  /** The service does not do what was asked for. */
  ServiceError: 8,
  /** The object has no such member. */
  MemberNotFound: 9,
  /** The member exists, and is of another kind. */
  MemberFormatMismatch: 10,
  /** A value of another type than declared. */
  DataTypeMismatch: 11,
  /** A value that is no value of its type: length, dims, keys. */
  DataTypeError: 12,
  /** Bytes that are no elements. */
  DataSerializationError: 13,
  /** A message without an entry that it must have. */
  MessageEntryNotFound: 14,
  /** An argument, a field or a part of a value is missing. */
  MessageElementNotFound: 15,
  /** An error without a code of its own: see its name. */
  UnknownError: 16,
  /** Not in this state, or not twice. */
  InvalidOperation: 17,
  /** An argument that makes no sense. */
  InvalidArgument: 18,
  /** Tried, and failed. */
  OperationFailed: 19,
  /** Null where a value must be. */
  NullValue: 20,
  /** A mistake in the runtime. */
  InternalError: 21,
  /** The system does not allow it. */
  SystemResourcePermissionDenied: 22,
  /** No memory, threads or descriptors left. */
  OutOfSystemResource: 23,
  /** The system has refused. */
  SystemResourceError: 24,
  /** A file or another thing of the system is not there. */
  ResourceNotFound: 25,
  /** Reading or writing has failed. */
  IOError: 26,
  /** A queue is full, or something is larger than a limit. */
  BufferLimitViolation: 27,
  /** A definition has a mistake, or differs from the program's. */
  ServiceDefinitionError: 28,
  /** An index, position or number outside of what there is. */
  OutOfRange: 29,
  /** A map has no such key. */
  KeyNotFound: 30,
  /** Options, users, rights or certificates are wrong. */
  InvalidConfiguration: 31,
  /** The object is not in a state for it. */
  InvalidState: 32,
  /** An exception of a definition; the name says which. */
  RemoteError: 100,
  /** No answer in time. */
  RequestTimeout: 101,
  /** Setting or sending what is readonly. */
  ReadOnlyMember: 102,
  /** Getting or receiving what is writeonly. */
  WriteOnlyMember: 103,
  /** The service leaves this member out. */
  NotImplementedError: 104,
  /** The member is in use. */
  MemberBusy: 105,
  /** A wire has no value yet, or only one that has expired. */
  ValueNotSet: 106,
  /** For a generator: break off. */
  AbortOperation: 107,
  /** Ended before it was done, by this side or the other. */
  OperationAborted: 108,
  /** A generator has come to its end: no failure. */
  StopIteration: 109,
  /** The time to wait is over. */
  OperationTimeout: 110,
  /** Ended by the program before its answer came. */
  OperationCancelled: 111,
  /** A login was refused, or none was sent. */
  AuthenticationError: 150,
  /** Another user or session has locked the object. */
  ObjectLockedError: 151,
  /** The user may not do this. */
  PermissionDenied: 152,
} as const;

/** One of the codes of {@link ErrorCode}; a peer may send others. */
export type ErrorCode = number;

const nameByCode = new Map<number, string>(Object.entries(ErrorCode).map(([name, code]) => [code, name]));

/** `RobotRaconteur.` and the name of a code; empty for 16, 100 and unknown codes, whose names are free. */
export function errorName(code: ErrorCode): string {
  if (code === ErrorCode.UnknownError || code === ErrorCode.RemoteError) return "";
  const name = nameByCode.get(code);
  return name === undefined ? "" : `RobotRaconteur.${name}`;
}

/** What an error may carry besides its code and message. */
export interface ErrorDetails {
  /** The name on the wire; needed only for codes 16, 100 and unknown ones. */
  errorName?: string;
  /** A code of the application, within the error. */
  subname?: string;
  /** A value of the application; a VarValue, or what one can be made of. */
  parameter?: unknown;
  /** What has caused it; stays on this side. */
  cause?: unknown;
}

/** An error of the protocol, of a peer or of this node. */
export class RRError extends Error {
  /** What receivers decide by: one of {@link ErrorCode}. */
  readonly code: ErrorCode;
  /** The name on the wire: `RobotRaconteur.` and the code's, or a qualified name of a definition. */
  readonly errorName: string;
  /** A code of the application, within the error; mostly empty. */
  readonly subname: string;
  /** A value of the application; undefined for none. */
  readonly parameter: unknown;

  constructor(code: ErrorCode, message: string, details: ErrorDetails = {}) {
    super(message, details.cause === undefined ? undefined : { cause: details.cause });
    this.code = code;
    this.errorName = details.errorName ?? (errorName(code) || (code === ErrorCode.UnknownError ? "RobotRaconteur.UnknownError" : "RobotRaconteur.RemoteError"));
    this.subname = details.subname ?? "";
    this.parameter = details.parameter ?? null;
    this.name = nameByCode.get(code) ?? "RRError";
  }
}

/** A class of errors with one code or name. */
export type ErrorClass = new (message: string, details?: ErrorDetails) => RRError;

const classes = new Map<number, ErrorClass>();

function classOf(code: ErrorCode): ErrorClass {
  const made = class extends RRError {
    constructor(message: string, details: ErrorDetails = {}) {
      super(code, message, details);
    }
  };
  Object.defineProperty(made, "name", { value: nameByCode.get(code) });
  classes.set(code, made);
  return made;
}

/** The connection was lost or could not be made. */
export const ConnectionError = classOf(ErrorCode.ConnectionError);
/** A message does not follow the protocol. */
export const ProtocolError = classOf(ErrorCode.ProtocolError);
/** The node has no such service. */
export const ServiceNotFound = classOf(ErrorCode.ServiceNotFound);
/** The service has no such object. */
export const ObjectNotFound = classOf(ErrorCode.ObjectNotFound);
/** The session is unknown to the other node. */
export const InvalidEndpoint = classOf(ErrorCode.InvalidEndpoint);
/** Another node than the wanted one answers. */
export const NodeNotFound = classOf(ErrorCode.NodeNotFound);
/** A service, or a type of one, is not known. */
export const ServiceError = classOf(ErrorCode.ServiceError);
/** The object has no such member. */
export const MemberNotFound = classOf(ErrorCode.MemberNotFound);
/** A value is of another type than the member. */
export const DataTypeMismatch = classOf(ErrorCode.DataTypeMismatch);
/** A value does not fit its type. */
export const DataTypeError = classOf(ErrorCode.DataTypeError);
/** A field, parameter or part of a value is missing. */
export const MessageElementNotFound = classOf(ErrorCode.MessageElementNotFound);
/** The operation is not possible now, or not at all. */
export const InvalidOperation = classOf(ErrorCode.InvalidOperation);
/** An argument has no meaning. */
export const InvalidArgument = classOf(ErrorCode.InvalidArgument);
/** The operation failed. */
export const OperationFailed = classOf(ErrorCode.OperationFailed);
/** A null where none may be. */
export const NullValue = classOf(ErrorCode.NullValue);
/** The other side has no room for it. */
export const OutOfSystemResource = classOf(ErrorCode.OutOfSystemResource);
/** A resource of the other side is not there. */
export const ResourceNotFound = classOf(ErrorCode.ResourceNotFound);
/** Input or output failed. */
export const IOError = classOf(ErrorCode.IOError);
/** A queue is full. */
export const BufferLimitViolation = classOf(ErrorCode.BufferLimitViolation);
/** A service definition cannot be read. */
export const ServiceDefinitionError = classOf(ErrorCode.ServiceDefinitionError);
/** An index or number is out of its range. */
export const OutOfRange = classOf(ErrorCode.OutOfRange);
/** A key is not there. */
export const KeyNotFound = classOf(ErrorCode.KeyNotFound);
/** No answer came in time. */
export const RequestTimeout = classOf(ErrorCode.RequestTimeout);
/** The member can only be read. */
export const ReadOnlyMember = classOf(ErrorCode.ReadOnlyMember);
/** The member can only be written. */
export const WriteOnlyMember = classOf(ErrorCode.WriteOnlyMember);
/** The service does not implement the member. */
export const NotImplementedError = classOf(ErrorCode.NotImplementedError);
/** The member is in use. */
export const MemberBusy = classOf(ErrorCode.MemberBusy);
/** A wire has no value, or an old one only. */
export const ValueNotSet = classOf(ErrorCode.ValueNotSet);
/** Asks a generator to abort. */
export const AbortOperation = classOf(ErrorCode.AbortOperation);
/** A generator was aborted. */
export const OperationAborted = classOf(ErrorCode.OperationAborted);
/** A generator has no more values. */
export const StopIteration = classOf(ErrorCode.StopIteration);
/** An operation took too long. */
export const OperationTimeout = classOf(ErrorCode.OperationTimeout);
/** An operation was cancelled. */
export const OperationCancelled = classOf(ErrorCode.OperationCancelled);
/** The user is not known, or has to log in. */
export const AuthenticationError = classOf(ErrorCode.AuthenticationError);
/** Somebody else has locked the object. */
export const ObjectLockedError = classOf(ErrorCode.ObjectLockedError);
/** The user has not the right to do this. */
export const PermissionDenied = classOf(ErrorCode.PermissionDenied);

/** An error of this code, of the code's class where it has one. */
export function makeError(code: ErrorCode, message: string, details: ErrorDetails = {}): RRError {
  const known = classes.get(code);
  return known ? new known(message, details) : new RRError(code, message, details);
}
