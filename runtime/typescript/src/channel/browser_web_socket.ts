// SPDX-License-Identifier: Apache-2.0
// Web sockets of the platform: browsers have them, and Node from 22 on.
import { join } from "../codec/byte_writer.js";
import { ErrorCode, makeError } from "../errors.js";
import type { ServiceUrl } from "../url.js";
import { PushedStream } from "./pushed_stream.js";
import type { ByteStream, OpenOptions } from "./stream.js";

/** The subprotocol of the handshake (04, section 2.2). */
export const webSocketProtocol = "robotraconteur.robotraconteur.com";

const largePiece = 64 * 1024;
const pollPeriod = 4;

/** The address of a web socket for a URL of a service. */
export function webSocketAddress(url: ServiceUrl): string {
  const host = url.host.includes(":") ? `[${url.host}]` : url.host;
  return `${url.scheme === "rr+wss" ? "wss" : "ws"}://${host}:${url.port}${url.path}${url.query}`;
}

/** What is needed of a platform's class WebSocket. */
export type WebSocketClass = new (url: string, protocols: string[]) => WebSocket;

/** Opens a web socket by the platform's class, or one that is given. */
export function openWebSocket(url: ServiceUrl, { signal }: OpenOptions, socketClass: WebSocketClass = WebSocket): Promise<ByteStream> {
  return new Promise((resolve, reject) => {
    const socket = new socketClass(webSocketAddress(url), [webSocketProtocol]);
    socket.binaryType = "arraybuffer";
    const abort = (): void => {
      socket.close();
      reject(makeError(ErrorCode.ConnectionError, `connecting to ${url.host}:${url.port} was given up`));
    };
    if (signal.aborted) {
      abort();
      return;
    }
    signal.addEventListener("abort", abort, { once: true });
    // Browsers do not tell why; that a page of https may not use ws is the reason that users can mend.
    socket.onerror = socket.onclose = () => {
      signal.removeEventListener("abort", abort);
      const isMixed = url.scheme === "rr+ws" && typeof location !== "undefined" && location.protocol === "https:";
      const hint = isMixed ? "; a page of https may use rr+wss only" : "";
      reject(makeError(ErrorCode.ConnectionError, `no web socket at ${url.host}:${url.port}${hint}`));
    };
    socket.onopen = () => {
      signal.removeEventListener("abort", abort);
      socket.onerror = socket.onclose = null;
      resolve(new WebSocketStream(socket, `${url.host}:${url.port}`));
    };
  });
}

class WebSocketStream extends PushedStream {
  private polling: ReturnType<typeof setInterval> | undefined;

  constructor(
    private readonly socket: WebSocket,
    remoteAddress: string,
  ) {
    super(remoteAddress);
    socket.onmessage = ({ data }: MessageEvent<unknown>) => {
      if (data instanceof ArrayBuffer) this.push(new Uint8Array(data));
      else this.end(new Error("a text came instead of bytes"));
    };
    socket.onclose = () => {
      this.end(undefined);
    };
    socket.onerror = () => {
      this.end(new Error("the web socket failed"));
    };
  }

  get waiting(): number {
    return this.socket.bufferedAmount;
  }

  send(pieces: readonly Uint8Array[]): void {
    if (this.isClosed) return;
    let small: Uint8Array[] = [];
    for (const piece of pieces) {
      if (piece.length < largePiece) {
        small.push(piece);
        continue;
      }
      if (small.length > 0) this.sendOne(join(small));
      small = [];
      this.sendOne(piece);
    }
    if (small.length > 0) this.sendOne(join(small));
    this.polling ??= setInterval(() => {
      this.poll();
    }, pollPeriod);
  }

  private sendOne(bytes: Uint8Array): void {
    this.socket.send(bytes as Uint8Array<ArrayBuffer>);
  }

  /** A web socket does not tell when its buffer is empty. */
  private poll(): void {
    if (this.socket.bufferedAmount > 0 && !this.isClosed) return;
    clearInterval(this.polling);
    this.polling = undefined;
    this.drained();
  }

  protected release(): void {
    clearInterval(this.polling);
    this.socket.onmessage = this.socket.onclose = this.socket.onerror = null;
    this.socket.close();
  }
}
