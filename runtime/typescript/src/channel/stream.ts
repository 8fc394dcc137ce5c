// SPDX-License-Identifier: Apache-2.0
import type { ServiceUrl } from "../url.js";

/** A stream of bytes between two nodes: a socket, or a web socket whose frames mean nothing. */
export interface ByteStream {
  /** Takes the pieces in order. Large ones must not change until they are sent. */
  send(pieces: readonly Uint8Array[]): void;
  /** Bytes that were given to {@link send} and are not sent yet. */
  readonly waiting: number;
  /** Ends the stream once everything is sent. Harmless when it has ended. */
  close(): void;
  /** Ends the stream at once. */
  destroy(): void;
  /** Stops and goes on reading, as far as the stream can. */
  pause(): void;
  /** Goes on reading after {@link pause}. */
  resume(): void;
  /** Starts to read. Before that nothing is delivered. */
  start(events: StreamEvents): void;
  /** Where the other side is, for messages; empty when that is not known. */
  readonly remoteAddress: string;
  /** The address of this machine that the other side connected to, where that is known. */
  readonly localAddress?: string;
}

/** What a stream tells its user. */
export interface StreamEvents {
  /** The bytes may be kept, and are not changed afterwards. */
  data(bytes: Uint8Array): void;
  /** Called once, also after {@link ByteStream.close}; nothing comes afterwards. */
  closed(reason: Error | undefined): void;
  /** All that waited is sent. */
  drained(): void;
}

/** How a stream is opened. */
export interface OpenOptions {
  /** Ends the attempt. */
  signal: AbortSignal;
}

/** Opens a stream to the host and port of a URL. */
export type StreamOpener = (url: ServiceUrl, options: OpenOptions) => Promise<ByteStream>;
