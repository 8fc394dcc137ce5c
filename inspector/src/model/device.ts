// SPDX-License-Identifier: Apache-2.0
// A connected service and its objects.
import { signal, type Signal } from "@preact/signals";
import { ErrorCode, RRError, type Client, type Definitions, type Member, type RemoteObject, type RRNode } from "@robdef/runtime";
import { errorText } from "./errors.js";
import type { Argument, History, Operation, OperationKind, PathStep } from "./history.js";
import { membersOf } from "./members.js";
import { valueText } from "./value_text.js";

export type DeviceState = "connecting" | "open" | "lost" | "closed";

/** What is known of locks that this session holds. */
export type LockState = "" | "user" | "session";

/** Indices that are looked for when an objref is opened. */
const probedIndices = 32;

/** One object in the tree. Its children are made when they are asked for. */
export class DeviceObject {
  readonly children = signal<readonly DeviceObject[]>([]);
  readonly lock = signal<LockState>("");
  private probed = new Set<string>();

  constructor(
    readonly device: Device,
    readonly remote: RemoteObject,
    readonly steps: readonly PathStep[],
  ) {}

  get path(): string {
    return this.remote.path;
  }

  get type(): string {
    return this.remote.type.name;
  }

  /** Members of this object, in the order of the definition. */
  get members(): Member[] {
    return membersOf(this.remote.type);
  }

  /** The name in the tree. */
  get title(): string {
    const last = this.steps.at(-1);
    return last ? (last.index === undefined ? last.objref : `${last.objref}[${last.index}]`) : this.device.title;
  }

  /** Gets the object of an objref; the same one is there once. */
  async open(objref: string, index?: number | string): Promise<DeviceObject> {
    const remote = await this.remote.object(objref, index);
    const known = this.children.value.find((one) => one.path === remote.path);
    if (known?.remote === remote) return known;
    const made = new DeviceObject(this.device, remote, [...this.steps, { objref, index }]);
    const others = this.children.value.filter((one) => one.path !== remote.path);
    this.children.value = [...others, made].sort((a, b) => a.path.localeCompare(b.path, undefined, { numeric: true }));
    return made;
  }

  /** Opens what an objref has: the object, or those of the first numbers while there are any. */
  async probe(member: Member): Promise<void> {
    if (member.index === "string" || this.probed.has(member.name)) return;
    this.probed.add(member.name);
    if (member.index === "none") {
      await this.open(member.name);
      return;
    }
    // Some count from 0, some from 1.
    for (let index = 0; index < probedIndices; ++index) {
      try {
        await this.open(member.name, index);
      } catch (error) {
        if (index > 0 || !(error instanceof RRError) || error.code === ErrorCode.ConnectionError) return;
      }
    }
  }

  /** Finds the object at a path below this one. */
  async follow(steps: readonly PathStep[]): Promise<DeviceObject> {
    const [next, ...rest] = steps;
    return next ? await (await this.open(next.objref, next.index)).follow(rest) : this;
  }

  /** Does something and writes it down. */
  async run<T>(kind: OperationKind, member: Member | undefined, args: readonly Argument[], action: () => Promise<T>, detail?: string): Promise<T> {
    return await this.device.record(
      { kind, url: this.device.url, rootType: this.device.root.value?.type ?? "", definitions: this.device.definitions, steps: this.steps, objectType: this.type, ...(member ? { member } : {}), args, ...(detail === undefined ? {} : { detail }) },
      action,
      member && (kind === "get" || kind === "call" || kind === "peek" || kind === "next") ? (value) => resultText(member, value) : undefined,
    );
  }

  async setLock(wanted: LockState): Promise<void> {
    const { client } = this.device;
    if (!client) return;
    if (wanted === "") {
      await this.run("unlock", undefined, [], () => client.unlock(this.remote));
    } else {
      await this.run("lock", undefined, [], () => client.lock(this.remote, wanted), wanted);
    }
    this.lock.value = wanted;
  }
}

function resultText(member: Member, value: unknown): string {
  const inner = typeof value === "object" && value !== null && "time" in value && "value" in value ? value.value : value;
  return valueText(member.type, inner, 300);
}

/** A service that was connected by a URL. */
export class Device {
  readonly state: Signal<DeviceState> = signal("connecting");
  readonly root = signal<DeviceObject | undefined>(undefined);
  readonly user = signal("");
  /** Why the connection ended, in words. */
  readonly ending = signal("");
  client: Client | undefined;
  private definitionsKnown: Definitions | undefined;

  constructor(
    readonly node: RRNode,
    readonly url: string,
    readonly history: History,
  ) {}

  get definitions(): Definitions {
    if (!this.definitionsKnown) throw new Error("not connected");
    return this.definitionsKnown;
  }

  /** The name of the service. */
  get title(): string {
    return decodeURIComponent(/[?&]service=([^&#]*)/.exec(this.url)?.[1] ?? this.url);
  }

  /** Connects, or connects again. */
  async connect(login?: { readonly user: string; readonly password: string }): Promise<void> {
    this.state.value = "connecting";
    this.ending.value = "";
    const operation: Operation = { kind: "connect", url: this.url, steps: [], objectType: "", args: [], ...(login ? { detail: login.user } : {}) };
    try {
      await this.record(operation, async () => {
        const client = await this.node.connect(this.url, login ? { username: login.user, credentials: { password: login.password } } : {});
        this.client = client;
        this.definitionsKnown = client.root.session.definitions;
        client.onClosed((reason) => {
          if (this.client !== client || this.state.value === "closed") return;
          this.state.value = "lost";
          this.ending.value = errorText(reason);
        });
        this.root.value = new DeviceObject(this, client.root, []);
        this.user.value = login?.user ?? "";
        this.state.value = "open";
      });
    } catch (error) {
      this.state.value = "lost";
      this.ending.value = errorText(error);
      throw error;
    }
  }

  async login(user: string, password: string): Promise<void> {
    const { client } = this;
    if (!client) return;
    await this.record({ kind: "login", url: this.url, steps: [], objectType: "", args: [], detail: user }, () => client.authenticate(user, { password }));
    this.user.value = user;
  }

  async logout(): Promise<void> {
    const { client } = this;
    if (!client) return;
    await this.record({ kind: "logout", url: this.url, steps: [], objectType: "", args: [] }, () => client.logout());
    this.user.value = "";
  }

  async close(): Promise<void> {
    this.state.value = "closed";
    await this.client?.close();
  }

  async record<T>(operation: Operation, action: () => Promise<T>, describe?: (value: T) => string): Promise<T> {
    const entry = this.history.begin(operation);
    const begin = performance.now();
    try {
      const value = await action();
      entry.outcome.value = { state: "done", text: describe ? describe(value) : "", took: performance.now() - begin };
      return value;
    } catch (error) {
      entry.outcome.value = { state: "failed", text: errorText(error), took: performance.now() - begin };
      throw error;
    }
  }
}
