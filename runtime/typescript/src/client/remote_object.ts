// SPDX-License-Identifier: Apache-2.0
// An object of a service, used by the names of its members.
import { AsyncQueue, overflow } from "../async_queue.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import type { Member, MemberKind, ObjectType } from "../definition/types.js";
import { EntryType } from "../entry_type.js";
import { ErrorCode, makeError } from "../errors.js";
import { Listeners, type Unsubscribe } from "../listeners.js";
import { childPath } from "../path.js";
import { numberElement, Packer } from "../value/pack.js";
import { readNumber } from "../value/numbers.js";
import { checkType, findElement } from "../value/shapes.js";
import { Unpacker } from "../value/unpack.js";
import { ElementType } from "../codec/element_type.js";
import { findObjectType } from "./connect.js";
import { RemoteGenerator } from "./generator.js";
import { ArrayMemory, MultiDimMemory } from "./memory.js";
import { Pipe } from "./pipe.js";
import type { CallOptions, ClientSession, EntrySink } from "./session.js";
import { Wire } from "./wire.js";

/** What answers a callback. */
export type CallbackFunction = (...args: unknown[]) => unknown;

/** Something that a service fires events of. */
export interface EventSource<A extends unknown[]> {
  /** Calls the handler with the parameters of each event. */
  on(handler: (...args: A) => void): Unsubscribe;
  /** Parameters of events from now on; ends with the session. */
  [Symbol.asyncIterator](): AsyncGenerator<A, void, undefined>;
}

/** A function of the client that the service calls. */
export interface Callback<F> {
  /** Null for none: the service gets InvalidOperation. */
  set(answer: F | null): void;
}

/** An object of a connected service. Values are what its definition says; see the table in the README. */
export class RemoteObject implements EntrySink {
  /** @internal */
  readonly packer: Packer;
  /** @internal */
  readonly unpacker: Unpacker;
  private readonly eventListeners = new Map<string, Listeners<unknown[]>>();
  private readonly eventQueues = new Map<string, Set<AsyncQueue<unknown[]>>>();
  private readonly callbacks = new Map<string, CallbackFunction>();
  private readonly pipes = new Map<string, Pipe>();
  private readonly wires = new Map<string, Wire>();
  private isGone = false;

  /** Made by connecting, and by {@link object}. */
  constructor(
    /** The session that it belongs to. */
    readonly session: ClientSession,
    /** Where it is in its service: `arm.tools[left]`. */
    readonly path: string,
    /** What the definition says of it. */
    readonly type: ObjectType,
  ) {
    this.packer = new Packer(session.definitions);
    this.unpacker = new Unpacker(session.definitions);
  }

  /** Throws MemberNotFound, or InvalidOperation for a member of another kind. */
  member(name: string, kind?: MemberKind): Member {
    const member = this.type.members.get(name);
    if (!member || (kind && member.kind !== kind)) {
      throw makeError(ErrorCode.MemberNotFound, `${this.type.name} has no ${kind ?? "member"} ${name.slice(0, 80)}`);
    }
    return member;
  }

  /** The value of a property. */
  async get(property: string, options: CallOptions = {}): Promise<unknown> {
    const member = this.member(property, "property");
    const answer = await this.session.request({ type: EntryType.propertyGet, path: this.path, member: property, ...options });
    return this.unpacker.value(member.type, findElement(answer.elements, "value"));
  }

  /** Sets a property; the value is converted to the declared type. */
  async set(property: string, value: unknown, options: CallOptions = {}): Promise<void> {
    const member = this.member(property, "property");
    const elements = [this.packer.value(member.type, value, "value")];
    await this.session.request({ type: EntryType.propertySet, path: this.path, member: property, elements, ...options });
  }

  /** Calls a function; of one that generates use {@link generate}. */
  async call(name: string, args: readonly unknown[] = [], options: CallOptions = {}): Promise<unknown> {
    const member = this.member(name, "function");
    if (member.generator) throw makeError(ErrorCode.InvalidOperation, `${name} is a generator`);
    const answer = await this.session.request({ type: EntryType.functionCall, path: this.path, member: name, elements: this.arguments(member, args), ...options });
    return member.type.base.kind === "void" ? undefined : this.unpacker.value(member.type, findElement(answer.elements, "return"));
  }

  /** Calls a function that generates, or takes values step by step. */
  async generate(name: string, args: readonly unknown[] = [], options: CallOptions = {}): Promise<RemoteGenerator> {
    const member = this.member(name, "function");
    if (!member.generator) throw makeError(ErrorCode.InvalidOperation, `${name} is no generator`);
    const answer = await this.session.request({ type: EntryType.functionCall, path: this.path, member: name, elements: this.arguments(member, args), ...options });
    return new RemoteGenerator(this, member, indexIn(answer));
  }

  private arguments(member: Member, args: readonly unknown[]): MessageElement[] {
    if (args.length !== member.parameters.length) {
      throw makeError(ErrorCode.InvalidArgument, `${member.name} has ${member.parameters.length} parameters, not ${args.length}`);
    }
    return member.parameters.map((parameter, i) => this.packer.value(parameter.type, args[i], parameter.name));
  }

  /** The object that an objref gives. The same path is the same object while the service has it. */
  async object(objref: string, index?: number | string, wanted?: string): Promise<RemoteObject> {
    const member = this.member(objref, "objref");
    const isRight = member.index === "none" ? index === undefined : typeof index === (member.index === "int32" ? "number" : "string");
    if (!isRight) throw makeError(ErrorCode.InvalidArgument, `${objref} has ${member.index === "none" ? "no" : `a ${member.index}`} index`);
    const path = childPath(this.path, objref, index);
    const known = this.session.sinks.get(path);
    const object = known instanceof RemoteObject ? known : await this.find(path);
    const declared = wanted ?? member.objectType;
    if (declared !== "" && !this.session.definitions.isKindOf(object.type.name, declared)) {
      throw makeError(ErrorCode.ServiceError, `${path} is a ${object.type.name}, which is no ${declared}`);
    }
    return object;
  }

  private async find(path: string): Promise<RemoteObject> {
    const { session } = this;
    const type = await findObjectType(session, path);
    const made = session.sinks.get(path);
    if (made instanceof RemoteObject) return made;
    if (session.sinks.size >= session.settings.limits.objects) {
      throw makeError(ErrorCode.OutOfSystemResource, "the client has references to too many objects");
    }
    const object = new RemoteObject(session, path, session.definitions.object(type));
    session.sinks.set(path, object);
    return object;
  }

  /** An event of the object. Nothing is sent. Throws MemberNotFound. */
  event(name: string): EventSource<unknown[]> {
    this.member(name, "event");
    return {
      on: (handler) => this.listeners(name).add(handler),
      [Symbol.asyncIterator]: () => this.eventsOf(name),
    };
  }

  private listeners(name: string): Listeners<unknown[]> {
    let known = this.eventListeners.get(name);
    if (!known) {
      known = new Listeners((error) => {
        this.session.report(error);
      });
      this.eventListeners.set(name, known);
    }
    return known;
  }

  private eventsOf(name: string): AsyncGenerator<unknown[], void, undefined> {
    const queue = new AsyncQueue<unknown[]>(this.session.settings.limits.packetQueue);
    if (this.isGone || !this.session.isOpen) queue.end();
    const queues = this.eventQueues.get(name) ?? new Set();
    this.eventQueues.set(name, queues);
    queues.add(queue);
    return queue.iterate(undefined, () => {
      queues.delete(queue);
    });
  }

  /** A callback of the object. Nothing is sent. Throws MemberNotFound. */
  callback(name: string): Callback<CallbackFunction> {
    this.member(name, "callback");
    return {
      set: (answer) => {
        if (answer) this.callbacks.set(name, answer);
        else this.callbacks.delete(name);
      },
    };
  }

  /** A pipe of the object. Nothing is sent. Throws MemberNotFound. */
  pipe(name: string): Pipe {
    const member = this.member(name, "pipe");
    let pipe = this.pipes.get(name);
    if (!pipe) this.pipes.set(name, (pipe = new Pipe(this, member)));
    return pipe;
  }

  /** A wire of the object. Nothing is sent. Throws MemberNotFound. */
  wire(name: string): Wire {
    const member = this.member(name, "wire");
    let wire = this.wires.get(name);
    if (!wire) this.wires.set(name, (wire = new Wire(this, member)));
    return wire;
  }

  /** A memory of the object. Nothing is sent. Throws MemberNotFound. */
  memory(name: string): ArrayMemory | MultiDimMemory {
    const member = this.member(name, "memory");
    return member.type.array.kind === "dims" ? new MultiDimMemory(this, member) : new ArrayMemory(this, member);
  }

  /** Takes an entry for the object; called by the session. */
  take(entry: MessageEntry): void {
    const { type, member } = entry;
    if (type === EntryType.event) this.fire(entry);
    else if (type === EntryType.callbackCall) this.answer(entry);
    else if (entry.error !== 0) return;
    else if (type === EntryType.wirePacket || type === EntryType.wireClosed) this.wires.get(member)?.take(entry);
    else this.pipes.get(member)?.take(entry);
  }

  private fire(entry: MessageEntry): void {
    const member = this.type.members.get(entry.member);
    const listeners = this.eventListeners.get(entry.member);
    const queues = this.eventQueues.get(entry.member);
    if (member?.kind !== "event" || (listeners?.isEmpty !== false && !queues?.size)) return;
    let args: unknown[];
    try {
      args = this.parameters(member, entry);
    } catch (error) {
      this.session.settings.log("warning", `the event ${entry.member} has wrong parameters: ${String(error)}`);
      return;
    }
    for (const queue of queues ?? []) {
      if (!queue.put(args)) queue.end(overflow(`the event ${entry.member}`));
    }
    listeners?.call(...args);
  }

  private parameters(member: Member, entry: MessageEntry): unknown[] {
    return member.parameters.map(({ name, type }) => this.unpacker.value(type, findElement(entry.elements, name)));
  }

  private answer(entry: MessageEntry): void {
    this.session.answerCallback(entry, this.callBack(entry));
  }

  private async callBack(entry: MessageEntry): Promise<MessageElement> {
    const member = this.member(entry.member, "callback");
    const answer = this.callbacks.get(entry.member);
    if (!answer) throw makeError(ErrorCode.InvalidOperation, "Callback function not set");
    const result = await answer(...this.parameters(member, entry));
    return member.type.base.kind === "void" ? numberElement("return", "int32", 0) : this.packer.value(member.type, result, "return");
  }

  /** The service has released the object, or the session is over; called by the session. */
  ended(): void {
    this.isGone = true;
    for (const pipe of this.pipes.values()) pipe.ended();
    for (const wire of this.wires.values()) wire.ended();
    for (const queues of this.eventQueues.values()) for (const queue of queues) queue.end();
  }
}

/** The index of a generator or pipe end in an answer. */
export function indexIn(answer: MessageEntry): number {
  const element = findElement(answer.elements, "index");
  checkType(element, ElementType.int32, "index");
  if (element.count === 0 || !element.data) throw makeError(ErrorCode.OutOfRange, "an index has no number");
  return readNumber("int32", element.data) as number;
}
