// SPDX-License-Identifier: Apache-2.0
// A service's side of a session with a client: what each entry of it does (07).
import { randomUint32 } from "../random.js";
import type { Connection, Incoming } from "../channel/connection.js";
import { ElementType } from "../codec/element_type.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import { makeType, type Member, type MemberKind } from "../definition/types.js";
import { EntryType, isSpecialType } from "../entry_type.js";
import { ErrorCode, makeError, type RRError } from "../errors.js";
import { NodeId } from "../node_id.js";
import type { NodeSettings } from "../options.js";
import { errorElements, errorOf, sentError } from "../remote_error.js";
import { readNumber } from "../value/numbers.js";
import { numberElement, textElement } from "../value/pack.js";
import { checkType, findElement, optionalElement } from "../value/shapes.js";
import { textOf, Unpacker } from "../value/unpack.js";
import type { CallOptions } from "../client/session.js";
import { Generators } from "./generators.js";
import type { LoginGuard } from "./login_guard.js";
import type { Caller, ServedObject } from "./served_object.js";
import type { Service } from "./service.js";
import type { User } from "./users.js";
import { clientVersionOf } from "./version.js";

const stringMap = makeType({ kind: "any" }, { kind: "scalar" }, "string");

interface Packet {
  type: number;
  path: string;
  member: string;
  elements: MessageElement[];
  metadata?: string;
}

interface Pending {
  resolve(entry: MessageEntry): void;
  reject(error: Error): void;
}

interface Target {
  object: ServedObject;
  member: Member;
  path: string;
}

export class ServerSession {
  readonly endpoint: number;
  readonly generators: Generators;
  /** Users that have been logged in in this session. */
  readonly usernames = new Set<string>();
  private user: User | undefined;
  private messageId = 0;
  private lastRequest = 0;
  private atOnce = 0;
  private readonly pending = new Map<number, Pending>();
  private isAlive = true;

  constructor(
    readonly service: Service,
    private readonly connection: Connection,
    readonly clientEndpoint: number,
    private readonly clientNode: Uint8Array,
    private readonly guard: LoginGuard,
  ) {
    this.endpoint = randomEndpoint((number) => service.session(number) !== undefined);
    const { limits, generatorTimeout } = connection.settings;
    this.generators = new Generators(limits.generators, generatorTimeout);
  }

  get settings(): NodeSettings {
    return this.connection.settings;
  }

  get isOpen(): boolean {
    return this.isAlive && !this.connection.isClosed;
  }

  get isAuthenticated(): boolean {
    return !this.service.requiresUser || this.user !== undefined;
  }

  report(error: unknown): void {
    this.settings.log("error", `a handler failed: ${String(error)}`);
  }

  private get caller(): Caller {
    return { client: this.endpoint, username: this.user?.name ?? "" };
  }

  /** Sends what has no answer. What cannot be sent is logged. */
  packet(packet: Packet, isUnreliable = false): void {
    if (!this.isOpen) return;
    const { metadata, ...rest } = packet;
    const entry: MessageEntry = { ...rest, requestId: 0, error: 0, ...(metadata === undefined ? {} : { metadata }) };
    try {
      this.send([entry], isUnreliable ? "unreliable\n" : "");
    } catch (error) {
      this.settings.log("error", `${packet.path}.${packet.member} was not sent: ${String(error)}`);
    }
  }

  sendNewest(key: string, send: () => void): void {
    this.connection.sendNewest(key, send);
  }

  private send(entries: MessageEntry[], metadata = ""): void {
    const isSpecial = entries.length === 1 && isSpecialType(entries[0]?.type);
    // Of session messages the capability answer alone has the name, and in format 2 only.
    const isNamed = isSpecial || (entries.length === 1 && entries[0]?.type === EntryType.endpointCheckCapability + 1 && this.connection.terms.version === 2);
    this.connection.send({
      entries,
      sender: this.endpoint,
      receiver: this.clientEndpoint,
      ...(isNamed ? { senderName: this.settings.name } : {}),
      messageId: this.messageId,
      metadata,
    });
    // The reference answers the question for a type twice; the number of the second answer is left out.
    const isType = entries.length === 1 && entries[0]?.type === EntryType.objectTypeName + 1;
    this.messageId = (this.messageId + (isType ? 2 : 1)) & 0xffff;
  }

  /** Takes a message of the client. All its requests are answered in one message. */
  take(message: Incoming): void {
    const results = message.entries.map((entry) => this.entry(entry, message)).filter((one) => one !== undefined);
    if (results.length === 0) return;
    const { requestsAtOnce } = this.settings.limits;
    if (++this.atOnce >= requestsAtOnce) this.connection.pause();
    void Promise.all(results)
      .then((answers) => {
        this.answer(answers.filter((one) => one !== undefined));
      })
      .catch((error: unknown) => {
        this.report(error);
      })
      .finally(() => {
        if (this.atOnce-- === requestsAtOnce) this.connection.resume();
      });
  }

  private answer(entries: MessageEntry[]): void {
    if (entries.length === 0 || !this.isOpen) return;
    try {
      this.send(entries);
    } catch (error) {
      // Too large together, or alone.
      const [only] = entries;
      if (entries.length > 1) for (const one of entries) this.answer([one]);
      else if (only && only.error === 0) this.answer([failed(only, sentError(error))]);
    }
  }

  /** The answer to an entry, or nothing. */
  private entry(entry: MessageEntry, message: Incoming): Promise<MessageEntry | undefined> | undefined {
    const { type } = entry;
    if (type === EntryType.callbackCallRet) {
      this.settle(entry);
      return undefined;
    }
    if (type === EntryType.pipePacket || type === EntryType.wirePacket || type === EntryType.pipePacketRet) return this.takePacket(entry);
    if (entry.error === ErrorCode.InvalidEndpoint && type !== EntryType.generatorNext) {
      this.connection.close("the client does not know this session");
      return undefined;
    }
    // What has an even type is an answer, which has no answer.
    if (type % 2 === 0) return undefined;
    return this.respond(entry, message);
  }

  private async respond(entry: MessageEntry, message: Incoming): Promise<MessageEntry> {
    const answer: MessageEntry = { type: (entry.type + 1) & 0xffff, path: entry.path, member: entry.member, requestId: entry.requestId, error: 0, elements: [] };
    try {
      answer.elements = await this.request(entry, message);
      // Writes of memories are answered like reads (07, section 13).
      if (entry.type === EntryType.memoryWrite) answer.type = EntryType.memoryReadRet;
    } catch (error) {
      return failed(answer, sentError(error));
    }
    return answer;
  }

  private async request(entry: MessageEntry, message: Incoming): Promise<MessageElement[]> {
    switch (entry.type) {
      case EntryType.clientKeepAlive:
        return [];
      case EntryType.clientSessionOp:
        return await this.operation(entry, message);
      case EntryType.endpointCheckCapability:
      case EntryType.serviceCheckCapability:
        return [numberElement("return", "uint32", 0)];
      default:
    }
    if (!this.isAuthenticated) throw makeError(ErrorCode.AuthenticationError, "User is not authenticated");
    switch (entry.type) {
      case EntryType.objectTypeName: {
        const { object } = await this.service.find(entry.path);
        return this.service.typeElements(object, clientVersionOf(entry), false);
      }
      case EntryType.propertyGet:
      case EntryType.propertySet:
        return await this.property(entry);
      case EntryType.functionCall:
        return await this.call(entry);
      case EntryType.generatorNext:
        await this.allowed(entry);
        return await this.generators.next(entry);
      case EntryType.pipeConnect: {
        const { object, member } = await this.target(entry, "pipe");
        return object.pipe(member.name).connect(this, entry);
      }
      case EntryType.pipeDisconnect: {
        const { object, member } = await this.target(entry, "pipe");
        object.pipe(member.name).disconnect(this, entry);
        return [];
      }
      case EntryType.wireConnect:
      case EntryType.wireDisconnect:
      case EntryType.wirePeekIn:
      case EntryType.wirePeekOut:
      case EntryType.wirePokeOut:
        return await this.wire(entry);
      case EntryType.memoryRead:
      case EntryType.memoryWrite:
      case EntryType.memoryGetParam:
        return await this.memory(entry);
      default:
        throw makeError(ErrorCode.ProtocolError, "Unknown request type");
    }
  }

  /** The member that an entry is for, once locks allow it. */
  private async target(entry: MessageEntry, kind: MemberKind, isReading = false): Promise<Target> {
    const { object, path } = await this.service.find(entry.path);
    const found = object.type.members.get(entry.member);
    this.checkLocks(object, path, found, isReading);
    return { object, member: object.member(entry.member, kind), path };
  }

  private checkLocks(object: ServedObject, path: string, member: Member | undefined, isReading: boolean): void {
    this.service.locks.check(path, member, isReading, { client: this.endpoint, user: this.user });
    if (!member?.nolock && !(member?.nolockread && isReading)) this.service.monitors.check(object.handlers.monitor, this.endpoint);
  }

  private async allowed(entry: MessageEntry): Promise<void> {
    const { object, path } = await this.service.find(entry.path);
    this.checkLocks(object, path, object.type.members.get(entry.member), false);
  }

  private async property(entry: MessageEntry): Promise<MessageElement[]> {
    const isGet = entry.type === EntryType.propertyGet;
    const { object, member } = await this.target(entry, "property", isGet);
    const { handlers } = object;
    if (isGet) {
      if (member.isWriteonly) throw makeError(ErrorCode.WriteOnlyMember, "Write only property");
      if (!handlers.get) throw notImplemented(member);
      return [object.packer.value(member.type, await handlers.get(member.name, this.caller), "value")];
    }
    if (member.isReadonly) throw makeError(ErrorCode.ReadOnlyMember, "Read only property");
    if (!handlers.set) throw notImplemented(member);
    await handlers.set(member.name, object.unpacker.value(member.type, findElement(entry.elements, "value")), this.caller);
    return [];
  }

  private async call(entry: MessageEntry): Promise<MessageElement[]> {
    const { object, member, path } = await this.target(entry, "function");
    const { handlers } = object;
    const args = member.parameters.map(({ name, type }) => object.unpacker.value(type, findElement(entry.elements, name)));
    if (member.generator) {
      if (!handlers.generate) throw notImplemented(member);
      return this.generators.add(object, member, path, await handlers.generate(member.name, args, this.caller));
    }
    if (!handlers.call) throw notImplemented(member);
    const result = await handlers.call(member.name, args, this.caller);
    if (member.type.base.kind === "void") return [numberElement("return", "int32", 0)];
    return [object.packer.value(member.type, result, "return")];
  }

  private async wire(entry: MessageEntry): Promise<MessageElement[]> {
    const { object, member } = await this.target(entry, "wire");
    const wire = object.wire(member.name);
    switch (entry.type) {
      case EntryType.wireConnect:
        wire.connect(this, entry);
        return [];
      case EntryType.wireDisconnect:
        wire.disconnect(this, entry);
        return [];
      case EntryType.wirePeekIn:
        return await wire.answerPeekIn();
      case EntryType.wirePeekOut:
        return await wire.answerPeekOut();
      default:
        wire.poke(this, entry);
        return [];
    }
  }

  private async memory(entry: MessageEntry): Promise<MessageElement[]> {
    const { object, member } = await this.target(entry, "memory", entry.type !== EntryType.memoryWrite);
    const memory = object.memory(member.name);
    if (entry.type === EntryType.memoryRead) return memory.read(this, entry);
    return entry.type === EntryType.memoryWrite ? memory.write(entry) : memory.parameter(this, entry);
  }

  /** Packets are answered only where their member is not there. */
  private async takePacket(entry: MessageEntry): Promise<MessageEntry | undefined> {
    const kind = entry.type === EntryType.wirePacket ? "wire" : "pipe";
    try {
      if (!this.isAuthenticated) throw makeError(ErrorCode.AuthenticationError, "User is not authenticated");
      const { object } = await this.service.find(entry.path);
      object.member(entry.member, kind);
      if (kind === "wire") object.wire(entry.member).take(this, entry);
      else object.pipe(entry.member).take(this, entry);
    } catch (error) {
      if (entry.type % 2 === 1) {
        return failed({ type: entry.type + 1, path: entry.path, member: entry.member, requestId: entry.requestId, error: 0, elements: [] }, sentError(error));
      }
    }
    return undefined;
  }

  private async operation(entry: MessageEntry, message: Incoming): Promise<MessageElement[]> {
    const { service } = this;
    const ok = [textElement("return", "OK")];
    const access = { client: this.endpoint, user: this.user };
    const isMonitor = entry.member.startsWith("Monitor");
    if (!isMonitor && !service.users) throw makeError(ErrorCode.InvalidOperation, "Security not available for service");
    switch (entry.member) {
      case "AuthenticateUser":
        await this.login(entry, message.senderNode);
        return ok;
      case "LogoutUser":
        this.user = undefined;
        this.connection.isAuthorized = this.isAuthenticated;
        return ok;
      case "RequestObjectLock":
      case "RequestClientObjectLock":
      case "ReleaseObjectLock": {
        if (!this.user) throw makeError(ErrorCode.AuthenticationError, "User is not authenticated");
        const { path } = await service.find(entry.path);
        if (entry.member === "ReleaseObjectLock") service.locks.release(path, access);
        else service.locks.request(path, entry.member === "RequestClientObjectLock", access);
        return ok;
      }
      case "ReleaseClientObjectLock":
        throw makeError(ErrorCode.InvalidOperation, "Invalid command");
      case "MonitorEnter":
      case "MonitorContinueEnter":
      case "MonitorExit":
        return await this.monitor(entry);
      default:
        throw makeError(ErrorCode.ProtocolError, "Invalid ClientSessionOp command");
    }
  }

  private async monitor(entry: MessageEntry): Promise<MessageElement[]> {
    if (!this.isAuthenticated) throw makeError(ErrorCode.AuthenticationError, "User is not authenticated");
    const { monitors, locks } = this.service;
    const { object, path } = await this.service.find(entry.path);
    const { monitor } = object.handlers;
    let word: string | undefined;
    if (entry.member === "MonitorEnter") {
      locks.check(path, undefined, false, { client: this.endpoint, user: this.user });
      const timeout = findElement(entry.elements, "timeout");
      checkType(timeout, ElementType.int32, "timeout");
      if (timeout.count === 0 || !timeout.data) throw makeError(ErrorCode.OutOfRange, "timeout has no number");
      word = await monitors.enter(monitor, this.endpoint, readNumber("int32", timeout.data) as number);
    } else {
      word = entry.member === "MonitorExit" ? monitors.exit(monitor, this.endpoint) : await monitors.continueEnter(monitor, this.endpoint);
    }
    return word === undefined ? [] : [textElement("return", word)];
  }

  /** Logs in by `username` and `credentials` of an entry. Throws AuthenticationError. */
  async login(entry: MessageEntry, node: Uint8Array): Promise<void> {
    const { users, root } = this.service;
    const username = textOf(findElement(entry.elements, "username"));
    const credentials = findElement(entry.elements, "credentials");
    if (!users) throw makeError(ErrorCode.AuthenticationError, "Authentication Failed");
    const values = new Unpacker(root.definitions).value(stringMap, credentials) as Map<string, unknown> | null;
    this.user = await this.guard.attempt(this.connection, async () => await users.authenticate(username, values ?? new Map<string, unknown>(), NodeId.fromBytes(node)));
    this.usernames.add(this.user.name);
    this.connection.isAuthorized = true;
  }

  /** Calls a function of the client. */
  callBack(request: Packet & CallOptions): Promise<MessageEntry> {
    const { signal, timeout = this.settings.requestTimeout, ...rest } = request;
    if (!this.isOpen) return Promise.reject(makeError(ErrorCode.ConnectionError, "the client has gone"));
    return new Promise((resolve, reject) => {
      do {
        this.lastRequest = (this.lastRequest + 1) >>> 0;
      } while (this.pending.has(this.lastRequest));
      const requestId = this.lastRequest;
      const finish = (): void => {
        clearTimeout(timer);
        signal?.removeEventListener("abort", abort);
        this.pending.delete(requestId);
      };
      const fail = (error: Error): void => {
        finish();
        reject(error);
      };
      const timer = setTimeout(() => {
        fail(makeError(ErrorCode.RequestTimeout, `the client did not answer within ${timeout} ms`));
      }, Math.min(timeout, 0x7fffffff));
      const abort = (): void => {
        fail(signal?.reason as Error);
      };
      signal?.addEventListener("abort", abort, { once: true });
      this.pending.set(requestId, {
        resolve: (entry) => {
          finish();
          resolve(entry);
        },
        reject: fail,
      });
      try {
        this.send([{ ...rest, requestId, error: 0 }]);
      } catch (error) {
        fail(error as Error);
      }
    });
  }

  private settle(entry: MessageEntry): void {
    const pending = this.pending.get(entry.requestId);
    if (!pending) return;
    if (entry.error !== 0) pending.reject(errorOf(entry.error, entry.elements));
    else pending.resolve(entry);
  }

  /** Ends the session and its connection. */
  end(reason: string): void {
    this.left();
    this.connection.close(reason);
  }

  /** The client has gone. */
  left(): void {
    if (!this.isAlive) return;
    this.isAlive = false;
    for (const pending of [...this.pending.values()]) pending.reject(makeError(ErrorCode.ConnectionError, "the client has gone"));
    this.generators.clear();
    this.service.leave(this);
  }

  /** True when both are there, as a service with users needs them to connect. */
  static hasLogin(entry: MessageEntry): boolean {
    return optionalElement(entry.elements, "username") !== undefined && optionalElement(entry.elements, "credentials") !== undefined;
  }

  /** The node that connected. */
  get node(): Uint8Array {
    return this.clientNode;
  }
}

function failed(answer: MessageEntry, error: RRError): MessageEntry {
  return { ...answer, error: error.code, elements: errorElements(error) };
}

function notImplemented(member: Member): RRError {
  return makeError(ErrorCode.NotImplementedError, `${member.name} is not implemented`);
}

function randomEndpoint(isUsed: (number: number) => boolean): number {
  for (;;) {
    const number = randomUint32();
    if (number !== 0 && !isUsed(number)) return number;
  }
}
