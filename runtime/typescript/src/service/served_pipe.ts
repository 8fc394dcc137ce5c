// SPDX-License-Identifier: Apache-2.0
import { ElementType } from "../codec/element_type.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import type { Member } from "../definition/types.js";
import { EntryType, unreliableMark } from "../entry_type.js";
import { ErrorCode, makeError } from "../errors.js";
import { indexIn } from "../client/remote_object.js";
import { Listeners, type Unsubscribe } from "../listeners.js";
import { PipeEnd } from "../streams/pipe_end.js";
import { readNumber } from "../value/numbers.js";
import { numberElement } from "../value/pack.js";
import { elementNumber, optionalElement } from "../value/shapes.js";
import type { ServedObject } from "./served_object.js";
import type { ServerSession } from "./server_session.js";

interface Held<T> {
  end: PipeEnd<T>;
  client: number;
  path: string;
}

/** A pipe of an object: the ends that clients have connected. */
export class ServedPipe<T = unknown> {
  private readonly held = new Set<Held<T>>();
  private readonly connected: Listeners<[PipeEnd<T>, number]>;

  /** @internal */
  constructor(
    private readonly object: ServedObject,
    private readonly member: Member,
  ) {
    this.connected = new Listeners(() => undefined);
  }

  /** Calls the handler with each end that a client connects, and the client's number. */
  onConnect(handler: (end: PipeEnd<T>, client: number) => void): Unsubscribe {
    return this.connected.add(handler);
  }

  /** The ends of all clients that have connected. */
  get ends(): PipeEnd<T>[] {
    return [...this.held].map(({ end }) => end);
  }

  /** Sends a packet to all clients that have connected. Ends that cannot take it are closed. */
  broadcast(value: T): void {
    for (const { end } of [...this.held]) {
      try {
        end.send(value);
      } catch {
        void end.close().catch(() => undefined);
      }
    }
  }

  /** @internal Answers PipeConnect. */
  connect(session: ServerSession, entry: MessageEntry): MessageElement[] {
    const mine = [...this.held].filter(({ client, path }) => client === session.endpoint && path === entry.path);
    if (mine.length >= session.settings.limits.pipeEnds) throw makeError(ErrorCode.OutOfSystemResource, `${this.member.name} has too many ends`);
    let index = indexIn(entry);
    const used = mine.map(({ end }) => end.index).sort((a, b) => a - b);
    for (const one of used) if (one >= index) index = one + 1;
    if (index === -1) index = 1;
    const isUnreliable = this.member.isUnreliable && optionalElement(entry.elements, "unreliable") !== undefined;
    const end = this.makeEnd(session, entry.path, index, isUnreliable);
    this.held.add({ end, client: session.endpoint, path: entry.path });
    this.connected.call(end, session.endpoint);
    const elements = [numberElement("index", "int32", index)];
    if (isUnreliable) elements.push(numberElement("unreliable", "int32", 1));
    return elements;
  }

  private makeEnd(session: ServerSession, path: string, index: number, isUnreliable: boolean): PipeEnd<T> {
    const { object, member } = this;
    const packet = (type: number, element: MessageElement, hasEntryMark: boolean, isMarked: boolean): void => {
      session.packet({ type, path, member: member.name, elements: [element], ...(hasEntryMark && isMarked ? { metadata: unreliableMark } : {}) }, isMarked);
    };
    const end = new PipeEnd<T>(member, index, isUnreliable, {
      pack: (value) => object.packer.value(member.type, value, "packet"),
      unpack: (element) => object.unpacker.value(member.type, element),
      send: (element, isMarked) => {
        packet(EntryType.pipePacket, element, true, isMarked);
      },
      close: async () => {
        this.forget(end);
        if (session.isOpen) packet(EntryType.pipeClosed, numberElement("index", "int32", index), false, false);
        await Promise.resolve();
      },
      report: (error) => {
        session.report(error);
      },
      canSend: !member.isWriteonly,
      canReceive: !member.isReadonly,
      queueLimit: session.settings.limits.packetQueue,
    });
    return end;
  }

  private forget(end: PipeEnd<T>): void {
    for (const one of this.held) if (one.end === end) this.held.delete(one);
  }

  private find(client: number, path: string, index: number): PipeEnd<T> | undefined {
    for (const one of this.held) {
      if (one.client === client && one.path === path && one.end.index === index) return one.end;
    }
    return undefined;
  }

  /** @internal Answers PipeDisconnect. */
  disconnect(session: ServerSession, entry: MessageEntry): void {
    const end = this.find(session.endpoint, entry.path, indexIn(entry));
    if (!end) throw makeError(ErrorCode.InvalidArgument, "Invalid pipe endpoint");
    this.forget(end);
    end.ended();
  }

  /** @internal Packets and acknowledgements. */
  take(session: ServerSession, entry: MessageEntry): void {
    const acks: MessageElement[] = [];
    let isMarked = false;
    for (const element of entry.elements) {
      const index = elementNumber(element);
      const end = index === undefined ? undefined : this.find(session.endpoint, entry.path, index);
      if (!end) continue;
      if (entry.type === EntryType.pipePacket) {
        const ack = end.take(element);
        if (ack) acks.push(ack);
        isMarked = end.isUnreliable;
      } else if (element.type === ElementType.uint32 && element.data && element.count > 0) {
        end.acknowledged(readNumber("uint32", element.data) as number);
      }
    }
    // Packets that came together are acknowledged together.
    if (acks.length > 0) session.packet({ type: EntryType.pipePacketRet, path: entry.path, member: entry.member, elements: acks }, isMarked);
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
