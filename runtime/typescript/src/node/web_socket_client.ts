// SPDX-License-Identifier: Apache-2.0
// The client's side of a web socket handshake. Node has a web socket of its own from version 22 on only.
import { createHash, randomBytes } from "node:crypto";
import { connect as connectTls } from "node:tls";
import type { Socket } from "node:net";
import { webSocketProtocol } from "../channel/browser_web_socket.js";
import type { ByteStream, OpenOptions } from "../channel/stream.js";
import { ErrorCode, makeError } from "../errors.js";
import type { ServiceUrl } from "../url.js";
import { connectSocket, SocketStream } from "./tcp.js";
import { WebSocketFrames } from "./web_socket_frames.js";

const keySuffix = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
const headLimit = 8192;

/** The answer to a key of a handshake. */
export function acceptKey(key: string): string {
  return createHash("sha1").update(key + keySuffix).digest("base64");
}

/** Reads up to the blank line of an HTTP head; gives the head, and what came behind it. */
export function readHead(socket: Socket, begun: Uint8Array, signal: AbortSignal): Promise<{ head: string; rest: Uint8Array }> {
  return new Promise((resolve, reject) => {
    let bytes = Buffer.from(begun);
    const stop = (): void => {
      socket.pause();
      socket.off("data", take);
      socket.off("close", closed);
      signal.removeEventListener("abort", closed);
    };
    const look = (): boolean => {
      const end = bytes.indexOf("\r\n\r\n");
      if (end >= 0 && end <= headLimit) {
        stop();
        const rest = bytes.subarray(end + 4);
        resolve({ head: bytes.subarray(0, end).toString("latin1"), rest: Uint8Array.from(rest) });
        return true;
      }
      if (bytes.length <= headLimit) return false;
      stop();
      reject(makeError(ErrorCode.ConnectionError, "a web socket handshake is too long"));
      return true;
    };
    const take = (data: Buffer): void => {
      bytes = Buffer.concat([bytes, data]);
      look();
    };
    const closed = (): void => {
      stop();
      reject(makeError(ErrorCode.ConnectionError, "the connection ended during the web socket handshake"));
    };
    if (look()) return;
    socket.on("data", take);
    socket.once("close", closed);
    signal.addEventListener("abort", closed, { once: true });
    socket.resume();
  });
}

/** The lines of an HTTP head: the first one, and fields by their names in lower case. Undefined for a line without a colon. */
export function parseHead(head: string): { first: string; fields: Map<string, string> } | undefined {
  const [first = "", ...lines] = head.split("\r\n");
  const fields = new Map<string, string>();
  for (const line of lines) {
    const colon = line.indexOf(":");
    if (colon <= 0) return undefined;
    fields.set(line.slice(0, colon).trim().toLowerCase(), line.slice(colon + 1).trim());
  }
  return { first, fields };
}

/** Opens `rr+ws`, or `rr+wss` with the system's certificate authorities. */
export async function openNodeWebSocket(url: ServiceUrl, options: OpenOptions): Promise<ByteStream> {
  const plain = await connectSocket(url, options);
  const socket = url.scheme === "rr+wss" ? await secure(plain, url) : plain;
  const key = randomBytes(16).toString("base64");
  const host = url.host.includes(":") ? `[${url.host}]` : url.host;
  socket.on("error", () => undefined);
  socket.write(
    `GET ${url.path}${url.query} HTTP/1.1\r\nHost: ${host}:${url.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n` +
      `Sec-WebSocket-Key: ${key}\r\nSec-WebSocket-Protocol: ${webSocketProtocol}\r\nSec-WebSocket-Version: 13\r\n\r\n`,
  );
  try {
    const { head, rest } = await readHead(socket, new Uint8Array(0), options.signal);
    checkAnswer(head, key);
    return new WebSocketFrames(new SocketStream(socket, rest), true);
  } catch (error) {
    socket.destroy();
    throw error;
  }
}

function checkAnswer(head: string, key: string): void {
  const answer = parseHead(head);
  const field = (name: string): string => answer?.fields.get(name) ?? "";
  const [, status = ""] = (answer?.first ?? "").split(" ");
  const protocol = field("sec-websocket-protocol");
  const isRight =
    status === "101" &&
    field("upgrade").toLowerCase() === "websocket" &&
    field("connection").toLowerCase() === "upgrade" &&
    field("sec-websocket-accept") === acceptKey(key) &&
    (protocol === "" || protocol.toLowerCase() === webSocketProtocol);
  if (!isRight) {
    throw makeError(ErrorCode.ConnectionError, `the other side answered no web socket handshake: ${(answer?.first ?? "").slice(0, 80)}`);
  }
}

function secure(socket: Socket, url: ServiceUrl): Promise<Socket> {
  return new Promise((resolve, reject) => {
    const secured = connectTls({ socket, servername: url.host });
    secured.once("error", (error: Error) => {
      socket.destroy();
      reject(makeError(ErrorCode.ConnectionError, `${url.host}:${url.port}: ${error.message}`));
    });
    secured.once("secureConnect", () => {
      secured.removeAllListeners("error");
      resolve(secured);
    });
  });
}
