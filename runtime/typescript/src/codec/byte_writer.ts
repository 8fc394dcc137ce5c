// SPDX-License-Identifier: Apache-2.0
import { encodeText, textLength } from "./text.js";

/** Payloads from this size are sent from where they are instead of being copied. */
const borrowedSize = 4096;

/**
 * Writes little-endian fields. What it gives is a list of pieces: small fields are gathered, large payloads
 * are views of the caller's arrays, which must not change until the pieces are sent.
 */
export class ByteWriter {
  private readonly pieces: Uint8Array[] = [];
  private buffer: Uint8Array;
  private view: DataView;
  private start = 0;
  private position = 0;

  constructor(sizeHint = 256) {
    this.buffer = new Uint8Array(sizeHint);
    this.view = new DataView(this.buffer.buffer);
  }

  private reserve(length: number): number {
    const at = this.position;
    if (at + length > this.buffer.length) {
      const kept = this.buffer.subarray(this.start, at);
      this.buffer = new Uint8Array(Math.max(2 * (kept.length + length), 256));
      this.buffer.set(kept);
      this.view = new DataView(this.buffer.buffer);
      this.start = 0;
      this.position = kept.length + length;
      return kept.length;
    }
    this.position = at + length;
    return at;
  }

  u8(value: number): void {
    const at = this.reserve(1);
    this.view.setUint8(at, value);
  }

  u16(value: number): void {
    const at = this.reserve(2);
    this.view.setUint16(at, value, true);
  }

  u32(value: number): void {
    const at = this.reserve(4);
    this.view.setUint32(at, value, true);
  }

  varUint(value: number): void {
    if (value < 0xfd) {
      this.u8(value);
    } else if (value < 0x10000) {
      this.u8(0xfd);
      this.u16(value);
    } else {
      this.u8(0xfe);
      this.u32(value);
    }
  }

  varInt(value: number): void {
    if (value >= -0x80 && value < 0x7d) {
      this.u8(value & 0xff);
    } else if (value >= -0x8000 && value < 0x8000) {
      this.u8(0x7d);
      this.u16(value & 0xffff);
    } else {
      this.u8(0x7e);
      this.u32(value >>> 0);
    }
  }

  bytes(data: Uint8Array): void {
    if (data.length >= borrowedSize) {
      this.flush();
      this.pieces.push(data);
      return;
    }
    const at = this.reserve(data.length);
    this.buffer.set(data, at);
  }

  /** The text alone, without its length. */
  text(text: string): void {
    for (let i = 0; i < text.length; ++i) {
      if (text.charCodeAt(i) > 0x7f) {
        this.bytes(encodeText(text));
        return;
      }
    }
    let at = this.reserve(text.length);
    for (let i = 0; i < text.length; ++i) this.buffer[at++] = text.charCodeAt(i);
  }

  /** A text behind its length in two bytes. */
  text16(text: string): void {
    this.u16(textLength(text));
    this.text(text);
  }

  /** A text behind its length in one, three or five bytes. */
  varText(text: string): void {
    this.varUint(textLength(text));
    this.text(text);
  }

  private flush(): void {
    if (this.position > this.start) this.pieces.push(this.buffer.subarray(this.start, this.position));
    this.start = this.position;
  }

  /** All pieces, in order. The writer is not to be used afterwards. */
  finish(): Uint8Array[] {
    this.flush();
    return this.pieces;
  }
}

/** The pieces as one array, which is a copy unless there is one piece. */
export function join(pieces: readonly Uint8Array[]): Uint8Array {
  if (pieces.length === 1 && pieces[0]) return pieces[0];
  const whole = new Uint8Array(pieces.reduce((size, piece) => size + piece.length, 0));
  let at = 0;
  for (const piece of pieces) {
    whole.set(piece, at);
    at += piece.length;
  }
  return whole;
}

/** Bytes of a number that {@link ByteWriter.varUint} writes. */
export function varUintSize(value: number): number {
  return value < 0xfd ? 1 : value < 0x10000 ? 3 : 5;
}

/** Bytes of a number that {@link ByteWriter.varInt} writes. */
export function varIntSize(value: number): number {
  if (value >= -0x80 && value < 0x7d) return 1;
  return value >= -0x8000 && value < 0x8000 ? 3 : 5;
}

/** Bytes of a text that {@link ByteWriter.varText} writes. */
export function varTextSize(text: string): number {
  const length = textLength(text);
  return varUintSize(length) + length;
}

/** Size of a unit that begins with its own size, of which all but that is `rest` bytes (02, section 1.3). */
export function selfCountedSize(rest: number): number {
  return rest < 252 ? rest + 1 : rest < 65533 ? rest + 3 : rest + 5;
}
