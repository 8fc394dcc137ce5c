// SPDX-License-Identifier: Apache-2.0
import type { MessageElement, MessageEntry } from "../codec/message.js";
import type { Member } from "../definition/types.js";
import { EntryType, unreliableMark } from "../entry_type.js";
import { ErrorCode, makeError } from "../errors.js";
import { Listeners, type Unsubscribe } from "../listeners.js";
import { NewestValue, WireEnd, type TimedValue } from "../streams/wire_end.js";
import { findElement } from "../value/shapes.js";
import { timeElement, timeOf, WireClock } from "../wire_time.js";
import type { ServedObject } from "./served_object.js";
import type { ServerSession } from "./server_session.js";

interface Held<T> {
  end: WireEnd<T>;
  client: number;
  path: string;
}

/** A wire of an object: its value for all clients, and the newest that any of them has sent. */
export class ServedWire<T = unknown> {
  private readonly held = new Set<Held<T>>();
  private readonly clock = new WireClock();
  private readonly connected: Listeners<[WireEnd<T>, number]>;
  private readonly valueListeners: Listeners<[T, number]>;
  private current: { value: T } | undefined;
  private readonly received = new NewestValue<T>();
  /** Instead of the value that was sent last, for clients that peek. */
  peekIn: (() => T | Promise<T>) | undefined;
  /** Instead of the newest that came. */
  peekOut: (() => T | Promise<T>) | undefined;

  /** @internal */
  constructor(
    private readonly object: ServedObject,
    private readonly member: Member,
  ) {
    const drop = (): void => undefined;
    this.connected = new Listeners(drop);
    this.valueListeners = new Listeners(drop);
  }

  /** Calls the handler with each end that a client connects, and the client's number. */
  onConnect(handler: (end: WireEnd<T>, client: number) => void): Unsubscribe {
    return this.connected.add(handler);
  }

  /** Calls the handler with values that clients send, or poke. */
  onValue(handler: (value: T, client: number) => void): Unsubscribe {
    return this.valueListeners.add(handler);
  }

  /** The ends of all clients that have connected. */
  get ends(): WireEnd<T>[] {
    return [...this.held].map(({ end }) => end);
  }

  /** Sends a value to all clients that have connected; those that connect later get it at once. */
  send(value: T): void {
    // One that does not fit is refused before anybody gets it.
    this.object.packer.value(this.member.type, value, "packet");
    this.current = { value };
    for (const { end } of [...this.held]) {
      try {
        end.send(value);
      } catch {
        // The session is over, or the value too large for it.
      }
    }
  }

  /** The newest value that any client has sent; undefined for none, or an expired one. */
  tryGet(): TimedValue<T> | undefined {
    return this.received.get();
  }

  /** Values of clients expire after so many milliseconds. */
  set lifespan(milliseconds: number | undefined) {
    this.received.lifespan = milliseconds;
  }

  /** @internal Answers WireConnect. A second one changes nothing, but is told again. */
  connect(session: ServerSession, entry: MessageEntry): void {
    let held = this.find(session.endpoint, entry.path);
    if (!held) {
      held = { end: this.makeEnd(session, entry.path), client: session.endpoint, path: entry.path };
      this.held.add(held);
      if (this.current && !this.member.isWriteonly) held.end.send(this.current.value);
    }
    this.connected.call(held.end, session.endpoint);
  }

  private makeEnd(session: ServerSession, path: string): WireEnd<T> {
    const { object, member } = this;
    const end = new WireEnd<T>(member, {
      pack: (value) => object.packer.value(member.type, value, "packet"),
      unpack: (element) => object.unpacker.value(member.type, element),
      send: (make) => {
        session.sendNewest(`${path}\n${member.name}`, () => {
          session.packet({ type: EntryType.wirePacket, path, member: member.name, elements: make(), metadata: unreliableMark }, true);
        });
      },
      close: async () => {
        for (const one of this.held) if (one.end === end) this.held.delete(one);
        if (session.isOpen) session.packet({ type: EntryType.wireClosed, path, member: member.name, elements: [] }, true);
        await Promise.resolve();
      },
      report: (error) => {
        session.report(error);
      },
      canSend: !member.isWriteonly,
      canReceive: !member.isReadonly,
    });
    return end;
  }

  private find(client: number, path: string): Held<T> | undefined {
    for (const one of this.held) if (one.client === client && one.path === path) return one;
    return undefined;
  }

  /** @internal */
  disconnect(session: ServerSession, entry: MessageEntry): void {
    const held = this.find(session.endpoint, entry.path);
    if (!held) throw makeError(ErrorCode.ServiceError, "Invalid wire connection");
    this.held.delete(held);
    held.end.ended();
  }

  /** @internal */
  take(session: ServerSession, entry: MessageEntry): void {
    const held = this.find(session.endpoint, entry.path);
    if (!held?.end.take(entry.elements)) return;
    const { value, time } = held.end.timed;
    this.came(value, time, session.endpoint);
  }

  private came(value: T, time: TimedValue<T>["time"], client: number): void {
    this.received.set(value, time);
    this.valueListeners.call(value, client);
  }

  /** @internal */
  async answerPeekIn(): Promise<MessageElement[]> {
    if (this.member.isWriteonly) throw makeError(ErrorCode.WriteOnlyMember, "Write only member");
    const { current } = this;
    if (!this.peekIn && !current) throw makeError(ErrorCode.ValueNotSet, "Value not set");
    return this.timed(this.peekIn ? await this.peekIn() : (current?.value as T));
  }

  /** @internal */
  async answerPeekOut(): Promise<MessageElement[]> {
    if (this.member.isReadonly) throw makeError(ErrorCode.ReadOnlyMember, "Read only member");
    const newest = this.received.get();
    if (!this.peekOut && !newest) throw makeError(ErrorCode.ValueNotSet, "Value not set");
    return this.timed(this.peekOut ? await this.peekOut() : (newest?.value as T));
  }

  private timed(value: T): MessageElement[] {
    return [timeElement(this.clock.now()), this.object.packer.value(this.member.type, value, "packet")];
  }

  /** @internal */
  poke(session: ServerSession, entry: MessageEntry): void {
    if (this.member.isReadonly) throw makeError(ErrorCode.ReadOnlyMember, "Read only member");
    const time = timeOf(entry.elements);
    this.came(this.object.unpacker.value(this.member.type, findElement(entry.elements, "packet")) as T, time, session.endpoint);
  }

  /** @internal */
  clientLeft(client: number): void {
    this.endSome((one) => one.client === client);
  }

  /** @internal */
  pathLeft(path: string): void {
    this.endSome((one) => one.path === path);
  }

  private endSome(isOver: (one: Held<T>) => boolean): void {
    for (const one of [...this.held]) {
      if (!isOver(one)) continue;
      this.held.delete(one);
      one.end.ended();
    }
  }
}
