// SPDX-License-Identifier: Apache-2.0
// An object that a service offers: what it does is told by handlers, by the names of members.
import type { Definitions } from "../definition/definitions.js";
import type { Member, MemberKind, ObjectType } from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import { Packer } from "../value/pack.js";
import { Unpacker } from "../value/unpack.js";
import { ServedCallback, ServedEvent } from "./served_calls.js";
import { ServedMemory } from "./served_memory.js";
import { ServedPipe } from "./served_pipe.js";
import { ServedWire } from "./served_wire.js";
import type { Service } from "./service.js";

/** Whose request it is. */
export interface Caller {
  /** Number of the client's session; for callbacks. */
  readonly client: number;
  /** Empty when nobody has logged in. */
  readonly username: string;
}

/** What a generator function gives: one step after the other, as an async generator does. */
export interface GeneratorSource<R = unknown, P = unknown> {
  /** One step; `done` at the end. What it throws is sent, and ends the generator. */
  next(parameter: P): IteratorResult<R, unknown> | Promise<IteratorResult<R, unknown>>;
  /** The client wants no more. */
  return?(value?: unknown): unknown;
  /** The client wants it to stop what it does: the error is AbortOperation. */
  throw?(error: unknown): unknown;
}

/** A lock of an object that clients take in turns. */
export interface Monitor {
  /** False when it could not be had within so many milliseconds. */
  enter(timeout: number): Promise<boolean>;
  /** Gives it back. */
  exit(): void;
}

/** What an object does. Results may be promises. Members without a handler raise NotImplementedError. */
export interface ObjectHandlers {
  /** Gives the value of a property. */
  get?(property: string, caller: Caller): unknown;
  /** Takes the value of a property. */
  set?(property: string, value: unknown, caller: Caller): unknown;
  /** Does what a function does, and gives its result. */
  call?(name: string, args: readonly unknown[], caller: Caller): unknown;
  /** Gives the generator of a generator function. */
  generate?(name: string, args: readonly unknown[], caller: Caller): GeneratorSource | Promise<GeneratorSource>;
  /** Null for no object. `index` is undefined for an objref without one. */
  object?(objref: string, index: number | string | undefined): ServedObject | null | Promise<ServedObject | null>;
  /** Objects that can be monitor-locked have one. */
  monitor?: Monitor;
  /** The service has reached the object, and offers it at this path. */
  attached?(service: Service, path: string): void;
  /** The service has released it. */
  detached?(): void;
}

/** An object of one type. It may be offered at several paths. */
export class ServedObject {
  /** What the definition says of it. */
  readonly type: ObjectType;
  /** @internal */
  readonly packer: Packer;
  /** @internal */
  readonly unpacker: Unpacker;
  /** @internal Where it is offered. */
  readonly places = new Map<string, Service>();
  private readonly events = new Map<string, ServedEvent>();
  private readonly callbacks = new Map<string, ServedCallback>();
  private readonly pipes = new Map<string, ServedPipe>();
  private readonly wires = new Map<string, ServedWire>();
  private readonly memories = new Map<string, ServedMemory>();

  constructor(
    /** The definitions that it was made with. */
    readonly definitions: Definitions,
    type: string,
    /** What it does. */
    readonly handlers: ObjectHandlers,
  ) {
    this.type = definitions.object(type);
    this.packer = new Packer(definitions);
    this.unpacker = new Unpacker(definitions);
  }

  /** Throws MemberNotFound. */
  member(name: string, kind: MemberKind): Member {
    const member = this.type.members.get(name);
    if (member?.kind !== kind) throw makeError(ErrorCode.MemberNotFound, "Member not found");
    return member;
  }

  /** An event of the object. Throws MemberNotFound. */
  event(name: string): ServedEvent {
    return kept(this.events, name, () => new ServedEvent(this, this.member(name, "event")));
  }

  /** A callback of the object. Throws MemberNotFound. */
  callback(name: string): ServedCallback {
    return kept(this.callbacks, name, () => new ServedCallback(this, this.member(name, "callback")));
  }

  /** A pipe of the object. Throws MemberNotFound. */
  pipe(name: string): ServedPipe {
    return kept(this.pipes, name, () => new ServedPipe(this, this.member(name, "pipe")));
  }

  /** A wire of the object. Throws MemberNotFound. */
  wire(name: string): ServedWire {
    return kept(this.wires, name, () => new ServedWire(this, this.member(name, "wire")));
  }

  /** A memory of the object. Throws MemberNotFound. */
  memory(name: string): ServedMemory {
    return kept(this.memories, name, () => new ServedMemory(this, this.member(name, "memory")));
  }

  /** @internal A client has gone: what it had connected is closed. */
  clientLeft(client: number): void {
    for (const pipe of this.pipes.values()) pipe.clientLeft(client);
    for (const wire of this.wires.values()) wire.clientLeft(client);
  }

  /** @internal It is offered at this path no more. */
  detach(path: string): void {
    this.places.delete(path);
    for (const pipe of this.pipes.values()) pipe.pathLeft(path);
    for (const wire of this.wires.values()) wire.pathLeft(path);
    if (this.places.size === 0) this.handlers.detached?.();
  }
}

function kept<T>(map: Map<string, T>, name: string, make: () => T): T {
  let known = map.get(name);
  if (known === undefined) {
    known = make();
    map.set(name, known);
  }
  return known;
}
