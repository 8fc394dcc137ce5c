// SPDX-License-Identifier: Apache-2.0
import { FormatError } from "./format_error.js";
import { decodeText } from "./text.js";

/**
 * Reads little-endian fields from borrowed bytes. Each read checks that its field lies before the end,
 * and throws {@link FormatError} otherwise.
 */
export class ByteReader {
  readonly bytes: Uint8Array;
  position: number;
  private readonly view: DataView;
  private end: number;

  constructor(bytes: Uint8Array) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.position = 0;
    this.end = bytes.byteLength;
  }

  get remaining(): number {
    return this.end - this.position;
  }

  /**
   * Narrows the reader to the next `length` bytes, and gives the end to be restored by {@link leave}.
   */
  enter(length: number): number {
    if (length > this.remaining) throw new FormatError("a part is longer than what contains it");
    const outer = this.end;
    this.end = this.position + length;
    return outer;
  }

  /** Ends what {@link enter} began; everything must have been read. */
  leave(outer: number): void {
    if (this.position !== this.end) throw new FormatError("a part is longer than its fields");
    this.end = outer;
  }

  private take(length: number): number {
    const at = this.position;
    if (length > this.end - at) throw new FormatError("a field is longer than what contains it");
    this.position = at + length;
    return at;
  }

  u8(): number {
    return this.view.getUint8(this.take(1));
  }

  u16(): number {
    return this.view.getUint16(this.take(2), true);
  }

  u32(): number {
    return this.view.getUint32(this.take(4), true);
  }

  /** An unsigned number of one, three or five bytes (02, section 1.1). */
  varUint(): number {
    const first = this.u8();
    if (first < 0xfd) return first;
    if (first === 0xfd) return this.u16();
    if (first === 0xfe) return this.u32();
    throw new FormatError("a number has more than 32 bits");
  }

  /** A signed number of one, three or five bytes (02, section 1.2). */
  varInt(): number {
    const first = this.view.getInt8(this.take(1));
    if (first < 0x7d) return first;
    if (first === 0x7d) return this.view.getInt16(this.take(2), true);
    if (first === 0x7e) return this.view.getInt32(this.take(4), true);
    throw new FormatError("a number has more than 32 bits");
  }

  /** A view, not a copy. */
  part(length: number): Uint8Array {
    const at = this.take(length);
    return this.bytes.subarray(at, at + length);
  }

  text(length: number): string {
    return length === 0 ? "" : decodeText(this.part(length));
  }
}
