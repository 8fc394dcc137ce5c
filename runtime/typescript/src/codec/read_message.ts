// SPDX-License-Identifier: Apache-2.0
// Messages of both formats from bytes. Payloads are views of the bytes; nothing is reserved before the bytes
// that it is for are known to be there.
import { ByteReader } from "./byte_reader.js";
import { isNested, itemSize } from "./element_type.js";
import { FormatError } from "./format_error.js";
import {
  defaultCodecLimits,
  EntryFlag,
  ElementFlag,
  HeaderFlag,
  magic,
  type CodecLimits,
  type Message,
  type MessageElement,
  type MessageEntry,
  type ReadOptions,
} from "./message.js";
import { CodeReader } from "./string_table.js";

const smallestEntry = { 2: 22, 4: 5 } as const;
const smallestElement = { 2: 16, 4: 5 } as const;

/**
 * Reads the whole of `bytes` as one message. Throws {@link FormatError} for anything else. A message without
 * entries is read; connections refuse it.
 */
export function readMessage(bytes: Uint8Array, options: ReadOptions = {}): Message {
  const reader = new ByteReader(bytes);
  if (reader.u32() !== magic) throw new FormatError("no message begins like this");
  if (reader.u32() !== bytes.length) throw new FormatError("a message has another size than it says");
  const version = reader.u16();
  if (version !== 2 && version !== 4) throw new FormatError(`message version ${version} is unknown`);
  return new MessageReader(reader, version, options).message();
}

/** Reads the whole of `bytes` as one element; for values that are kept or compared outside of messages. */
export function readElement(bytes: Uint8Array, version: 2 | 4, options: ReadOptions = {}): MessageElement {
  const reader = new ByteReader(bytes);
  const element = new MessageReader(reader, version, options).element(1);
  if (reader.remaining !== 0) throw new FormatError("bytes are left behind the element");
  return element;
}

class MessageReader {
  private readonly limits: CodecLimits;
  private readonly codes: CodeReader;
  private elementsLeft: number;

  constructor(
    private readonly reader: ByteReader,
    private readonly version: 2 | 4,
    options: ReadOptions,
  ) {
    this.limits = options.limits ?? defaultCodecLimits;
    this.codes = new CodeReader(options.stringTable ?? true, options.keepUnknownCodes ?? false);
    this.elementsLeft = this.limits.elements;
  }

  message(): Message {
    const message: Message = { version: this.version, entries: [] };
    const count = this.version === 2 ? this.header2(message) : this.header4(message);
    if (count * smallestEntry[this.version] > this.reader.remaining) {
      throw new FormatError("a message has less entries than it says");
    }
    for (let i = 0; i < count; ++i) {
      message.entries.push(this.version === 2 ? this.entry2() : this.entry4());
    }
    if (this.reader.remaining !== 0) throw new FormatError("bytes are left behind the last entry");
    return message;
  }

  private header2(message: Message): number {
    const { reader } = this;
    const headerSize = reader.u16();
    message.senderNode = reader.part(16);
    message.receiverNode = reader.part(16);
    message.senderEndpoint = reader.u32();
    message.receiverEndpoint = reader.u32();
    message.senderName = reader.text(reader.u16());
    message.receiverName = reader.text(reader.u16());
    message.metadata = reader.text(reader.u16());
    const count = reader.u16();
    message.messageId = reader.u16();
    message.messageResId = reader.u16();
    this.checkHeaderSize(headerSize);
    return count;
  }

  private header4(message: Message): number {
    const { reader } = this;
    const headerSize = reader.varUint();
    const flags = (message.flags = reader.u8());
    if (flags & HeaderFlag.routing) {
      message.senderNode = reader.part(16);
      message.receiverNode = reader.part(16);
      message.senderName = reader.text(reader.varUint());
      message.receiverName = reader.text(reader.varUint());
    }
    if (flags & HeaderFlag.endpoints) {
      message.senderEndpoint = reader.varUint();
      message.receiverEndpoint = reader.varUint();
    }
    if (flags & HeaderFlag.priority) message.priority = reader.u16();
    if (flags & HeaderFlag.meta) {
      message.metadata = reader.text(reader.varUint());
      message.messageId = reader.u16();
      message.messageResId = reader.u16();
    }
    if (flags & HeaderFlag.stringTable) {
      message.strings = [];
      for (let left = reader.varUint(); left > 0; --left) {
        const code = reader.varUint();
        const text = reader.text(reader.varUint());
        this.codes.add(code, text);
        message.strings.push([code, text]);
      }
    }
    const count = flags & HeaderFlag.multipleEntries ? reader.varUint() : 1;
    if (count > 0xffff) throw new FormatError("a message has too many entries");
    if (flags & HeaderFlag.extended) message.extended = reader.part(reader.varUint());
    this.checkHeaderSize(headerSize);
    return count;
  }

  private checkHeaderSize(size: number): void {
    if (this.reader.position !== size) throw new FormatError("a header has another size than it says");
  }

  private entry2(): MessageEntry {
    const { reader } = this;
    const size = reader.u32();
    if (size < smallestEntry[2]) throw new FormatError("an entry is too small");
    const outer = reader.enter(size - 4);
    const type = reader.u16();
    reader.u16();
    const path = reader.text(reader.u16());
    const member = reader.text(reader.u16());
    const requestId = reader.u32();
    const error = reader.u16();
    const entry: MessageEntry = { type, path, member, requestId, error, elements: [] };
    entry.metadata = reader.text(reader.u16());
    entry.elements = this.elements(reader.u16(), 1);
    reader.leave(outer);
    return entry;
  }

  private entry4(): MessageEntry {
    const { reader } = this;
    const outer = this.enterCounted();
    const flags = reader.u8();
    const type = reader.u16();
    const entry: MessageEntry = { type, path: "", member: "", requestId: 0, error: 0, elements: [], flags };
    if (flags & EntryFlag.path) entry.path = reader.text(reader.varUint());
    if (flags & EntryFlag.pathCode) {
      entry.pathCode = reader.varUint();
      if (!(flags & EntryFlag.path)) entry.path = this.codes.text(entry.pathCode);
    }
    if (flags & EntryFlag.member) entry.member = reader.text(reader.varUint());
    if (flags & EntryFlag.memberCode) {
      entry.memberCode = reader.varUint();
      if (!(flags & EntryFlag.member)) entry.member = this.codes.text(entry.memberCode);
    }
    if (flags & EntryFlag.requestId) entry.requestId = reader.varUint();
    if (flags & EntryFlag.error) entry.error = reader.u16();
    if (flags & EntryFlag.meta) entry.metadata = reader.text(reader.varUint());
    if (flags & EntryFlag.extended) entry.extended = reader.part(reader.varUint());
    entry.elements = this.elements(reader.varUint(), 1);
    reader.leave(outer);
    return entry;
  }

  /** Enters a part that begins with its size, which counts itself. */
  private enterCounted(): number {
    const start = this.reader.position;
    const size = this.reader.varUint();
    const rest = size - (this.reader.position - start);
    if (rest < 0) throw new FormatError("an entry or element is too small");
    return this.reader.enter(rest);
  }

  private elements(count: number, depth: number): MessageElement[] {
    if (count * smallestElement[this.version] > this.reader.remaining) {
      throw new FormatError("there are less elements than the count says");
    }
    if (count > this.elementsLeft) throw new FormatError("a message has too many elements");
    this.elementsLeft -= count;
    if (count > 0 && depth > this.limits.depth) throw new FormatError("elements are nested too deeply");
    const list: MessageElement[] = [];
    for (let i = 0; i < count; ++i) list.push(this.element(depth));
    return list;
  }

  element(depth: number): MessageElement {
    return this.version === 2 ? this.element2(depth) : this.element4(depth);
  }

  private element2(depth: number): MessageElement {
    const { reader } = this;
    const size = reader.u32();
    if (size < smallestElement[2]) throw new FormatError("an element is too small");
    const outer = reader.enter(size - 4);
    const name = reader.text(reader.u16());
    const type = reader.u16();
    const typeName = reader.text(reader.u16());
    const metadata = reader.text(reader.u16());
    const element: MessageElement = { name, type, typeName, metadata, count: reader.u32() };
    this.payload(element, depth);
    reader.leave(outer);
    return element;
  }

  private element4(depth: number): MessageElement {
    const { reader } = this;
    const outer = this.enterCounted();
    const flags = reader.u8();
    const element: MessageElement = { type: 0, typeName: "", count: 0, flags };
    if (flags & ElementFlag.name) element.name = reader.text(reader.varUint());
    if (flags & ElementFlag.nameCode) {
      element.nameCode = reader.varUint();
      if (!(flags & ElementFlag.name)) element.name = this.codes.text(element.nameCode);
    }
    if (flags & ElementFlag.number) element.number = reader.varInt();
    if (element.name === undefined && element.number === undefined) element.name = "";
    element.type = reader.u16();
    if (flags & ElementFlag.typeName) element.typeName = reader.text(reader.varUint());
    if (flags & ElementFlag.typeNameCode) {
      element.typeNameCode = reader.varUint();
      if (!(flags & ElementFlag.typeName)) element.typeName = this.codes.text(element.typeNameCode);
    }
    if (flags & ElementFlag.meta) element.metadata = reader.text(reader.varUint());
    if (flags & ElementFlag.extended) element.extended = reader.part(reader.varUint());
    element.count = reader.varUint();
    this.payload(element, depth);
    reader.leave(outer);
    return element;
  }

  private payload(element: MessageElement, depth: number): void {
    const { type, count } = element;
    if (isNested(type)) {
      element.elements = this.elements(count, depth + 1);
      return;
    }
    const size = itemSize(type);
    if (size === undefined) throw new FormatError(`element type ${type} is unknown`);
    // Both factors are below 2^32, so the product is exact enough to be compared.
    if (count * size > this.reader.remaining) throw new FormatError("an array is longer than its element");
    element.data = this.reader.part(count * size);
  }
}
