// SPDX-License-Identifier: Apache-2.0
import { EntryType } from "../entry_type.js";
import { ErrorCode, makeError, type RRError } from "../errors.js";
import type { Unsubscribe } from "../listeners.js";
import { NodeId } from "../node_id.js";
import { numberElement } from "../value/pack.js";
import { authenticate, findObjectType, sessionOperation, type Connected } from "./connect.js";
import { RemoteObject } from "./remote_object.js";
import type { ClientSession } from "./session.js";
import { Stub, type StubClass } from "./stub.js";

/** A service that cannot let a client into a monitor says after this time, in milliseconds, that the client is to wait on (07, section 6). */
const monitorStep = 5_000;

/** A session with a service. Close it, or the connection stays open. */
export class Client<S extends RemoteObject | Stub = RemoteObject> {
  /** @internal */
  readonly session: ClientSession;
  /** Values that the service gave when it was connected, by their names; VarValues. */
  readonly attributes: ReadonlyMap<string, unknown>;
  /** The root object: what the client was asked to be connected as. */
  readonly root: S;

  /** @internal */
  constructor({ session, attributes }: Connected, root: S) {
    this.session = session;
    this.attributes = attributes;
    this.root = root;
  }

  /** False once the session has ended, whoever ended it. */
  get isOpen(): boolean {
    return this.session.isOpen;
  }

  /** The id of the service's node. */
  get remoteNode(): NodeId {
    return NodeId.fromBytes(this.session.connection.remoteNode ?? NodeId.any.bytes);
  }

  /** The name of the service's node; empty for none. */
  get remoteName(): string {
    return this.session.remoteName;
  }

  /** Texts of the service's definitions by their names. */
  get definitions(): ReadonlyMap<string, string> {
    const { definitions } = this.session;
    return new Map(definitions.names().map((name) => [name, definitions.find(name)?.text ?? ""]));
  }

  /** Tells the service, waits half a second at most, and ends the session. Harmless when it has ended. */
  async close(): Promise<void> {
    await this.session.close();
  }

  /**
   * Calls the handler once when the session has ended: OperationAborted means that this side closed it,
   * ServiceNotFound that the service was closed, ConnectionError a lost connection.
   */
  onClosed(handler: (reason: RRError) => void): Unsubscribe {
    return this.session.closed.add(handler);
  }

  /** Calls the handler with the paths of objects that the service has released. */
  onPathReleased(handler: (path: string) => void): Unsubscribe {
    return this.session.pathReleased.add(handler);
  }

  /** Logs in. Rejects with AuthenticationError. */
  async authenticate(username: string, credentials?: Readonly<Record<string, unknown>>): Promise<void> {
    await authenticate(this.session, username, credentials);
  }

  /** Logs out: the session goes on without a user, where the service allows that. */
  async logout(): Promise<void> {
    const { session } = this;
    await sessionOperation(session, session.service, "LogoutUser", []);
  }

  /** Locks an object and all below it for the user, or for this session alone. Rejects with ObjectLockedError. */
  async lock(object: RemoteObject | Stub, owner: "user" | "session" = "user"): Promise<void> {
    await sessionOperation(this.session, pathOf(object), owner === "user" ? "RequestObjectLock" : "RequestClientObjectLock", []);
  }

  /** Ends the user's lock at this object. Another user's needs the privilege `objectlockoverride`. */
  async unlock(object: RemoteObject | Stub): Promise<void> {
    await sessionOperation(this.session, pathOf(object), "ReleaseObjectLock", []);
  }

  /** Enters the monitor of an object. `timeout` in milliseconds; left out: as long as it takes. */
  async enterMonitor(object: RemoteObject | Stub, timeout = -1): Promise<void> {
    const path = pathOf(object);
    const words = ["OK", "Continue"];
    const limit = this.session.requestTimeout + (timeout < 0 ? monitorStep : Math.min(timeout, monitorStep));
    let word = await sessionOperation(this.session, path, "MonitorEnter", [numberElement("timeout", "int32", timeout)], words, limit);
    while (word === "Continue") word = await sessionOperation(this.session, path, "MonitorContinueEnter", [], words, limit);
  }

  /** Leaves the monitor of an object. */
  async exitMonitor(object: RemoteObject | Stub): Promise<void> {
    await sessionOperation(this.session, pathOf(object), "MonitorExit", []);
  }

  /** The type of the object at a path, as the service tells it now. */
  async findObjectType(path: string): Promise<string> {
    return await findObjectType(this.session, path);
  }

  /** The level of a capability of the service's session; 0 for an unknown one. */
  async capability(name: string): Promise<number> {
    const answer = await this.session.request({ type: EntryType.endpointCheckCapability, path: "", member: name });
    const bytes = answer.elements.find((element) => element.name === "return")?.data;
    return bytes && bytes.length >= 4 ? new DataView(bytes.buffer, bytes.byteOffset).getUint32(0, true) : 0;
  }
}

function pathOf(object: RemoteObject | Stub): string {
  return object instanceof Stub ? object.rr_object.path : object.path;
}

/** The root object of a session that was connected. */
export function rootOf({ session, rootType }: Connected): RemoteObject {
  const root = new RemoteObject(session, session.service, session.definitions.object(rootType));
  session.sinks.set(session.service, root);
  return root;
}

/** An object as a class of generated code. Throws ServiceError when it is of another type. */
export function stubOf<T extends Stub>(found: RemoteObject | Stub, stub: StubClass<T>): T {
  const object = found instanceof Stub ? found.rr_object : found;
  if (!object.session.definitions.isKindOf(object.type.name, stub.rr_type)) {
    throw makeError(ErrorCode.ServiceError, `${object.path} is a ${object.type.name}, which is no ${stub.rr_type}`);
  }
  return new stub(object);
}
