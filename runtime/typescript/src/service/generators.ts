// SPDX-License-Identifier: Apache-2.0
// Generators of a client's session (07, section 8).
import { randomUint32 } from "../random.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import type { Member } from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import { indexIn } from "../client/remote_object.js";
import { numberElement } from "../value/pack.js";
import { findElement } from "../value/shapes.js";
import type { GeneratorSource, ServedObject } from "./served_object.js";

const keptAfterClose = 30_000;
/** So many that are closed are known: a client may open and close faster than that time passes. */
const mostClosed = 128;

interface Held {
  object: ServedObject;
  member: Member;
  path: string;
  source: GeneratorSource;
  used: number;
  ending: number | undefined;
}

export class Generators {
  private readonly held = new Map<number, Held>();
  /** Of these, oldest first. */
  private readonly closed = new Set<number>();

  constructor(
    private readonly limit: number,
    private readonly timeout: number,
  ) {}

  /** Keeps what a function has given; the elements of its answer. */
  add(object: ServedObject, member: Member, path: string, source: GeneratorSource): MessageElement[] {
    if (this.held.size - this.closed.size >= this.limit) {
      void source.return?.();
      throw makeError(ErrorCode.OutOfSystemResource, "the session has too many generators");
    }
    let index = 0;
    do {
      index = randomUint32() & 0x7fffffff;
    } while (this.held.has(index));
    this.held.set(index, { object, member, path, source, used: Date.now(), ending: undefined });
    return [numberElement("index", "int32", index)];
  }

  /** A step, or the end that the client wants. */
  async next(entry: MessageEntry): Promise<MessageElement[]> {
    const index = indexIn(entry);
    const held = this.held.get(index);
    if (!held || held.path !== entry.path || held.member.name !== entry.member) {
      throw makeError(ErrorCode.InvalidOperation, "Invalid generator");
    }
    held.used = Date.now();
    if (entry.error !== 0) {
      this.close(index, held, entry.error);
      await this.finish(held, entry.error);
      return [numberElement("return", "int32", 0)];
    }
    if (held.ending === ErrorCode.StopIteration) throw makeError(ErrorCode.StopIteration, "");
    if (held.ending !== undefined) throw makeError(ErrorCode.OperationAborted, "generator was aborted");
    try {
      const { object, member, source } = held;
      const { generator, type } = member;
      const parameter = generator?.takes ? object.unpacker.value(generator.takes, findElement(entry.elements, "parameter")) : undefined;
      const step = await source.next(parameter);
      if (step.done) throw makeError(ErrorCode.StopIteration, "");
      return [generator?.gives ? object.packer.value(type, step.value, "return") : numberElement("return", "int32", 0)];
    } catch (error) {
      this.forget(index);
      throw error;
    }
  }

  private close(index: number, held: Held, code: number): void {
    if (held.ending !== undefined) return;
    held.ending = code === ErrorCode.StopIteration ? ErrorCode.StopIteration : ErrorCode.OperationAborted;
    this.closed.add(index);
    const [oldest] = this.closed;
    if (this.closed.size > mostClosed && oldest !== undefined) this.forget(oldest);
  }

  private forget(index: number): void {
    this.held.delete(index);
    this.closed.delete(index);
  }

  private async finish({ source }: Held, code: number): Promise<void> {
    try {
      if (code === ErrorCode.StopIteration) await source.return?.();
      else await source.throw?.(makeError(ErrorCode.AbortOperation, "Generator abort requested"));
    } catch {
      // It has ended, which is what was wanted.
    }
  }

  /** Drops what nobody used for too long. */
  tidy(): void {
    const now = Date.now();
    for (const [index, one] of this.held) {
      const kept = one.ending === undefined ? this.timeout : Math.min(keptAfterClose, this.timeout);
      if (now - one.used < kept) continue;
      this.forget(index);
      if (one.ending === undefined) void this.finish(one, ErrorCode.AbortOperation);
    }
  }

  clear(isOver: (path: string) => boolean = () => true): void {
    for (const [index, one] of this.held) {
      if (!isOver(one.path)) continue;
      this.forget(index);
      if (one.ending === undefined) void this.finish(one, ErrorCode.StopIteration);
    }
  }
}
