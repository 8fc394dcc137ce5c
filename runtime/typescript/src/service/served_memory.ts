// SPDX-License-Identifier: Apache-2.0
// A memory of an object: an array that clients read and write in parts (07, section 13).
import { ElementType } from "../codec/element_type.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import { product, type Member } from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import { readNumbers } from "../value/numbers.js";
import { numberElement, numbersElement } from "../value/pack.js";
import { copyBlock, emptyRow, packedSize } from "../value/rows.js";
import { checkType, findElement } from "../value/shapes.js";
import { textOf } from "../value/unpack.js";
import { MultiDimArray } from "../value/values.js";
import type { ServedObject } from "./served_object.js";
import type { ServerSession } from "./server_session.js";

/** What a memory holds: a row, or a block with several dimensions. */
export type MemoryContent = ArrayLike<unknown> | MultiDimArray;

/** `C` is what it holds: a typed array of numbers mostly. */
export class ServedMemory<C extends MemoryContent = MemoryContent> {
  private content: MemoryContent | undefined;

  /** @internal */
  constructor(
    private readonly object: ServedObject,
    private readonly member: Member,
  ) {}

  /** Gives clients this array to read and write, in place. */
  store(content: C): void {
    this.content = content;
  }

  private get hasDims(): boolean {
    return this.member.type.array.kind === "dims";
  }

  private get row(): ArrayLike<unknown> {
    const { content } = this;
    if (content === undefined) throw makeError(ErrorCode.NotImplementedError, `${this.member.name} holds nothing`);
    return content instanceof MultiDimArray ? content.array : content;
  }

  private get dims(): readonly number[] {
    const { row, content } = this;
    return content instanceof MultiDimArray ? content.dims : [row.length];
  }

  /** @internal Answers MemoryGetParam. */
  parameter(session: ServerSession, entry: MessageEntry): MessageElement[] {
    const name = textOf(findElement(entry.elements, "parameter"));
    if (name === "MaxTransferSize") return [numberElement("return", "uint32", session.settings.memoryTransferLimit)];
    if (name === "Length" && !this.hasDims) return [numberElement("return", "uint64", this.row.length)];
    if (name === "Dimensions" && this.hasDims) return [numbersElement("return", "uint64", this.dims)];
    if (name === "DimCount" && this.hasDims) return [numberElement("return", "uint64", this.dims.length)];
    throw makeError(ErrorCode.InvalidOperation, "Unknown parameter");
  }

  /** @internal Answers MemoryRead. */
  read(session: ServerSession, entry: MessageEntry): MessageElement[] {
    if (this.member.isWriteonly) throw makeError(ErrorCode.WriteOnlyMember, "Write only member");
    const { position, count, given } = this.part(entry);
    const items = product(count);
    if (items * packedSize(this.member.type.base) > session.settings.limits.messageSize) {
      throw makeError(ErrorCode.ProtocolError, "a part of a memory is larger than a message");
    }
    const part = emptyRow(this.member.type.base, items);
    copyBlock(this.row, position, this.dims, part, count.map(() => 0), count, count);
    const value = this.hasDims ? new MultiDimArray(count.slice(0, given.position.length), part) : part;
    // Of several dimensions `count` repeats the position, as existing services answer; clients ignore both.
    return [numbersElement("memorypos", "uint64", given.position), numbersElement("count", "uint64", this.hasDims ? given.position : given.count), this.object.packer.value(this.member.type, value, "data")];
  }

  /** @internal Answers MemoryWrite. */
  write(entry: MessageEntry): MessageElement[] {
    if (this.member.isReadonly) throw makeError(ErrorCode.ReadOnlyMember, "Read only member");
    const { position, count, given } = this.part(entry);
    const value = this.object.unpacker.value(this.member.type, findElement(entry.elements, "data")) as MemoryContent;
    const part = value instanceof MultiDimArray ? value.array : value;
    if (part.length !== product(count)) this.outside();
    copyBlock(part, count.map(() => 0), count, this.row, position, this.dims, count);
    return [numbersElement("memorypos", "uint64", given.position), numbersElement("count", "uint64", given.count)];
  }

  private outside(): never {
    if (this.hasDims) throw makeError(ErrorCode.InvalidArgument, "MultiDimArray A count invalid");
    throw makeError(ErrorCode.OutOfRange, "Index out of range");
  }

  /** Where, and how much, in all dimensions; and as it was given, which the answer repeats. */
  private part(entry: MessageEntry): { position: number[]; count: number[]; given: { position: number[]; count: number[] } } {
    const position = numbersIn(findElement(entry.elements, "memorypos"));
    const count = numbersIn(findElement(entry.elements, "count"));
    const given = { position: [...position], count: [...count] };
    const { dims } = this;
    const most = this.hasDims ? dims.length : 1;
    if (position.length === 0 || position.length !== count.length || position.length > most) this.outside();
    // Less dimensions are let through by existing implementations: one item in each of the others.
    while (position.length < dims.length) {
      position.push(0);
      count.push(1);
    }
    // Numbers above 2^53 are too large whatever their last digits.
    dims.forEach((dim, i) => {
      if ((position[i] ?? 0) + (count[i] ?? 0) > dim) this.outside();
    });
    return { position, count, given };
  }
}

function numbersIn(element: MessageElement): number[] {
  checkType(element, ElementType.uint64, element.name ?? "");
  return Array.from(readNumbers("uint64", element.data ?? new Uint8Array(0)) as BigUint64Array, Number);
}
