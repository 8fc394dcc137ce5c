// SPDX-License-Identifier: Apache-2.0
import type { StreamOpener } from "./channel/stream.js";
import { Client, rootOf, stubOf } from "./client/client.js";
import { connectSession, type ConnectOptions } from "./client/connect.js";
import type { RemoteObject } from "./client/remote_object.js";
import type { Stub, StubClass } from "./client/stub.js";
import { Subscription, type SubscribeOptions } from "./client/subscription.js";
import { ErrorCode, makeError } from "./errors.js";
import { NodeId } from "./node_id.js";
import { defaultLimits, defaultSettings, type Limits, type NodeSettings } from "./options.js";
import { isNodeName, parseUrl } from "./url.js";

/** How a node is made; see {@link NodeSettings} for what is not named here. */
export type NodeOptions = Partial<Omit<NodeSettings, "limits">> & {
  limits?: Partial<Limits>;
  /** Ways to other nodes by the schemes of URLs, besides those of the platform, or instead of them. */
  openers?: Readonly<Record<string, StreamOpener>>;
};

/** A node that connects to services. On Node, {@link "index.node".RRNode} also has services of its own. */
export class ClientNode {
  readonly settings: NodeSettings;
  private readonly openers: Map<string, StreamOpener>;
  private readonly subscriptions = new Set<Subscription<RemoteObject | Stub>>();
  private readonly clients = new Set<Client<RemoteObject | Stub>>();

  constructor(options: NodeOptions, openers: Readonly<Record<string, StreamOpener>>) {
    const { limits, openers: own, ...rest } = options;
    this.settings = { ...defaultSettings, id: NodeId.random(), ...rest, limits: { ...defaultLimits, ...limits } };
    if (this.settings.name !== "" && !isNodeName(this.settings.name)) {
      throw makeError(ErrorCode.InvalidArgument, `"${this.settings.name.slice(0, 80)}" is no name of a node`);
    }
    this.openers = new Map(Object.entries({ ...openers, ...own }));
  }

  get id(): NodeId {
    return this.settings.id;
  }

  get name(): string {
    return this.settings.name;
  }

  /** Connects to a service; its objects are used by the names of their members. */
  connect(url: string, options?: ConnectOptions): Promise<Client>;
  /** Connects to a service as a class of generated code. */
  connect<T extends Stub>(url: string, stub: StubClass<T>, options?: ConnectOptions): Promise<Client<T>>;
  async connect(url: string, first?: ConnectOptions | StubClass, second?: ConnectOptions): Promise<Client<RemoteObject | Stub>> {
    const stub = typeof first === "function" ? first : undefined;
    const given = (stub ? second : (first as ConnectOptions | undefined)) ?? {};
    const options: ConnectOptions = stub
      ? { ...given, objectType: given.objectType ?? stub.rr_type, modules: [...(given.modules ?? []), stub.rr_module] }
      : given;
    const where = parseUrl(url);
    const open = this.openers.get(where.scheme);
    if (!open) throw makeError(ErrorCode.ConnectionError, `this platform has no way to ${where.scheme}`);
    const connected = await connectSession(this.settings, where, open, options);
    const root = rootOf(connected);
    const client: Client<RemoteObject | Stub> = new Client(connected, stub ? stubOf(root, stub) : root);
    this.clients.add(client);
    client.onClosed(() => {
      this.clients.delete(client);
    });
    return client;
  }

  /** Connects to a service for as long as the subscription is open, and again whenever the connection is lost. */
  subscribe(url: string, options?: ConnectOptions & SubscribeOptions): Subscription;
  subscribe<T extends Stub>(url: string, stub: StubClass<T>, options?: ConnectOptions & SubscribeOptions): Subscription<T>;
  subscribe(url: string, first?: (ConnectOptions & SubscribeOptions) | StubClass, second?: ConnectOptions & SubscribeOptions): unknown {
    const stub = typeof first === "function" ? first : undefined;
    const options = (stub ? second : (first as (ConnectOptions & SubscribeOptions) | undefined)) ?? {};
    const made = new Subscription<RemoteObject | Stub>(
      (signal) => (stub ? this.connect(url, stub, { ...options, signal }) : this.connect(url, { ...options, signal })),
      options,
      (error) => {
        this.settings.log("error", `a handler failed: ${String(error)}`);
      },
    );
    this.subscriptions.add(made);
    return made;
  }

  /** Closes all subscriptions and clients. */
  async close(): Promise<void> {
    await Promise.all([...this.subscriptions].map((one) => one.close()));
    await Promise.all([...this.clients].map((client) => client.close()));
  }
}
