// SPDX-License-Identifier: Apache-2.0
// A port that takes plain connections and web sockets (04, section 2).
import { createServer, type AddressInfo, type Server, type Socket } from "node:net";
import { webSocketProtocol } from "../channel/browser_web_socket.js";
import type { ByteStream } from "../channel/stream.js";
import { ErrorCode, makeError } from "../errors.js";
import { SocketStream } from "./tcp.js";
import { acceptKey, parseHead, readHead } from "./web_socket_client.js";
import { WebSocketFrames } from "./web_socket_frames.js";

/** Web sockets on the ports of TCP. */
export interface WebSocketOptions {
  /** Whether web sockets are taken. They are unless it is said. */
  isEnabled: boolean;
  /**
   * Origins of pages that may connect: `scheme://host[:port]`, `*.` before a host for those below it. Programs
   * that are no browsers send no origin, and are not asked for one.
   */
  origins: readonly string[];
  /** Pages without an origin may connect too: files that the user opens, but also any sandboxed frame. */
  allowLocalPages: boolean;
}

export const defaultWebSocketOptions: WebSocketOptions = {
  isEnabled: true,
  origins: ["https://robotraconteur.com", "https://*.robotraconteur.com"],
  allowLocalPages: false,
};

export interface ListenOptions {
  /** 0 for any free one. */
  port: number;
  /** The address of the interface; all of them when left out. */
  host?: string;
  firstMessageTimeout: number;
  maxConnections: number;
  webSocket: WebSocketOptions;
}

/** A port that listens. */
export class Listener {
  private readonly sockets = new Set<Socket>();

  private constructor(
    private readonly server: Server,
    private readonly options: ListenOptions,
    private readonly accept: (stream: ByteStream) => void,
  ) {}

  /** Throws IOError for a port that cannot be had. */
  static open(options: ListenOptions, accept: (stream: ByteStream) => void): Promise<Listener> {
    return new Promise((resolve, reject) => {
      const server = createServer({ noDelay: true, pauseOnConnect: true, allowHalfOpen: true });
      server.maxConnections = options.maxConnections;
      const listener = new Listener(server, options, accept);
      server.on("connection", (socket) => {
        void listener.begin(socket);
      });
      server.once("error", (error) => {
        reject(makeError(ErrorCode.IOError, error.message));
      });
      server.listen({ port: options.port, ...(options.host === undefined ? {} : { host: options.host }) }, () => {
        server.removeAllListeners("error");
        server.on("error", () => undefined);
        resolve(listener);
      });
    });
  }

  get port(): number {
    return (this.server.address() as AddressInfo | null)?.port ?? 0;
  }

  /** Connections that are open are not closed. */
  close(): Promise<void> {
    return new Promise((resolve) => {
      this.server.close(() => {
        resolve();
      });
    });
  }

  /** Ends what has not become a session. */
  destroyAll(): void {
    for (const socket of this.sockets) socket.destroy();
  }

  private async begin(socket: Socket): Promise<void> {
    this.sockets.add(socket);
    socket.on("error", () => undefined);
    socket.once("close", () => this.sockets.delete(socket));
    const waiting = AbortSignal.timeout(this.options.firstMessageTimeout);
    try {
      const first = await firstBytes(socket, waiting);
      const word = Buffer.from(first.subarray(0, 4)).toString("latin1");
      if (word === "RRAC") {
        this.accept(new SocketStream(socket, first));
      } else if (this.options.webSocket.isEnabled && (word === "GET " || word === "GET\t")) {
        const { head, rest } = await readHead(socket, first, waiting);
        const status = this.judge(head);
        if (status === undefined) {
          socket.write(acceptance(head));
          this.accept(new WebSocketFrames(new SocketStream(socket, rest), false));
        } else {
          socket.end(refusal(status));
        }
      } else if (this.options.webSocket.isEnabled) {
        socket.end("HTTP/1.1 404 File Not Found\r\n");
      } else {
        socket.destroy();
      }
    } catch {
      socket.destroy();
    }
  }

  /** Undefined for a handshake that is right, else the status that it is refused with (04, section 2.2). */
  private judge(head: string): string | undefined {
    const request = parseHead(head);
    const words = (request?.first ?? head.split("\r\n")[0] ?? "").split(" ").filter((word) => word !== "");
    const [method, target = "", version] = words;
    if (words.length !== 3) return "400 Bad Request";
    if (method !== "GET") return "404 File Not Found";
    if (version !== "HTTP/1.1") return "400 Bad Request";
    const [path, ...queries] = target.split("?");
    if ((path !== "/" && path !== "*") || queries.length > 1) return "404 File Not Found";
    if (!request) return "400 Bad Request";
    const { fields } = request;
    const list = (name: string): string[] => (fields.get(name) ?? "").split(",").map((one) => one.trim().toLowerCase());
    const isUpgrade =
      fields.get("upgrade")?.toLowerCase() === "websocket" && fields.has("sec-websocket-key") && list("sec-websocket-version").includes("13");
    if (!isUpgrade) return "426 Upgrade Required";
    if (fields.has("sec-websocket-protocol") && !list("sec-websocket-protocol").includes(webSocketProtocol)) return "426 Upgrade Required";
    const origin = fields.get("origin");
    if (origin !== undefined && !isAllowedOrigin(origin, this.options.webSocket)) return "403 Forbidden";
    return undefined;
  }
}

function firstBytes(socket: Socket, signal: AbortSignal): Promise<Uint8Array> {
  return new Promise((resolve, reject) => {
    let bytes: Buffer = Buffer.alloc(0);
    const stop = (): void => {
      socket.pause();
      socket.off("data", take);
      socket.off("end", fail);
      socket.off("close", fail);
      signal.removeEventListener("abort", fail);
    };
    const take = (data: Buffer): void => {
      bytes = bytes.length === 0 ? data : Buffer.concat([bytes, data]);
      if (bytes.length < 4) return;
      stop();
      resolve(bytes);
    };
    const fail = (): void => {
      stop();
      reject(new Error("nothing came"));
    };
    socket.on("data", take);
    socket.once("end", fail);
    socket.once("close", fail);
    signal.addEventListener("abort", fail, { once: true });
    socket.resume();
  });
}

function acceptance(head: string): string {
  const fields = parseHead(head)?.fields;
  const accept = acceptKey(fields?.get("sec-websocket-key") ?? "");
  return (
    `HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${accept}\r\n` +
    `Sec-WebSocket-Protocol: ${webSocketProtocol}\r\nSec-WebSocket-Version: 13\r\n\r\n`
  );
}

function refusal(status: string): string {
  return (
    `HTTP/1.1 ${status}\r\nUpgrade: websocket\r\nSec-WebSocket-Protocol: ${webSocketProtocol}\r\n` +
    "Sec-WebSocket-Version: 13\r\nConnection: close\r\nContent-Length: 0\r\n\r\n"
  );
}

/** Whether a page of this origin may connect. */
export function isAllowedOrigin(origin: string, options: WebSocketOptions): boolean {
  const lower = origin.toLowerCase();
  if (lower === "null" || lower.startsWith("file://")) return options.allowLocalPages;
  const match = /^([a-z][a-z0-9+.-]*):\/\/([^/:]*)(?::(\d+))?$/.exec(lower);
  if (!match) return false;
  const [, scheme = "", host = "", port] = match;
  const usual = scheme === "https" ? "443" : scheme === "http" ? "80" : "";
  return options.origins.some((allowed) => {
    const rule = /^([a-z][a-z0-9+.-]*):\/\/(\*\.)?([^/:]*)(?::(\d+))?$/.exec(allowed.toLowerCase());
    if (!rule || rule[1] !== scheme) return false;
    if (rule[3] === "") return true;
    const isHost = rule[2] ? host.endsWith(`.${rule[3] ?? ""}`) : host === rule[3];
    return isHost && (rule[4] ?? usual) === (port ?? usual);
  });
}
