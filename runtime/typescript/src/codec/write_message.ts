// SPDX-License-Identifier: Apache-2.0
// Messages of both formats to bytes. Sizes are measured first, innermost first, and then written in order.
import { ByteWriter, selfCountedSize, varIntSize, varTextSize, varUintSize } from "./byte_writer.js";
import { elementFlags, entryFlags, headerFlags } from "./flags.js";
import { EntryFlag, ElementFlag, HeaderFlag, magic, type Message, type MessageElement, type MessageEntry } from "./message.js";
import { ElementType } from "./element_type.js";
import { ErrorCode, RRError } from "../errors.js";
import { textLength } from "./text.js";

const zeroNode = new Uint8Array(16);
const noBytes = new Uint8Array(0);

/**
 * The bytes of a message as pieces in order: large payloads are views of the arrays they come from.
 * Throws ProtocolError for what the format cannot express.
 */
export function writeMessage(message: Message): Uint8Array[] {
  return message.version === 2 ? new Writer2().message(message) : new Writer4().message(message);
}

/** Bytes that {@link writeMessage} gave. */
export function sizeOf(pieces: readonly Uint8Array[]): number {
  let size = 0;
  for (const piece of pieces) size += piece.length;
  return size;
}

/** The bytes of one element, as pieces; for values that are kept or compared outside of messages. */
export function writeElement(element: MessageElement, version: 2 | 4): Uint8Array[] {
  const writer = version === 2 ? new Writer2() : new Writer4();
  return writer.single(element);
}

function text16Size(text: string, what: string): number {
  const length = textLength(text);
  if (length > 0xffff) throw new RRError(ErrorCode.ProtocolError, `${what} is longer than 65535 bytes`);
  return 2 + length;
}

function checked16(count: number, what: string): number {
  if (count > 0xffff) throw new RRError(ErrorCode.ProtocolError, `there are more than 65535 ${what}`);
  return count;
}

/** Sizes of elements in the order in which they are written. */
abstract class WriterBase {
  protected readonly sizes: number[] = [];
  protected next = 0;

  protected abstract measure(element: MessageElement): number;
  protected abstract write(out: ByteWriter, element: MessageElement): void;

  single(element: MessageElement): Uint8Array[] {
    this.measure(element);
    const out = new ByteWriter();
    this.write(out, element);
    return out.finish();
  }

  protected payloadSize(element: MessageElement): number {
    if (!element.elements) return element.data?.length ?? 0;
    let size = 0;
    for (const nested of element.elements) size += this.measure(nested);
    return size;
  }

  protected writePayload(out: ByteWriter, element: MessageElement): void {
    if (element.elements) {
      for (const nested of element.elements) this.write(out, nested);
    } else if (element.type !== ElementType.void) {
      out.bytes(element.data ?? noBytes);
    }
  }
}

function elementName2(element: MessageElement): string {
  return element.name ?? String(element.number ?? "");
}

class Writer2 extends WriterBase {
  message(message: Message): Uint8Array[] {
    const headerSize =
      58 +
      text16Size(message.senderName ?? "", "a node name") +
      text16Size(message.receiverName ?? "", "a node name") +
      text16Size(message.metadata ?? "", "metadata");
    if (headerSize > 0xffff) throw new RRError(ErrorCode.ProtocolError, "a header is longer than 65535 bytes");
    const entrySizes = message.entries.map((entry) => this.entrySize(entry));
    const size = entrySizes.reduce((sum, one) => sum + one, headerSize);
    const out = new ByteWriter(Math.min(size, 4096));
    out.u32(magic);
    out.u32(size);
    out.u16(2);
    out.u16(headerSize);
    out.bytes(message.senderNode ?? zeroNode);
    out.bytes(message.receiverNode ?? zeroNode);
    out.u32(message.senderEndpoint ?? 0);
    out.u32(message.receiverEndpoint ?? 0);
    out.text16(message.senderName ?? "");
    out.text16(message.receiverName ?? "");
    out.text16(message.metadata ?? "");
    out.u16(checked16(message.entries.length, "entries"));
    out.u16(message.messageId ?? 0);
    out.u16(message.messageResId ?? 0);
    message.entries.forEach((entry, i) => {
      this.writeEntry(out, entry, entrySizes[i] ?? 0);
    });
    return out.finish();
  }

  private entrySize(entry: MessageEntry): number {
    let size =
      16 + text16Size(entry.path, "a service path") + text16Size(entry.member, "a member name") + text16Size(entry.metadata ?? "", "metadata");
    checked16(entry.elements.length, "elements in an entry");
    for (const element of entry.elements) size += this.measure(element);
    return size;
  }

  private writeEntry(out: ByteWriter, entry: MessageEntry, size: number): void {
    out.u32(size);
    out.u16(entry.type);
    out.u16(0);
    out.text16(entry.path);
    out.text16(entry.member);
    out.u32(entry.requestId);
    out.u16(entry.error);
    out.text16(entry.metadata ?? "");
    out.u16(entry.elements.length);
    for (const element of entry.elements) this.write(out, element);
  }

  protected measure(element: MessageElement): number {
    const slot = this.sizes.push(0) - 1;
    const size =
      10 +
      text16Size(elementName2(element), "an element name") +
      text16Size(element.typeName, "a type name") +
      text16Size(element.metadata ?? "", "metadata") +
      this.payloadSize(element);
    return (this.sizes[slot] = size);
  }

  protected write(out: ByteWriter, element: MessageElement): void {
    out.u32(this.sizes[this.next++] ?? 0);
    out.text16(elementName2(element));
    out.u16(element.type);
    out.text16(element.typeName);
    out.text16(element.metadata ?? "");
    out.u32(element.count);
    this.writePayload(out, element);
  }
}

class Writer4 extends WriterBase {
  message(message: Message): Uint8Array[] {
    const flags = message.flags ?? headerFlags(message);
    const entrySizes = message.entries.map((entry) => this.entrySize(entry));
    const headerSize = selfCountedSize(this.headerRest(message, flags));
    const size = entrySizes.reduce((sum, one) => sum + one, headerSize);
    const out = new ByteWriter(Math.min(size, 4096));
    out.u32(magic);
    out.u32(size);
    out.u16(4);
    out.varUint(headerSize);
    this.writeHeader(out, message, flags);
    message.entries.forEach((entry, i) => {
      this.writeEntry(out, entry, entrySizes[i] ?? 0);
    });
    return out.finish();
  }

  /** All of the header but its own size. */
  private headerRest(message: Message, flags: number): number {
    let size = 11;
    if (flags & HeaderFlag.routing) {
      size += 32 + varTextSize(message.senderName ?? "") + varTextSize(message.receiverName ?? "");
    }
    if (flags & HeaderFlag.endpoints) {
      size += varUintSize(message.senderEndpoint ?? 0) + varUintSize(message.receiverEndpoint ?? 0);
    }
    if (flags & HeaderFlag.priority) size += 2;
    if (flags & HeaderFlag.meta) size += varTextSize(message.metadata ?? "") + 4;
    if (flags & HeaderFlag.stringTable) {
      const strings = message.strings ?? [];
      size += varUintSize(strings.length);
      for (const [code, text] of strings) size += varUintSize(code) + varTextSize(text);
    }
    if (flags & HeaderFlag.multipleEntries) size += varUintSize(checked16(message.entries.length, "entries"));
    if (flags & HeaderFlag.extended) size += extendedSize(message.extended);
    return size;
  }

  private writeHeader(out: ByteWriter, message: Message, flags: number): void {
    out.u8(flags);
    if (flags & HeaderFlag.routing) {
      out.bytes(message.senderNode ?? zeroNode);
      out.bytes(message.receiverNode ?? zeroNode);
      out.varText(message.senderName ?? "");
      out.varText(message.receiverName ?? "");
    }
    if (flags & HeaderFlag.endpoints) {
      out.varUint(message.senderEndpoint ?? 0);
      out.varUint(message.receiverEndpoint ?? 0);
    }
    if (flags & HeaderFlag.priority) out.u16(message.priority ?? 0);
    if (flags & HeaderFlag.meta) {
      out.varText(message.metadata ?? "");
      out.u16(message.messageId ?? 0);
      out.u16(message.messageResId ?? 0);
    }
    if (flags & HeaderFlag.stringTable) {
      const strings = message.strings ?? [];
      out.varUint(strings.length);
      for (const [code, text] of strings) {
        out.varUint(code);
        out.varText(text);
      }
    }
    if (flags & HeaderFlag.multipleEntries) out.varUint(message.entries.length);
    if (flags & HeaderFlag.extended) writeExtended(out, message.extended);
  }

  private entrySize(entry: MessageEntry): number {
    const flags = entry.flags ?? entryFlags(entry);
    let size = 3;
    if (flags & EntryFlag.path) size += varTextSize(entry.path);
    if (flags & EntryFlag.pathCode) size += varUintSize(entry.pathCode ?? 0);
    if (flags & EntryFlag.member) size += varTextSize(entry.member);
    if (flags & EntryFlag.memberCode) size += varUintSize(entry.memberCode ?? 0);
    if (flags & EntryFlag.requestId) size += varUintSize(entry.requestId);
    if (flags & EntryFlag.error) size += 2;
    if (flags & EntryFlag.meta) size += varTextSize(entry.metadata ?? "");
    if (flags & EntryFlag.extended) size += extendedSize(entry.extended);
    size += varUintSize(entry.elements.length);
    for (const element of entry.elements) size += this.measure(element);
    return selfCountedSize(size);
  }

  private writeEntry(out: ByteWriter, entry: MessageEntry, size: number): void {
    const flags = entry.flags ?? entryFlags(entry);
    out.varUint(size);
    out.u8(flags);
    out.u16(entry.type);
    if (flags & EntryFlag.path) out.varText(entry.path);
    if (flags & EntryFlag.pathCode) out.varUint(entry.pathCode ?? 0);
    if (flags & EntryFlag.member) out.varText(entry.member);
    if (flags & EntryFlag.memberCode) out.varUint(entry.memberCode ?? 0);
    if (flags & EntryFlag.requestId) out.varUint(entry.requestId);
    if (flags & EntryFlag.error) out.u16(entry.error);
    if (flags & EntryFlag.meta) out.varText(entry.metadata ?? "");
    if (flags & EntryFlag.extended) writeExtended(out, entry.extended);
    out.varUint(entry.elements.length);
    for (const element of entry.elements) this.write(out, element);
  }

  protected measure(element: MessageElement): number {
    const slot = this.sizes.push(0) - 1;
    const flags = element.flags ?? elementFlags(element);
    let size = 3;
    if (flags & ElementFlag.name) size += varTextSize(element.name ?? "");
    if (flags & ElementFlag.nameCode) size += varUintSize(element.nameCode ?? 0);
    if (flags & ElementFlag.number) size += varIntSize(element.number ?? 0);
    if (flags & ElementFlag.typeName) size += varTextSize(element.typeName);
    if (flags & ElementFlag.typeNameCode) size += varUintSize(element.typeNameCode ?? 0);
    if (flags & ElementFlag.meta) size += varTextSize(element.metadata ?? "");
    if (flags & ElementFlag.extended) size += extendedSize(element.extended);
    size += varUintSize(element.count) + this.payloadSize(element);
    return (this.sizes[slot] = selfCountedSize(size));
  }

  protected write(out: ByteWriter, element: MessageElement): void {
    const flags = element.flags ?? elementFlags(element);
    out.varUint(this.sizes[this.next++] ?? 0);
    out.u8(flags);
    if (flags & ElementFlag.name) out.varText(element.name ?? "");
    if (flags & ElementFlag.nameCode) out.varUint(element.nameCode ?? 0);
    if (flags & ElementFlag.number) out.varInt(element.number ?? 0);
    out.u16(element.type);
    if (flags & ElementFlag.typeName) out.varText(element.typeName);
    if (flags & ElementFlag.typeNameCode) out.varUint(element.typeNameCode ?? 0);
    if (flags & ElementFlag.meta) out.varText(element.metadata ?? "");
    if (flags & ElementFlag.extended) writeExtended(out, element.extended);
    out.varUint(element.count);
    this.writePayload(out, element);
  }
}

function extendedSize(extended: Uint8Array | undefined): number {
  const length = extended?.length ?? 0;
  return varUintSize(length) + length;
}

function writeExtended(out: ByteWriter, extended: Uint8Array | undefined): void {
  out.varUint(extended?.length ?? 0);
  out.bytes(extended ?? noBytes);
}
