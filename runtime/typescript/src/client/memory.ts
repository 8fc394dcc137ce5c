// SPDX-License-Identifier: Apache-2.0
// Memories: arrays of a service that are read and written in parts (07, section 13).
import { ElementType } from "../codec/element_type.js";
import type { MessageElement } from "../codec/message.js";
import { product, type Member } from "../definition/types.js";
import { EntryType } from "../entry_type.js";
import { ErrorCode, makeError } from "../errors.js";
import { readNumber, readNumbers } from "../value/numbers.js";
import { numberElement, numbersElement, textElement } from "../value/pack.js";
import { checkType, findElement } from "../value/shapes.js";
import { MultiDimArray } from "../value/values.js";
import { copyBlock, emptyRow, packedSize, slice } from "../value/rows.js";
import type { RemoteObject } from "./remote_object.js";
import type { CallOptions } from "./session.js";

function asNumber(value: bigint): number {
  const number = Number(value);
  if (!Number.isSafeInteger(number)) throw makeError(ErrorCode.OutOfRange, `${value} items are more than any array has`);
  return number;
}

abstract class MemoryBase {
  /** @internal */
  constructor(
    protected readonly object: RemoteObject,
    protected readonly member: Member,
  ) {}

  protected async parameter(name: string, options: CallOptions): Promise<MessageElement> {
    const { object, member } = this;
    const elements = [textElement("parameter", name)];
    const answer = await object.session.request({ type: EntryType.memoryGetParam, path: object.path, member: member.name, elements, ...options });
    return findElement(answer.elements, "return");
  }

  /** Items that one request may have now: at least one. Asked before each transfer, as all clients do. */
  protected async itemsAtOnce(options: CallOptions): Promise<number> {
    const element = await this.parameter("MaxTransferSize", options);
    checkType(element, ElementType.uint32, "return");
    const theirs = element.count > 0 && element.data ? (readNumber("uint32", element.data) as number) : 0;
    const own = this.object.session.settings.memoryTransferLimit;
    return Math.max(1, Math.floor(Math.min(own, theirs) / packedSize(this.member.type.base)));
  }

  protected async transfer(type: number, elements: MessageElement[], options: CallOptions): Promise<MessageElement[]> {
    const { object, member } = this;
    const answer = await object.session.request({ type, path: object.path, member: member.name, elements, ...options });
    return answer.elements;
  }

  protected refuse(isReading: boolean): void {
    if (isReading && this.member.isWriteonly) throw makeError(ErrorCode.WriteOnlyMember, "Write only member");
    if (!isReading && this.member.isReadonly) throw makeError(ErrorCode.ReadOnlyMember, "Read only member");
  }
}

/** A memory of one dimension. `A` is what its type is read as, a typed array of numbers mostly. */
export class ArrayMemory<A extends ArrayLike<unknown> = ArrayLike<unknown>> extends MemoryBase {
  /** Items that it has now. */
  async length(options: CallOptions = {}): Promise<number> {
    const element = await this.parameter("Length", options);
    checkType(element, ElementType.uint64, "return");
    if (element.count === 0 || !element.data) throw makeError(ErrorCode.OutOfRange, "a length has no number");
    return asNumber(readNumber("uint64", element.data) as bigint);
  }

  /** Large parts are read by several requests. */
  async read(position: number, count: number, options: CallOptions = {}): Promise<A> {
    this.refuse(true);
    const atOnce = await this.itemsAtOnce(options);
    if (count <= atOnce) return await this.readPart(position, count, options);
    let all: ArrayLike<unknown> | undefined;
    for (let done = 0; done < count; done += atOnce) {
      await this.itemsAtOnce(options);
      const part = await this.readPart(position + done, Math.min(atOnce, count - done), options);
      // As long as nothing has come, nothing is reserved.
      all ??= emptyRow(this.member.type.base, count);
      copyBlock(part, [0], [part.length], all, [done], [count], [part.length]);
    }
    return all as unknown as A;
  }

  private async readPart(position: number, count: number, options: CallOptions): Promise<A> {
    const elements = [numberElement("memorypos", "uint64", position), numberElement("count", "uint64", count)];
    const answer = await this.transfer(EntryType.memoryRead, elements, options);
    const part = this.object.unpacker.value(this.member.type, findElement(answer, "data")) as A;
    if (part.length !== count) throw makeError(ErrorCode.ProtocolError, `${part.length} items came instead of ${count}`);
    return part;
  }

  /** Writes the items from `position` on, in as many requests as the limits of both sides want. */
  async write(position: number, items: ArrayLike<A[number]>, options: CallOptions = {}): Promise<void> {
    this.refuse(false);
    const atOnce = await this.itemsAtOnce(options);
    let done = 0;
    do {
      if (items.length > atOnce) await this.itemsAtOnce(options);
      const count = Math.min(atOnce, items.length - done);
      const elements = [
        numberElement("memorypos", "uint64", position + done),
        numberElement("count", "uint64", count),
        this.object.packer.value(this.member.type, slice(items, done, done + count), "data"),
      ];
      await this.transfer(EntryType.memoryWrite, elements, options);
      done += count;
    } while (done < items.length);
  }
}

/** A memory of several dimensions. */
export class MultiDimMemory<A extends ArrayLike<unknown> = ArrayLike<unknown>> extends MemoryBase {
  /** The length of each dimension. Asks the service. */
  async dims(options: CallOptions = {}): Promise<number[]> {
    const element = await this.parameter("Dimensions", options);
    checkType(element, ElementType.uint64, "return");
    const numbers = readNumbers("uint64", element.data ?? new Uint8Array(0)) as BigUint64Array;
    return Array.from(numbers, asNumber);
  }

  /** How many dimensions. */
  async dimCount(options: CallOptions = {}): Promise<number> {
    const element = await this.parameter("DimCount", options);
    checkType(element, ElementType.uint64, "return");
    if (element.count === 0 || !element.data) throw makeError(ErrorCode.OutOfRange, "a count has no number");
    return asNumber(readNumber("uint64", element.data) as bigint);
  }

  /** The block that begins at `position` and has so many items in each dimension. */
  async read(position: readonly number[], count: readonly number[], options: CallOptions = {}): Promise<MultiDimArray<A>> {
    this.refuse(true);
    const atOnce = await this.itemsAtOnce(options);
    const blocks = blocksOf(count, atOnce);
    if (blocks.length === 1) return await this.readBlock(position, count, options);
    let all: ArrayLike<unknown> | undefined;
    for (const block of blocks) {
      await this.itemsAtOnce(options);
      const part = await this.readBlock(sum(position, block.start), block.count, options);
      all ??= emptyRow(this.member.type.base, product(count));
      copyBlock(part.array, block.count.map(() => 0), block.count, all, block.start, count, block.count);
    }
    return new MultiDimArray(count, all as unknown as A);
  }

  private async readBlock(position: readonly number[], count: readonly number[], options: CallOptions): Promise<MultiDimArray<A>> {
    const elements = [numbersElement("memorypos", "uint64", position), numbersElement("count", "uint64", count)];
    const answer = await this.transfer(EntryType.memoryRead, elements, options);
    const part = this.object.unpacker.value(this.member.type, findElement(answer, "data")) as MultiDimArray<A>;
    if (part.array.length !== product(count)) throw makeError(ErrorCode.ProtocolError, `${part.array.length} items came instead of ${product(count)}`);
    return part;
  }

  /** Writes a block that begins at `position`; its dims are the counts. */
  async write(position: readonly number[], block: MultiDimArray, options: CallOptions = {}): Promise<void> {
    this.refuse(false);
    const atOnce = await this.itemsAtOnce(options);
    const parts = blocksOf(block.dims, atOnce);
    for (const part of parts) {
      if (parts.length > 1) await this.itemsAtOnce(options);
      const row = emptyRow(this.member.type.base, product(part.count));
      copyBlock(block.array, part.start, block.dims, row, part.start.map(() => 0), part.count, part.count);
      const elements = [
        numbersElement("memorypos", "uint64", sum(position, part.start)),
        numbersElement("count", "uint64", part.count),
        this.object.packer.value(this.member.type, new MultiDimArray(part.count, row), "data"),
      ];
      await this.transfer(EntryType.memoryWrite, elements, options);
    }
  }
}

function sum(a: readonly number[], b: readonly number[]): number[] {
  return a.map((one, i) => one + (b[i] ?? 0));
}

/**
 * Cuts a block along the first dimension at which the product exceeds the limit: those before it stay whole,
 * those after it go one by one.
 */
export function blocksOf(count: readonly number[], limit: number): { start: number[]; count: number[] }[] {
  if (count.length === 0 || product(count) <= limit) return [{ start: count.map(() => 0), count: [...count] }];
  let before = 1;
  let cut = 0;
  while (cut < count.length - 1 && before * (count[cut] ?? 1) <= limit) before *= count[cut++] ?? 1;
  const step = Math.max(1, Math.floor(limit / before));
  const blocks: { start: number[]; count: number[] }[] = [];
  const outer = count.slice(cut + 1);
  const outerCount = product(outer);
  for (let o = 0; o < outerCount; ++o) {
    const outerStart: number[] = [];
    let rest = o;
    for (const dim of outer) {
      outerStart.push(rest % dim);
      rest = Math.floor(rest / dim);
    }
    const along = count[cut] ?? 1;
    for (let at = 0; at < along; at += step) {
      blocks.push({
        start: [...count.slice(0, cut).map(() => 0), at, ...outerStart],
        count: [...count.slice(0, cut), Math.min(step, along - at), ...outer.map(() => 1)],
      });
    }
  }
  return blocks;
}

