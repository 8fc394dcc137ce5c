// SPDX-License-Identifier: Apache-2.0
// A service: a root object with what is below it, and the clients that use it.
import type { MessageElement } from "../codec/message.js";
import { makeType, stringType, type Member } from "../definition/types.js";
import { EntryType } from "../entry_type.js";
import { ErrorCode, makeError } from "../errors.js";
import { Listeners, type Unsubscribe } from "../listeners.js";
import type { NodeSettings } from "../options.js";
import { childPath, isAtOrBelow, parsePath, type PathSegment } from "../path.js";
import { Packer, textElement } from "../value/pack.js";
import { VarValue } from "../value/values.js";
import { Monitors, ObjectLocks } from "./locks.js";
import type { ServerSession } from "./server_session.js";
import { ServedObject } from "./served_object.js";
import type { Users } from "./users.js";

/** How to offer a service. */
export interface ServiceOptions {
  /** Numbers, arrays and texts, or VarValues of such, that clients and discovery see. */
  attributes?: Readonly<Record<string, unknown>>;
  /** Who may log in. */
  users?: Users;
  /** Nothing can be used without logging in. */
  requireUser?: boolean;
}

const stringMap = makeType({ kind: "any" }, { kind: "scalar" }, "string");
const stringList = makeType(stringType.base, stringType.array, "list");

/** A service that a node offers, until it is closed or the node is. */
export class Service {
  /** What clients are told about the service. */
  readonly attributes: ReadonlyMap<string, unknown>;
  /** Who may log in; undefined: nobody can, and nobody has to. */
  readonly users: Users | undefined;
  /** Nothing can be used without logging in. */
  readonly requiresUser: boolean;
  /** @internal */
  readonly locks = new ObjectLocks();
  /** @internal */
  readonly monitors = new Monitors();
  private readonly clients = new Map<number, ServerSession>();
  private readonly objects = new Map<string, Promise<ServedObject>>();
  private readonly connectedListeners: Listeners<[number]>;
  private readonly leftListeners: Listeners<[number]>;
  private isOpen = true;

  /** @internal Made by registering. */
  constructor(
    /** As it was registered. */
    readonly name: string,
    /** The object that clients get first. */
    readonly root: ServedObject,
    options: ServiceOptions,
    private readonly settings: NodeSettings,
    private readonly unregister: () => void,
  ) {
    const report = (error: unknown): void => {
      settings.log("error", `a handler failed: ${String(error)}`);
    };
    this.connectedListeners = new Listeners(report);
    this.leftListeners = new Listeners(report);
    this.attributes = new Map(Object.entries(options.attributes ?? {}));
    for (const [key, value] of this.attributes) {
      if (value instanceof VarValue && /[{.]/.test(value.type)) throw makeError(ErrorCode.InvalidArgument, `the attribute ${key} is no number, array or text`);
    }
    this.users = options.users;
    this.requiresUser = options.requireUser === true;
    this.objects.set(name, Promise.resolve(root));
    this.attach(name, root);
  }

  /** Calls the handler with the number of each client that connects. */
  onClientConnected(handler: (client: number) => void): Unsubscribe {
    return this.connectedListeners.add(handler);
  }

  /** Calls the handler with the number of each client that has left. */
  onClientDisconnected(handler: (client: number) => void): Unsubscribe {
    return this.leftListeners.add(handler);
  }

  /** Tells all clients, ends their sessions, and offers the service no more. */
  close(): void {
    if (!this.isOpen) return;
    this.isOpen = false;
    this.unregister();
    for (const session of [...this.clients.values()]) {
      if (session.isAuthenticated) session.packet({ type: EntryType.serviceClosed, path: "", member: "", elements: [] });
      session.end("the service was closed");
    }
    this.releaseBelow(this.name);
  }

  /** Releases the object at a path below the root, and all below it: clients that hold it are told. */
  release(path: string): void {
    if (path === this.name || !isAtOrBelow(path, this.name)) throw makeError(ErrorCode.InvalidArgument, `${path} is no object below the root`);
    const canonical = pathOf(parsePath(path));
    if (!this.objects.has(canonical)) throw makeError(ErrorCode.ServiceError, "Unknown service path");
    for (const session of this.clients.values()) {
      if (session.isAuthenticated) session.packet({ type: EntryType.servicePathReleased, path, member: "", elements: [] });
      session.generators.clear((one) => isAtOrBelow(one, canonical));
    }
    this.locks.objectLeft(canonical);
    this.releaseBelow(canonical);
  }

  private releaseBelow(path: string): void {
    for (const [one, object] of [...this.objects]) {
      if (!isAtOrBelow(one, path)) continue;
      this.objects.delete(one);
      void object.then((found) => {
        found.detach(one);
      }, () => undefined);
    }
  }

  private attach(path: string, object: ServedObject): void {
    object.places.set(path, this);
    object.handlers.attached?.(this, path);
  }

  /** @internal The object at a path, with the path as it is spelled canonically. */
  async find(path: string): Promise<{ object: ServedObject; path: string }> {
    const segments = parsePath(path);
    const [first, ...rest] = segments;
    if (first?.name !== this.name || first.index !== undefined) {
      throw makeError(ErrorCode.ObjectNotFound, "the path is of another service");
    }
    let at = this.name;
    let object = this.root;
    for (const segment of rest) {
      const next = canonical(at, segment);
      object = await this.child(object, segment, next);
      at = next;
    }
    return { object, path: at };
  }

  private child(parent: ServedObject, { name, index }: PathSegment, path: string): Promise<ServedObject> {
    const known = this.objects.get(path);
    if (known) return known;
    const member = parent.member(name, "objref");
    if (this.objects.size >= this.settings.limits.objects) throw makeError(ErrorCode.OutOfSystemResource, "the service has too many objects");
    const made = this.make(parent, member, indexOf(member, index), path);
    this.objects.set(path, made);
    made.catch(() => {
      this.objects.delete(path);
    });
    return made;
  }

  private async make(parent: ServedObject, member: Member, index: number | string | undefined, path: string): Promise<ServedObject> {
    const { handlers } = parent;
    if (!handlers.object) throw makeError(ErrorCode.NotImplementedError, `${member.name} is not implemented`);
    const object = await handlers.object(member.name, index);
    if (!object) throw makeError(ErrorCode.ServiceError, `there is no object ${path}`);
    if (member.objectType !== "" && !parent.definitions.isKindOf(object.type.name, member.objectType)) {
      throw makeError(ErrorCode.InternalError, `${object.type.name} is no ${member.objectType}`);
    }
    if (!this.objects.has(path)) throw makeError(ErrorCode.ObjectNotFound, `${path} was released`);
    this.attach(path, object);
    return object;
  }

  /** @internal */
  sessions(): IterableIterator<ServerSession> {
    return this.clients.values();
  }

  /** @internal */
  session(client: number): ServerSession | undefined {
    return this.clients.get(client);
  }

  /** @internal */
  join(session: ServerSession): void {
    this.clients.set(session.endpoint, session);
    this.connectedListeners.call(session.endpoint);
  }

  /** @internal */
  leave(session: ServerSession): void {
    if (!this.clients.delete(session.endpoint)) return;
    const names = new Set([...this.clients.values()].flatMap((one) => [...one.usernames]));
    this.locks.clientLeft(session.endpoint, (name) => session.usernames.has(name) && !names.has(name));
    this.monitors.clientLeft(session.endpoint);
    for (const object of this.objects.values()) {
      void object.then((found) => {
        found.clientLeft(session.endpoint);
      }, () => undefined);
    }
    this.leftListeners.call(session.endpoint);
  }

  /** @internal */
  attributesElement(name: string): MessageElement {
    return new Packer(this.root.definitions).value(stringMap, this.attributes, name);
  }

  /** @internal Texts of the root's definition and all it imports, sorted by their names. */
  definitionsElement(): MessageElement {
    const { definitions, type } = this.root;
    const texts = definitions.withImports(type.name.slice(0, type.name.lastIndexOf("."))).map(({ text }) => text);
    return new Packer(definitions).value(stringList, texts, "servicedefs");
  }

  /** @internal `objecttype`, and `objectimplements` if there are any, for a client of a version. */
  typeElements(object: ServedObject, version: readonly number[] | undefined, withImplements: boolean): MessageElement[] {
    const elements = [textElement("objecttype", typeFor(object, version))];
    const { type, definitions } = object;
    if (withImplements && type.implements.length > 0) {
      const own = `${type.name.slice(0, type.name.lastIndexOf("."))}.`;
      const names = type.implements.map((name) => (name.startsWith(own) && !name.slice(own.length).includes(".") ? name.slice(own.length) : name));
      elements.push(new Packer(definitions).value(stringList, names, "objectimplements"));
    }
    return elements;
  }
}

function canonical(parent: string, { name, index }: PathSegment): string {
  return childPath(parent, name, index);
}

function pathOf(segments: readonly PathSegment[]): string {
  const [first, ...rest] = segments;
  return rest.reduce(canonical, first?.name ?? "");
}

function indexOf(member: Member, index: string | undefined): number | string | undefined {
  if (member.index === "none") {
    if (index !== undefined) throw makeError(ErrorCode.ServiceError, `${member.name} has no index`);
    return undefined;
  }
  if (member.index === "string") return index ?? "";
  const number = index !== undefined && /^-?\d{1,10}$/.test(index) ? Number(index) : NaN;
  if (number !== (number | 0)) throw makeError(ErrorCode.InvalidArgument, `${member.name} has an int32 index`);
  return number;
}

function isOlder(version: readonly number[], than: readonly number[]): boolean {
  for (let i = 0; i < 4; ++i) {
    const difference = (version[i] ?? 0) - (than[i] ?? 0);
    if (difference !== 0) return difference < 0;
  }
  return false;
}

/** The type that a client of a version is told (07, section 4). Throws ObjectNotFound when it can use none. */
function typeFor({ type, definitions }: ServedObject, version: readonly number[] | undefined): string {
  if (!version) return type.name;
  const seen = new Set<string>();
  for (const name of [type.name, ...type.implements]) {
    const whole = name.includes(".") ? name : `${type.name.slice(0, type.name.lastIndexOf("."))}.${name}`;
    const service = whole.slice(0, whole.lastIndexOf("."));
    if (seen.has(service)) continue;
    seen.add(service);
    if (!isOlder(version, definitions.find(service)?.version ?? [])) return whole;
  }
  throw makeError(ErrorCode.ObjectNotFound, "the client is too old for all types of the object");
}
