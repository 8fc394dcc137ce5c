// SPDX-License-Identifier: Apache-2.0
// One end of a pipe, in a client or in a service (07, section 11).
import { AsyncQueue, overflow } from "../async_queue.js";
import { ElementType } from "../codec/element_type.js";
import type { MessageElement } from "../codec/message.js";
import type { Member } from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import { Listeners, type Unsubscribe } from "../listeners.js";
import { readNumber } from "../value/numbers.js";
import { numberElement } from "../value/pack.js";
import { findElement, optionalElement } from "../value/shapes.js";

/** Packets that came before the one that is next may wait so many. */
const outOfOrderLimit = 1024;

/** What an end needs of the session it is in. */
export interface PipeTransport {
  pack(value: unknown): MessageElement;
  unpack(element: MessageElement): unknown;
  send(element: MessageElement, isUnreliable: boolean): void;
  /** Tells the other side that the end is closed. */
  close(index: number): Promise<void>;
  report(error: unknown): void;
  readonly canSend: boolean;
  readonly canReceive: boolean;
  readonly queueLimit: number;
}

/** One of the two connected ends of a pipe. Packets come in the order in which they were sent. */
export class PipeEnd<T = unknown> implements AsyncIterable<T> {
  private readonly queue: AsyncQueue<{ value: T }>;
  private readonly held = new Map<number, MessageElement>();
  private sent = 0;
  private received = 0;
  private readonly packetListeners: Listeners<[T]>;
  private readonly ackListeners: Listeners<[number]>;
  private readonly closedListeners: Listeners<[]>;
  private isOpen = true;
  /** Asks the other side to acknowledge the packets that are sent from now on. */
  requestsAcknowledgements = false;

  /** Made by connecting, or by a client's connecting. */
  constructor(
    /** The pipe in its definition. */
    readonly member: Member,
    /** Its number among the ends of the pipe and client. */
    readonly index: number,
    /** Both sides have agreed that packets may be lost or overtake each other. */
    readonly isUnreliable: boolean,
    private readonly transport: PipeTransport,
  ) {
    const report = (error: unknown): void => {
      transport.report(error);
    };
    this.queue = new AsyncQueue(transport.queueLimit);
    this.packetListeners = new Listeners(report);
    this.ackListeners = new Listeners(report);
    this.closedListeners = new Listeners(report);
  }

  /** Whether it was closed, by either side, or lost. */
  get isClosed(): boolean {
    return !this.isOpen;
  }

  /** Packets that wait to be received. */
  get available(): number {
    return this.queue.length;
  }

  /**
   * Sends a packet, and gives its number. Throws InvalidOperation when the end is closed, ReadOnlyMember or
   * WriteOnlyMember for a pipe of the other direction.
   */
  send(value: T): number {
    if (!this.isOpen) throw makeError(ErrorCode.InvalidOperation, "the end of the pipe is closed");
    if (!this.transport.canSend) {
      throw makeError(this.member.isReadonly ? ErrorCode.ReadOnlyMember : ErrorCode.WriteOnlyMember, `${this.member.name} does not go this way`);
    }
    const number = (this.sent + 1) >>> 0;
    const elements = [numberElement("packetnumber", "uint32", number), this.transport.pack(value)];
    if (this.requestsAcknowledgements) elements.push(numberElement("requestack", "uint32", 1));
    this.transport.send(
      { name: String(this.index), type: ElementType.stringMap, typeName: "", count: elements.length, elements },
      this.isUnreliable,
    );
    this.sent = number;
    return number;
  }

  /** The next packet; undefined once the end is closed and all is read. */
  async receive(signal?: AbortSignal): Promise<T | undefined> {
    return (await this.queue.next(signal))?.value;
  }

  /** The next packet, if one waits. */
  tryReceive(): T | undefined {
    return this.queue.take()?.value;
  }

  /** Packets until the end is closed, by whichever side. */
  async *[Symbol.asyncIterator](): AsyncGenerator<T, void, undefined> {
    for await (const { value } of this.queue.iterate()) yield value;
  }

  /** Calls the handler with packets as they come, instead of keeping them. */
  onPacket(handler: (packet: T) => void): Unsubscribe {
    const stop = this.packetListeners.add(handler);
    for (let waiting = this.queue.take(); waiting; waiting = this.queue.take()) handler(waiting.value);
    return stop;
  }

  /** Calls the handler with the numbers of packets that the other side has acknowledged. */
  onAcknowledged(handler: (packetNumber: number) => void): Unsubscribe {
    return this.ackListeners.add(handler);
  }

  /** Calls the handler once the end is closed, by whichever side. */
  onClosed(handler: () => void): Unsubscribe {
    return this.closedListeners.add(handler);
  }

  /** Closes the end and tells the other side. Harmless when it is closed. */
  async close(): Promise<void> {
    if (!this.isOpen) return;
    this.ended();
    await this.transport.close(this.index);
  }

  /** @internal The other side, or the session, has ended it. */
  ended(): void {
    if (!this.isOpen) return;
    this.isOpen = false;
    this.queue.end();
    this.held.clear();
    this.closedListeners.call();
  }

  /** @internal Takes a packet, and gives the acknowledgement. Packets of a wrong form or type are dropped. */
  take(packet: MessageElement): MessageElement | undefined {
    if (!this.isOpen) return undefined;
    const number = numberOf(optionalElement(packet.elements, "packetnumber"));
    if (number === undefined) return undefined;
    if (this.transport.canReceive) this.order(packet, number);
    return optionalElement(packet.elements, "requestack") ? numberElement(this.index, "uint32", number) : undefined;
  }

  private order(packet: MessageElement, number: number): void {
    if (this.isUnreliable) {
      this.deliver(packet);
      return;
    }
    const next = (this.received + 1) >>> 0;
    if (number !== next) {
      // Behind is what came already.
      if ((number - next) >>> 0 < 0x80000000 && this.held.size < outOfOrderLimit) this.held.set(number, packet);
      return;
    }
    this.received = number;
    this.deliver(packet);
    for (;;) {
      const following = (this.received + 1) >>> 0;
      const waiting = this.held.get(following);
      if (!waiting) return;
      this.held.delete(following);
      this.received = following;
      this.deliver(waiting);
    }
  }

  /** @internal */
  acknowledged(number: number): void {
    if (this.isOpen) this.ackListeners.call(number);
  }

  private deliver(packet: MessageElement): void {
    let value: T;
    try {
      value = this.transport.unpack(findElement(packet.elements, "packet")) as T;
    } catch {
      return;
    }
    if (!this.packetListeners.isEmpty) {
      this.packetListeners.call(value);
      return;
    }
    if (this.queue.put({ value }) || !this.isOpen) return;
    // Packets that nobody reads must not fill the memory, and none may be left out: the end is over.
    this.transport.report(overflow(`the pipe ${this.member.name}`));
    this.queue.end(overflow(`the pipe ${this.member.name}`));
    this.close().catch((error: unknown) => {
      this.transport.report(error);
    });
  }
}

function numberOf(element: MessageElement | undefined): number | undefined {
  if (element?.type !== ElementType.uint32 || element.count === 0 || !element.data) return undefined;
  return readNumber("uint32", element.data) as number;
}
