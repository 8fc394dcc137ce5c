// SPDX-License-Identifier: Apache-2.0
// Streams over TCP sockets of Node.
import { connect, type Socket } from "node:net";
import type { ByteStream, OpenOptions, StreamEvents } from "../channel/stream.js";
import { ErrorCode, makeError } from "../errors.js";
import type { ServiceUrl } from "../url.js";

/** A connected socket to the host and port of a URL. Throws ConnectionError. */
export function connectSocket(url: ServiceUrl, { signal }: OpenOptions): Promise<Socket> {
  return new Promise((resolve, reject) => {
    const socket = connect({ host: url.host, port: url.port, noDelay: true });
    const fail = (reason: string): void => {
      signal.removeEventListener("abort", abort);
      socket.destroy();
      reject(makeError(ErrorCode.ConnectionError, `${url.host}:${url.port}: ${reason}`));
    };
    const abort = (): void => {
      fail("connecting was given up");
    };
    socket.once("error", (error) => {
      fail(error.message);
    });
    if (signal.aborted) {
      abort();
      return;
    }
    signal.addEventListener("abort", abort, { once: true });
    socket.once("connect", () => {
      signal.removeEventListener("abort", abort);
      socket.removeAllListeners("error");
      resolve(socket);
    });
  });
}

export async function openTcp(url: ServiceUrl, options: OpenOptions): Promise<ByteStream> {
  return new SocketStream(await connectSocket(url, options));
}

/** A socket as a stream of bytes. */
export class SocketStream implements ByteStream {
  readonly remoteAddress: string;
  readonly localAddress: string;
  private events: StreamEvents | undefined;
  private reason: Error | undefined;

  /** `early` is what was read from the socket already. */
  constructor(
    private readonly socket: Socket,
    private early: Uint8Array = new Uint8Array(0),
  ) {
    this.remoteAddress = socket.remoteAddress ?? "";
    this.localAddress = socket.localAddress ?? "";
    socket.pause();
    socket.on("error", (error) => {
      this.reason = error;
    });
  }

  get waiting(): number {
    return this.socket.writableLength;
  }

  start(events: StreamEvents): void {
    this.events = events;
    const { socket } = this;
    socket.on("data", (bytes) => {
      events.data(new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.length));
    });
    socket.on("drain", () => {
      events.drained();
    });
    // The other side ends; so do we, once everything is sent.
    socket.on("end", () => {
      socket.end();
    });
    socket.on("close", () => {
      events.closed(this.reason);
    });
    if (this.early.length > 0) {
      // Bytes as they are: what a Buffer does otherwise than other arrays is of no use here.
      const { buffer, byteOffset, length } = this.early;
      this.early = new Uint8Array(0);
      events.data(new Uint8Array(buffer, byteOffset, length));
    }
    if (socket.destroyed) events.closed(this.reason);
    else socket.resume();
  }

  send(pieces: readonly Uint8Array[]): void {
    const { socket } = this;
    if (!socket.writable) return;
    socket.cork();
    for (const piece of pieces) socket.write(piece);
    socket.uncork();
  }

  pause(): void {
    if (this.events) this.socket.pause();
  }

  resume(): void {
    if (this.events) this.socket.resume();
  }

  close(): void {
    this.socket.end();
    // Who does not read has no right to keep a socket.
    this.socket.setTimeout(5000, () => {
      this.socket.destroy();
    });
  }

  destroy(): void {
    this.socket.destroy();
  }
}
