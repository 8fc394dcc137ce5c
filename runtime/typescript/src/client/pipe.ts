// SPDX-License-Identifier: Apache-2.0
import { ElementType } from "../codec/element_type.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import type { Member } from "../definition/types.js";
import { EntryType, unreliableMark } from "../entry_type.js";
import { ErrorCode, makeError } from "../errors.js";
import { PipeEnd } from "../streams/pipe_end.js";
import { readNumber } from "../value/numbers.js";
import { numberElement } from "../value/pack.js";
import { elementNumber, optionalElement } from "../value/shapes.js";
import { indexIn, type RemoteObject } from "./remote_object.js";
import type { CallOptions } from "./session.js";

/** How to connect an end of a pipe. */
export interface PipeOptions extends CallOptions {
  /** -1, the default, for any. */
  index?: number;
  /** Packets may be lost, if the definition and the service allow it. */
  unreliable?: boolean;
}

/** Packets for ends whose connecting is not answered yet. */
const earlyLimit = 256;

/** A pipe of an object of a service. */
export class Pipe<T = unknown> {
  private readonly ends = new Map<number, PipeEnd<T>>();
  private connecting = 0;
  private early: MessageElement[] = [];

  /** @internal */
  constructor(
    private readonly object: RemoteObject,
    private readonly member: Member,
  ) {}

  /** Connects an end of one's own. */
  async connect(options: PipeOptions = {}): Promise<PipeEnd<T>> {
    const { object, member } = this;
    const { limits } = object.session.settings;
    if (this.ends.size + this.connecting >= limits.pipeEnds) throw makeError(ErrorCode.OutOfSystemResource, `${member.name} has too many ends`);
    const wantsUnreliable = options.unreliable === true && member.isUnreliable;
    const elements = [numberElement("index", "int32", options.index ?? -1)];
    if (wantsUnreliable) elements.push(numberElement("unreliable", "int32", 1));
    ++this.connecting;
    let end: PipeEnd<T> | undefined;
    try {
      await object.session.request({
        ...(options.signal ? { signal: options.signal } : {}),
        ...(options.timeout === undefined ? {} : { timeout: options.timeout }),
        type: EntryType.pipeConnect,
        path: object.path,
        member: member.name,
        elements,
        onAnswer: (answer) => {
          const index = indexIn(answer);
          if (this.ends.has(index)) throw makeError(ErrorCode.ProtocolError, `the index ${index} is in use`);
          const isUnreliable = wantsUnreliable && optionalElement(answer.elements, "unreliable") !== undefined;
          end = this.makeEnd(index, isUnreliable);
        },
      });
    } finally {
      --this.connecting;
      if (this.connecting === 0) this.early = [];
    }
    if (!end) throw makeError(ErrorCode.InternalError, "an end was not made");
    return end;
  }

  private makeEnd(index: number, isUnreliable: boolean): PipeEnd<T> {
    const { object, member } = this;
    const { session, path } = object;
    const end = new PipeEnd<T>(member, index, isUnreliable, {
      pack: (value) => object.packer.value(member.type, value, "packet"),
      unpack: (element) => object.unpacker.value(member.type, element),
      send: (element, isMarked) => {
        const mark = isMarked ? { metadata: unreliableMark } : {};
        session.packet({ type: EntryType.pipePacket, path, member: member.name, elements: [element], ...mark }, isMarked);
      },
      close: async () => {
        this.ends.delete(index);
        if (!session.isOpen) return;
        await session.request({ type: EntryType.pipeDisconnect, path, member: member.name, elements: [numberElement("index", "int32", index)] });
      },
      report: (error) => {
        session.report(error);
      },
      canSend: !member.isReadonly,
      canReceive: !member.isWriteonly,
      queueLimit: session.settings.limits.packetQueue,
    });
    this.ends.set(index, end);
    // Packets may come before the answer that tells the index.
    const { early } = this;
    this.early = early.filter((element) => elementNumber(element) !== index);
    queueMicrotask(() => {
      this.packets(early.filter((element) => elementNumber(element) === index));
    });
    return end;
  }

  /** @internal */
  take(entry: MessageEntry): void {
    if (entry.type === EntryType.pipeClosed) {
      const index = optionalElement(entry.elements, "index");
      if (index?.type !== ElementType.int32 || !index.data || index.count === 0) return;
      const number = readNumber("int32", index.data) as number;
      const end = this.ends.get(number);
      this.ends.delete(number);
      end?.ended();
      return;
    }
    if (entry.type === EntryType.pipePacket) this.packets(entry.elements);
    if (entry.type !== EntryType.pipePacketRet) return;
    for (const element of entry.elements) {
      const number = elementNumber(element);
      if (number === undefined || element.type !== ElementType.uint32 || !element.data || element.count === 0) continue;
      this.ends.get(number)?.acknowledged(readNumber("uint32", element.data) as number);
    }
  }

  /** Packets that came together are acknowledged together. */
  private packets(elements: readonly MessageElement[]): void {
    const acks: MessageElement[] = [];
    let isMarked = false;
    for (const element of elements) {
      const number = elementNumber(element);
      const end = number === undefined ? undefined : this.ends.get(number);
      const ack = end?.take(element);
      if (ack) acks.push(ack);
      if (end) isMarked = end.isUnreliable;
      else if (number !== undefined && this.connecting > 0 && this.early.length < earlyLimit) this.early.push(element);
    }
    const { session, path } = this.object;
    if (acks.length > 0 && session.isOpen) session.packet({ type: EntryType.pipePacketRet, path, member: this.member.name, elements: acks }, isMarked);
  }

  /** @internal */
  ended(): void {
    const ends = [...this.ends.values()];
    this.ends.clear();
    for (const end of ends) end.ended();
  }
}
