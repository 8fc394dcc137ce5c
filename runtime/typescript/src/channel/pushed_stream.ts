// SPDX-License-Identifier: Apache-2.0
import type { ByteStream, StreamEvents } from "./stream.js";

/** A stream whose bytes come as events that nobody can hold back, as those of a page's web socket. */
export abstract class PushedStream implements ByteStream {
  protected isClosed = false;
  private events: StreamEvents | undefined;
  private early: Uint8Array[] = [];

  constructor(readonly remoteAddress: string) {}

  abstract get waiting(): number;
  abstract send(pieces: readonly Uint8Array[]): void;
  /** Gives back what is below. Called once. */
  protected abstract release(): void;

  start(events: StreamEvents): void {
    this.events = events;
    for (const bytes of this.early) events.data(bytes);
    this.early = [];
    if (this.isClosed) events.closed(undefined);
  }

  /** Has no effect: what comes cannot be held back. */
  pause(): void {
    return;
  }

  resume(): void {
    return;
  }

  close(): void {
    this.end(undefined);
  }

  destroy(): void {
    this.end(undefined);
  }

  /** Bytes have come. */
  protected push(bytes: Uint8Array): void {
    if (this.events) this.events.data(bytes);
    else this.early.push(bytes);
  }

  /** All that waited is sent. */
  protected drained(): void {
    if (!this.isClosed) this.events?.drained();
  }

  protected end(reason: Error | undefined): void {
    if (this.isClosed) return;
    this.isClosed = true;
    this.release();
    this.events?.closed(reason);
  }
}
