// SPDX-License-Identifier: Apache-2.0
import { join } from "../codec/byte_writer.js";
import type { ByteStream } from "./stream.js";

/** A message of more bytes is sent at once. */
const largestGathered = 4 * 1024;
/** So many bytes are worth a system call of their own. */
const mostGathered = 32 * 1024;

/**
 * What a connection sends. Small messages of one turn of the event loop leave together, with one system call and as one
 * frame of a web socket: for a small message both cost more than everything else, and a page gets an event per frame.
 * The bytes and their order stay the same.
 */
export class GatheredSends {
  private gathered: Uint8Array[] = [];
  private size = 0;

  constructor(private readonly stream: ByteStream) {}

  /** Bytes that wait to be sent. */
  get waiting(): number {
    return this.stream.waiting + this.size;
  }

  /** `size`: bytes of all pieces. */
  send(pieces: readonly Uint8Array[], size: number): void {
    const only = pieces[0];
    // Pieces of a large message are views of arrays whose owner may change them afterwards.
    if (only === undefined || pieces.length > 1 || size > largestGathered) {
      this.flush();
      this.stream.send(pieces);
      return;
    }
    if (this.gathered.push(only) === 1) {
      queueMicrotask(() => {
        this.flush();
      });
    }
    this.size += size;
    if (this.size >= mostGathered) this.flush();
  }

  flush(): void {
    const { gathered } = this;
    if (gathered.length === 0) return;
    this.gathered = [];
    this.size = 0;
    this.stream.send([join(gathered)]);
  }
}
