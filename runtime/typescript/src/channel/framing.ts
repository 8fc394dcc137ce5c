// SPDX-License-Identifier: Apache-2.0
// Cuts a stream of bytes into messages.
import { FormatError } from "../codec/format_error.js";
import { magic } from "../codec/message.js";
import { checkBegun } from "./begun_message.js";

/** What tells the size and version of a message. */
const headSize = 10;
const smallestMessage = 16;
const mostJoined = 64 * 1024;

/**
 * Collects bytes until a message is whole. A message that comes in one piece is given as a view of it, another
 * one is joined once. Nothing is reserved for bytes that have not come.
 */
export class Framing {
  private pieces: Uint8Array[] = [];
  private held = 0;
  /** Bytes of the message that has begun; 0 while its head is not there. */
  private wanted = 0;
  private isChecked = false;

  /** `limit` gives the largest message that is taken now. */
  constructor(private readonly limit: () => number) {}

  /** Bytes of a message that is not whole. */
  get waiting(): number {
    return this.held;
  }

  /** Bytes that the message that has begun will have; 0 when that is not known. */
  get expected(): number {
    return this.wanted;
  }

  /** Gives each message that becomes whole to `take`. Throws {@link FormatError}. */
  push(bytes: Uint8Array, take: (message: Uint8Array) => void): void {
    if (this.held === 0) {
      const rest = this.whole(bytes, take);
      if (rest.length > 0) this.keep(rest);
      return;
    }
    this.keep(bytes);
    this.look();
    if (this.wanted === 0 || this.held < this.wanted) return;
    const all = this.joined();
    this.pieces = [];
    this.held = 0;
    this.wanted = 0;
    this.isChecked = false;
    const rest = this.whole(all, take);
    if (rest.length > 0) this.keep(rest);
  }

  /** Gives the messages that are whole, and returns what is behind them. */
  private whole(bytes: Uint8Array, take: (message: Uint8Array) => void): Uint8Array {
    let rest = bytes;
    while (rest.length >= headSize) {
      const size = this.sizeOf(rest);
      if (rest.length < size) break;
      take(rest.subarray(0, size));
      rest = rest.subarray(size);
    }
    return rest;
  }

  private keep(bytes: Uint8Array): void {
    this.pieces.push(bytes);
    this.held += bytes.length;
    if (this.held === bytes.length) this.look();
  }

  /** Once its head is there: how long the message is, and whether what is there contradicts that. */
  private look(): void {
    if (this.held < headSize) return;
    this.wanted ||= this.sizeOf(this.joined());
    if (this.isChecked || this.held >= this.wanted) return;
    this.isChecked = checkBegun(this.held <= mostJoined ? this.joined() : (this.pieces[0] ?? new Uint8Array(0)), this.wanted);
    // What has grown so far without an answer is checked when it is whole.
    if (this.held > mostJoined) this.isChecked = true;
  }

  private joined(): Uint8Array {
    if (this.pieces.length > 1) {
      const all = new Uint8Array(this.held);
      let at = 0;
      for (const piece of this.pieces) {
        all.set(piece, at);
        at += piece.length;
      }
      this.pieces = [all];
    }
    return this.pieces[0] ?? new Uint8Array(0);
  }

  private sizeOf(bytes: Uint8Array): number {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (view.getUint32(0, true) !== magic) throw new FormatError("no message begins like this");
    const size = view.getUint32(4, true);
    if (size < smallestMessage || size > this.limit()) throw new FormatError(`a message of ${size} bytes is not taken`);
    const version = view.getUint16(8, true);
    if (version !== 2 && version !== 4) throw new FormatError(`message version ${version} is unknown`);
    return size;
  }
}
