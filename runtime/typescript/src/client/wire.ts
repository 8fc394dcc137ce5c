// SPDX-License-Identifier: Apache-2.0
import type { MessageElement, MessageEntry } from "../codec/message.js";
import type { Member } from "../definition/types.js";
import { EntryType, unreliableMark } from "../entry_type.js";
import { ErrorCode, makeError } from "../errors.js";
import { type TimedValue, WireEnd } from "../streams/wire_end.js";
import { findElement } from "../value/shapes.js";
import { timeElement, timeOf, WireClock } from "../wire_time.js";
import type { RemoteObject } from "./remote_object.js";
import type { CallOptions } from "./session.js";

/** A wire of an object of a service. */
export class Wire<T = unknown> {
  private end: WireEnd<T> | undefined;
  private readonly clock = new WireClock();

  /** @internal */
  constructor(
    private readonly object: RemoteObject,
    private readonly member: Member,
  ) {}

  /** Connects; one connection of a client at a time, else InvalidOperation. */
  async connect(options: CallOptions = {}): Promise<WireEnd<T>> {
    const { object, member } = this;
    const { session, path } = object;
    if (this.end) throw makeError(ErrorCode.InvalidOperation, `${member.name} is connected already`);
    const end = new WireEnd<T>(member, {
      pack: (value) => object.packer.value(member.type, value, "packet"),
      unpack: (element) => object.unpacker.value(member.type, element),
      send: (make) => {
        session.connection.sendNewest(`${path}\n${member.name}`, () => {
          session.packet({ type: EntryType.wirePacket, path, member: member.name, elements: make(), metadata: unreliableMark }, true);
        });
      },
      close: async () => {
        if (this.end === end) this.end = undefined;
        if (session.isOpen) await session.request({ type: EntryType.wireDisconnect, path, member: member.name });
      },
      report: (error) => {
        session.report(error);
      },
      canSend: !member.isReadonly,
      canReceive: !member.isWriteonly,
    });
    // Values may come before the answer.
    this.end = end;
    try {
      await session.request({ type: EntryType.wireConnect, path, member: member.name, ...options });
    } catch (error) {
      this.end = undefined;
      end.ended();
      throw error;
    }
    return end;
  }

  /** The value that the service has now. */
  async peekIn(options: CallOptions = {}): Promise<TimedValue<T>> {
    return await this.peek(EntryType.wirePeekIn, options);
  }

  /** The value that the service has got last. */
  async peekOut(options: CallOptions = {}): Promise<TimedValue<T>> {
    return await this.peek(EntryType.wirePeekOut, options);
  }

  private async peek(type: number, options: CallOptions): Promise<TimedValue<T>> {
    const { object, member } = this;
    const answer = await object.session.request({ type, path: object.path, member: member.name, ...options });
    const value = object.unpacker.value(member.type, findElement(answer.elements, "packet")) as T;
    return { value, time: timeOf(answer.elements) };
  }

  /** Gives the service a value without connecting. */
  async pokeOut(value: T, options: CallOptions = {}): Promise<void> {
    const { object, member } = this;
    const elements: MessageElement[] = [timeElement(this.clock.now()), object.packer.value(member.type, value, "packet")];
    await object.session.request({ type: EntryType.wirePokeOut, path: object.path, member: member.name, elements, ...options });
  }

  /** @internal */
  take(entry: MessageEntry): void {
    if (entry.type === EntryType.wireClosed) this.ended();
    else this.end?.take(entry.elements);
  }

  /** @internal */
  ended(): void {
    const { end } = this;
    this.end = undefined;
    end?.ended();
  }
}
