// SPDX-License-Identifier: Apache-2.0
// One side of a connected wire, in a client or in a service (07, section 13).
import { AsyncQueue } from "../async_queue.js";
import type { MessageElement } from "../codec/message.js";
import type { Member } from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import { Listeners, type Unsubscribe } from "../listeners.js";
import { findElement } from "../value/shapes.js";
import { compareTimes, type TimeSpec } from "../value/values.js";
import { timeElement, timeOf, WireClock } from "../wire_time.js";

/** What a side needs of the session it is in. */
export interface WireTransport {
  pack(value: unknown): MessageElement;
  unpack(element: MessageElement): unknown;
  /** Sends when there is room; only the newest counts. */
  send(make: () => MessageElement[]): void;
  close(): Promise<void>;
  report(error: unknown): void;
  readonly canSend: boolean;
  readonly canReceive: boolean;
}

/** A value with its time, which is the sender's. */
export interface TimedValue<T> {
  /** As it was sent. */
  readonly value: T;
  /** When it was sent, by the sender's clock. */
  readonly time: TimeSpec;
}

/** Keeps the newest value, and forgets it after its lifespan. */
export class NewestValue<T> {
  private newest: (TimedValue<T> & { at: number }) | undefined;
  /** Milliseconds; undefined for values that do not expire. */
  lifespan: number | undefined;

  set(value: T, time: TimeSpec): void {
    this.newest = { value, time, at: performance.now() };
  }

  get time(): TimeSpec | undefined {
    return this.newest?.time;
  }

  get(): TimedValue<T> | undefined {
    const { newest, lifespan } = this;
    if (newest && lifespan !== undefined && performance.now() - newest.at > lifespan) return undefined;
    return newest;
  }
}

/** Values of which only the newest counts, both ways. */
export class WireEnd<T = unknown> implements AsyncIterable<TimedValue<T>> {
  private readonly clock = new WireClock();
  private readonly incoming = new NewestValue<T>();
  private readonly outgoing = new NewestValue<T>();
  private readonly valueListeners: Listeners<[T, TimeSpec]>;
  private readonly closedListeners: Listeners<[]>;
  private readonly readers = new Set<AsyncQueue<TimedValue<T>>>();
  private isOpen = true;

  /** Made by connecting, or by a client's connecting. */
  constructor(
    /** The wire in its definition. */
    readonly member: Member,
    private readonly transport: WireTransport,
  ) {
    const report = (error: unknown): void => {
      transport.report(error);
    };
    this.valueListeners = new Listeners(report);
    this.closedListeners = new Listeners(report);
  }

  /** Whether it was closed, by either side, or lost. */
  get isClosed(): boolean {
    return !this.isOpen;
  }

  /** The newest value that came. Throws ValueNotSet when there is none, or it has expired. */
  get value(): T {
    return this.timed.value;
  }

  /** The newest value that came, with its time. Throws as {@link value} does. */
  get timed(): TimedValue<T> {
    const newest = this.incoming.get();
    if (!newest) throw makeError(ErrorCode.ValueNotSet, `${this.member.name} has no value`);
    return newest;
  }

  /** Undefined where {@link value} throws. */
  tryGet(): TimedValue<T> | undefined {
    return this.incoming.get();
  }

  /** The value that was sent last. Throws ValueNotSet. */
  get sentValue(): T {
    const newest = this.outgoing.get();
    if (!newest) throw makeError(ErrorCode.ValueNotSet, `${this.member.name} was not sent`);
    return newest.value;
  }

  /** Values that came longer ago than so many milliseconds have expired; undefined: never. */
  set lifespan(milliseconds: number | undefined) {
    this.incoming.lifespan = milliseconds;
  }

  /**
   * Sends a value. While the connection is busy, a newer one takes the place of one that waits. Throws
   * InvalidOperation when the wire is closed, ReadOnlyMember or WriteOnlyMember for a wire of the other
   * direction.
   */
  send(value: T): void {
    if (!this.isOpen) throw makeError(ErrorCode.InvalidOperation, "the wire is closed");
    if (!this.transport.canSend) {
      throw makeError(this.member.isReadonly ? ErrorCode.ReadOnlyMember : ErrorCode.WriteOnlyMember, `${this.member.name} does not go this way`);
    }
    const time = this.clock.now();
    const packet = this.transport.pack(value);
    this.outgoing.set(value, time);
    this.transport.send(() => [timeElement(time), packet]);
  }

  /** The next value that comes, or the newest one if there is one. */
  async wait(signal?: AbortSignal): Promise<TimedValue<T>> {
    const now = this.incoming.get();
    if (now) return now;
    const queue = new AsyncQueue<TimedValue<T>>(1);
    this.readers.add(queue);
    try {
      const next = this.isOpen ? await queue.next(signal) : undefined;
      if (!next) throw makeError(ErrorCode.InvalidOperation, "the wire is closed");
      return next;
    } finally {
      this.readers.delete(queue);
    }
  }

  /** Values as they come, until the wire is closed. Who is slow misses values, but never the newest. */
  async *[Symbol.asyncIterator](): AsyncGenerator<TimedValue<T>, void, undefined> {
    const queue = new AsyncQueue<TimedValue<T>>(1);
    if (!this.isOpen) return;
    this.readers.add(queue);
    try {
      for await (const next of queue.iterate()) yield next;
    } finally {
      this.readers.delete(queue);
    }
  }

  /** Calls the handler with values that come. */
  onValue(handler: (value: T, time: TimeSpec) => void): Unsubscribe {
    return this.valueListeners.add(handler);
  }

  /** Calls the handler once the wire is closed, by whichever side. */
  onClosed(handler: () => void): Unsubscribe {
    return this.closedListeners.add(handler);
  }

  /** Closes the wire and tells the other side. Harmless when it is closed. */
  async close(): Promise<void> {
    if (!this.isOpen) return;
    this.ended();
    await this.transport.close();
  }

  /** @internal The other side, or the session, has ended it. */
  ended(): void {
    if (!this.isOpen) return;
    this.isOpen = false;
    for (const reader of this.readers) reader.end();
    this.closedListeners.call();
  }

  /** @internal Takes a packet. One of a wrong form or type, or not newer than the last, is dropped. */
  take(elements: readonly MessageElement[]): boolean {
    if (!this.isOpen || !this.transport.canReceive) return false;
    let value: T;
    let time: TimeSpec;
    try {
      time = timeOf(elements);
      value = this.transport.unpack(findElement(elements, "packet")) as T;
    } catch {
      return false;
    }
    const last = this.incoming.time;
    if (last && compareTimes(time, last) <= 0) return false;
    this.incoming.set(value, time);
    const timed = { value, time };
    for (const reader of this.readers) {
      reader.take();
      reader.put(timed);
    }
    this.valueListeners.call(value, time);
    return true;
  }
}
