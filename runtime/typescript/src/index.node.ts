// SPDX-License-Identifier: Apache-2.0
/**
 * Robot Raconteur in TypeScript, on Node: clients over TCP and web sockets, and services.
 *
 * @packageDocumentation
 */
import { randomFillSync } from "node:crypto";
import { unref } from "./channel/connection.js";
import type { ByteStream } from "./channel/stream.js";
import { ErrorCode, makeError } from "./errors.js";
import { ClientNode, type NodeOptions } from "./node.js";
import { defaultWebSocketOptions, Listener, type WebSocketOptions } from "./node/listener.js";
import { openTcp } from "./node/tcp.js";
import { WebSocketFrames } from "./node/web_socket_frames.js";
import { openNodeWebSocket } from "./node/web_socket_client.js";
import { useRandomSource } from "./random.js";
import { LoginGuard } from "./service/login_guard.js";
import { ServedObject } from "./service/served_object.js";
import { ServerConnection } from "./service/server_connection.js";
import { Service, type ServiceOptions } from "./service/service.js";
import { indexName, makeIndex } from "./service/service_index.js";
import { Skeleton } from "./service/skeleton.js";

export * from "./common.js";
export type { WebSocketOptions } from "./node/listener.js";
export { Service, type ServiceOptions } from "./service/service.js";
export { PasswordUsers, type User, type Users } from "./service/users.js";

/** Where a node listens. */
export interface ListenOptions {
  /** 0, the default, for any free one. */
  port?: number;
  /** The address of the interface; this machine only when left out, `*` for all interfaces. */
  host?: string;
  /** Web sockets are taken on the same port. */
  webSocket?: Partial<WebSocketOptions>;
}

useRandomSource((array) => {
  randomFillSync(array);
});

const servicePattern = /^[a-zA-Z](?:[a-zA-Z0-9_]*[a-zA-Z0-9])?$/;
const tidyPeriod = 5_000;

/** A node: connects to services, and offers its own. */
export class RRNode extends ClientNode {
  private readonly offered = new Map<string, Service>();
  private readonly listeners = new Set<Listener>();
  private readonly connections = new Map<ServerConnection, { port: number; scheme: string; local: string }>();
  private readonly guard = new LoginGuard();
  private readonly housekeeping: ReturnType<typeof setInterval>;
  private readonly index: ServedObject;

  constructor(options: NodeOptions = {}) {
    super(options, { "rr+tcp": openTcp, "rr+ws": openNodeWebSocket, "rr+wss": openNodeWebSocket });
    this.index = makeIndex({
      id: this.id,
      services: () => this.services(),
      addressFor: (client) => this.addressFor(client),
    });
    this.register(indexName, this.index);
    this.housekeeping = setInterval(() => {
      for (const connection of this.connections.keys()) connection.tidy();
    }, tidyPeriod);
    unref(this.housekeeping);
  }

  /** Services, the newest first; the last is the index of services. */
  *services(): IterableIterator<Service> {
    yield* [...this.offered.values()].reverse();
  }

  /**
   * Offers a service. Its root is an object of generated code, or a {@link ServedObject}. Throws
   * InvalidArgument for a name that no service has, or that is taken.
   */
  registerService(name: string, root: Skeleton | ServedObject, options: ServiceOptions = {}): Service {
    if (!servicePattern.test(name) || this.offered.has(name)) {
      throw makeError(ErrorCode.InvalidArgument, `"${name.slice(0, 80)}" is no name for another service`);
    }
    const service = this.register(name, root instanceof Skeleton ? root.rr_served : root, options);
    this.index.event("LocalNodeServicesChanged").fire();
    return service;
  }

  private register(name: string, root: ServedObject, options: ServiceOptions = {}): Service {
    const service = new Service(name, root, options, this.settings, () => {
      this.offered.delete(name);
      if (name !== indexName) this.index.event("LocalNodeServicesChanged").fire();
    });
    this.offered.set(name, service);
    return service;
  }

  /** Listens for connections over TCP and web sockets; gives the port. */
  async listen({ port = 0, host = "127.0.0.1", webSocket }: ListenOptions = {}): Promise<number> {
    const { firstMessageTimeout, limits } = this.settings;
    const listener = await Listener.open(
      {
        port,
        ...(host === "*" ? {} : { host }),
        firstMessageTimeout,
        maxConnections: limits.connections,
        webSocket: { ...defaultWebSocketOptions, ...webSocket },
      },
      (stream) => {
        this.accept(stream, listener.port, host);
      },
    );
    this.listeners.add(listener);
    return listener.port;
  }

  private accept(stream: ByteStream, port: number, host: string): void {
    const scheme = stream instanceof WebSocketFrames ? "rr+ws" : "rr+tcp";
    const local = stream.localAddress ?? host;
    const connection = new ServerConnection(
      { settings: this.settings, guard: this.guard, service: (name) => this.offered.get(name), services: () => this.services() },
      stream,
      (one) => this.connections.delete(one),
    );
    if (!connection.connection.isClosed) this.connections.set(connection, { port, scheme, local });
  }

  private addressFor(client: number): string | undefined {
    for (const [{ session }, { port, scheme, local }] of this.connections) {
      if (session?.endpoint !== client) continue;
      const plain = local.startsWith("::ffff:") ? local.slice(7) : local;
      return `${scheme}://${plain.includes(":") ? `[${plain}]` : plain}:${port}`;
    }
    return undefined;
  }

  /** Closes all services, clients and ports. */
  override async close(): Promise<void> {
    clearInterval(this.housekeeping);
    for (const service of [...this.offered.values()]) service.close();
    await super.close();
    const closing = [...this.listeners].map((listener) => listener.close());
    for (const listener of this.listeners) listener.destroyAll();
    for (const { connection } of this.connections.keys()) connection.close("the node was closed");
    await Promise.all(closing);
  }
}
