// SPDX-License-Identifier: Apache-2.0
// A connection that a client has made: what is asked outside of a session, and how one begins (04; 07, section 4).
import { answeredCodes, streamCapability, termsOf } from "../channel/capabilities.js";
import { Connection, type Incoming } from "../channel/connection.js";
import type { ByteStream } from "../channel/stream.js";
import { ElementType } from "../codec/element_type.js";
import { FormatError } from "../codec/format_error.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import { EntryType, firstSessionType } from "../entry_type.js";
import { ErrorCode, makeError, RRError } from "../errors.js";
import type { NodeSettings } from "../options.js";
import { errorElements, sentError } from "../remote_error.js";
import { numberElement, numbersElement, textElement } from "../value/pack.js";
import { readNumbers } from "../value/numbers.js";
import { findElement, optionalElement } from "../value/shapes.js";
import { textOf } from "../value/unpack.js";
import type { LoginGuard } from "./login_guard.js";
import { ServerSession } from "./server_session.js";
import type { Service } from "./service.js";
import { clientVersionOf } from "./version.js";

/** What a connection needs of its node. */
export interface ServiceHost {
  readonly settings: NodeSettings;
  readonly guard: LoginGuard;
  service(name: string): Service | undefined;
  services(): Iterable<Service>;
}

const closeDelay = 100;
const mostSpecials = 16;

export class ServerConnection {
  readonly connection: Connection;
  session: ServerSession | undefined;
  private isConnecting = false;
  private isGone = false;

  constructor(
    private readonly host: ServiceHost,
    stream: ByteStream,
    private readonly gone: (connection: ServerConnection) => void,
  ) {
    this.connection = new Connection(
      stream,
      host.settings,
      {
        message: (message) => {
          this.take(message);
        },
        closed: () => {
          this.isGone = true;
          this.session?.left();
          this.gone(this);
        },
      },
      true,
    );
  }

  /** Closes a session whose client is silent, and drops generators that nobody uses. */
  tidy(): void {
    const { settings } = this.host;
    this.session?.generators.tidy();
    if (this.session && Date.now() - this.connection.lastReceivedAt > settings.clientTimeout) this.session.end("the client is silent");
  }

  private take(message: Incoming): void {
    const [first] = message.entries;
    if (!first) return;
    if (first.type === EntryType.streamOp && message.entries.length === 1) {
      this.streamOperation(message, first);
      return;
    }
    if (first.type === EntryType.streamCheckCapability && message.entries.length === 1) {
      const elements = [numberElement("return", "uint32", streamCapability(first.member))];
      const entry = { type: EntryType.streamCheckCapabilityRet, path: first.path, member: first.member, requestId: 0, error: 0, elements };
      this.connection.send({ entries: [entry], receiverNode: message.senderNode });
      return;
    }
    const isSpecial = first.type % 2 === 1 && first.type < firstSessionType && first.type !== EntryType.serviceClosed;
    const isOfSession = message.entries.length === 1 && first.type === EntryType.objectTypeName && message.receiverEndpoint !== 0;
    if (isSpecial && !isOfSession) {
      this.specials(message);
      return;
    }
    const { session, host } = this;
    if (!session || message.receiverEndpoint !== session.endpoint || !same(message.receiverNode, host.settings.id.bytes)) return;
    session.take(message);
  }

  private streamOperation(message: Incoming, entry: MessageEntry): void {
    const { settings } = this.host;
    const answer: MessageEntry = { type: EntryType.streamOpRet, path: "", member: entry.member, requestId: 0, error: 0, elements: [] };
    const isCreation = entry.member === "CreateConnection";
    try {
      if (isCreation) this.create(message, entry, answer);
      else if (entry.member === "STARTTLS") throw makeError(ErrorCode.ConnectionError, "Server certificate not loaded");
      else if (entry.member !== "GetRemoteNodeID") throw makeError(ErrorCode.ProtocolError, "Invalid Stream Operation");
    } catch (error) {
      if (error instanceof FormatError) throw error;
      const sent = sentError(error);
      answer.error = sent.code;
      answer.elements = [...answer.elements, ...errorElements(sent)];
    }
    this.connection.send({
      entries: [answer],
      isHandshake: isCreation,
      senderName: settings.name,
      receiverName: message.senderName,
      receiverNode: message.senderNode,
    });
  }

  private create(message: Incoming, entry: MessageEntry, answer: MessageEntry): void {
    const { connection, host } = this;
    const wanted = optionalElement(entry.elements, "capabilities");
    let codes: number[] | undefined;
    if (wanted) {
      if (wanted.type !== ElementType.uint32 || !wanted.data) throw makeError(ErrorCode.ProtocolError, "Invalid capabilities");
      codes = answeredCodes(Array.from(readNumbers("uint32", wanted.data) as Uint32Array), host.settings.serverOffer);
      if (!codes) throw makeError(ErrorCode.ProtocolError, "Invalid capabilities");
      answer.elements = [numbersElement("capabilities", "uint32", codes)];
    }
    const isSameClient = connection.remoteNode === undefined || same(connection.remoteNode, message.senderNode);
    if (!isSameClient || !this.isForUs(message)) throw makeError(ErrorCode.NodeNotFound, "Node not found");
    connection.remoteNode = message.senderNode.slice();
    if (codes) connection.terms = termsOf(codes);
  }

  private isForUs({ receiverNode, receiverName }: Incoming): boolean {
    const { id, name } = this.host.settings;
    const isOurs = same(receiverNode, id.bytes) || receiverNode.every((byte) => byte === 0);
    return isOurs && (receiverName === "" || receiverName === name);
  }

  /** Requests outside of a session. */
  private specials(message: Incoming): void {
    if (message.entries.length > mostSpecials) throw new FormatError("too many requests in one message");
    const { id, name } = this.host.settings;
    const isZero = message.receiverNode.every((byte) => byte === 0);
    const isRight = same(message.receiverNode, id.bytes) || (isZero && (message.receiverName === "" || message.receiverName === name));
    if (!isRight) {
      const error = makeError(ErrorCode.NodeNotFound, "Could not find route to remote node");
      this.connection.send({
        entries: message.entries.map((entry) => failed(answerTo(entry), error)),
        senderNode: message.receiverNode,
        senderName: message.receiverName,
        sender: message.receiverEndpoint,
        receiver: message.senderEndpoint,
        receiverNode: message.senderNode,
        receiverName: message.senderName,
      });
      return;
    }
    const [first, ...more] = message.entries;
    if (!first) return;
    const others = more.map((entry) => failed(answerTo(entry), makeError(ErrorCode.ProtocolError, "Unknown request type")));
    void this.special(first, message)
      .then((answer) => {
        this.sendSpecials([answer, ...others], message);
      })
      .catch((error: unknown) => {
        this.connection.close(String(error));
      });
  }

  private sendSpecials(entries: MessageEntry[], message: Incoming): void {
    if (this.connection.isClosed) return;
    const [first] = entries;
    const isConnect = first?.type === EntryType.connectClientRet || first?.type === EntryType.connectClientCombinedRet;
    const sender = isConnect ? this.newEndpoint : message.receiverEndpoint;
    const send = (list: MessageEntry[]): void => {
      this.connection.send({
        entries: list,
        senderName: this.host.settings.name,
        receiverName: message.senderName,
        receiverNode: message.senderNode,
        sender,
        receiver: message.senderEndpoint,
      });
    };
    try {
      send(entries);
    } catch (error) {
      if (!(error instanceof RRError) || !first) throw error;
      send([failed({ ...first, elements: [] }, error)]);
    }
  }

  /** The endpoint that the answer to a connect request tells. */
  private newEndpoint = 0;

  private async special(entry: MessageEntry, message: Incoming): Promise<MessageEntry> {
    const answer = answerTo(entry);
    try {
      answer.elements = await this.specialElements(entry, message);
    } catch (error) {
      if (error instanceof FormatError) throw error;
      return failed(answer, specialError(entry.type, error));
    }
    return answer;
  }

  private async specialElements(entry: MessageEntry, message: Incoming): Promise<MessageElement[]> {
    switch (entry.type) {
      case EntryType.getNodeInfo:
        return [];
      case EntryType.nodeCheckCapability:
        return [numberElement("return", "uint32", 0)];
      case EntryType.getServiceDesc:
        return this.description(entry);
      case EntryType.getServiceAttributes:
        return [this.find(entry.path).attributesElement("return")];
      case EntryType.objectTypeName: {
        const service = this.find(entry.path.split(".", 1)[0] ?? "");
        if (service.requiresUser && entry.path !== service.name) throw makeError(ErrorCode.ObjectNotFound, "Object not found");
        const { object } = await service.find(entry.path);
        return service.typeElements(object, clientVersionOf(entry), true);
      }
      case EntryType.connectClient:
      case EntryType.connectClientCombined:
        return await this.connect(entry, message);
      case EntryType.disconnectClient:
        return this.disconnect(entry);
      default:
        throw makeError(ErrorCode.ProtocolError, "Invalid Special Operation");
    }
  }

  private find(name: string): Service {
    const service = this.host.service(name);
    if (!service) throw makeError(ErrorCode.ServiceNotFound, "Service not found");
    return service;
  }

  private description(entry: MessageEntry): MessageElement[] {
    const wanted = optionalElement(entry.elements, "ServiceType") ?? optionalElement(entry.elements, "servicetype");
    if (wanted) {
      const name = textOf(wanted);
      for (const service of this.host.services()) {
        const found = service.root.definitions.find(name);
        if (found) return [textElement("servicedef", found.text)];
      }
      throw makeError(ErrorCode.ServiceNotFound, "Service not found");
    }
    const service = this.find(entry.path);
    const { definitions, type } = service.root;
    const text = definitions.find(type.name.slice(0, type.name.lastIndexOf(".")))?.text ?? "";
    return [service.attributesElement("attributes"), textElement("servicedef", text)];
  }

  private async connect(entry: MessageEntry, message: Incoming): Promise<MessageElement[]> {
    if (this.session || this.isConnecting) throw new FormatError("the connection has a session already");
    this.newEndpoint = 0;
    const service = this.find(entry.path);
    const { connection, host } = this;
    const isCombined = entry.type === EntryType.connectClientCombined;
    const type = isCombined ? service.typeElements(service.root, clientVersionOf(entry), true) : [];
    const session = new ServerSession(service, connection, message.senderEndpoint, message.senderNode.slice(), host.guard);
    this.isConnecting = true;
    this.newEndpoint = session.endpoint;
    service.join(session);
    try {
      if (isCombined) await login(service, session, entry, message);
    } catch (error) {
      session.left();
      throw error;
    } finally {
      this.isConnecting = false;
    }
    if (this.isGone) {
      session.left();
      return [];
    }
    this.session = session;
    connection.localEndpoint = session.endpoint;
    connection.remoteEndpoint = message.senderEndpoint;
    connection.remoteNode ??= message.senderNode.slice();
    connection.isAuthorized = session.isAuthenticated;
    if (!isCombined) return [];
    const elements = [...type];
    const returned = optionalElement(entry.elements, "returnservicedefs");
    const word = returned ? textOf(returned).toLowerCase() : "";
    if (returned && word !== "false" && word !== "0") elements.push(service.definitionsElement());
    elements.push(service.attributesElement("attributes"));
    return elements;
  }

  private disconnect(entry: MessageEntry): MessageElement[] {
    const { session, connection } = this;
    const name = textOf(findElement(entry.elements, "servicename"));
    if (session?.service.name !== name) throw makeError(ErrorCode.ServiceNotFound, "Service not found");
    session.left();
    setTimeout(() => {
      connection.close("the client has disconnected");
    }, closeDelay);
    return [];
  }
}

async function login(service: Service, session: ServerSession, entry: MessageEntry, message: Incoming): Promise<void> {
  const hasLogin = ServerSession.hasLogin(entry);
  if (service.requiresUser !== hasLogin) throw makeError(ErrorCode.AuthenticationError, "Authentication Failed");
  if (!hasLogin) return;
  try {
    await session.login(entry, message.senderNode);
  } catch {
    throw makeError(ErrorCode.AuthenticationError, "Authentication Failed");
  }
}

function answerTo({ type, path, member, requestId }: MessageEntry): MessageEntry {
  return { type: (type + 1) & 0xffff, path, member, requestId, error: 0, elements: [] };
}

function failed(answer: MessageEntry, error: RRError): MessageEntry {
  return { ...answer, error: error.code, elements: errorElements(error) };
}

/** Errors of special requests tell no details, and two of them have names of their own (07, section 4). */
function specialError(type: number, error: unknown): RRError {
  if (error instanceof RRError && (error.code === ErrorCode.AuthenticationError || error.code === ErrorCode.ProtocolError)) return error;
  switch (type) {
    case EntryType.objectTypeName:
      return new RRError(ErrorCode.ObjectNotFound, "Object not found", { errorName: "RobotRaconteur.ObjectNotFoundException" });
    case EntryType.getServiceAttributes:
      return makeError(ErrorCode.ServiceError, "Service not found");
    default:
      return new RRError(ErrorCode.ServiceNotFound, "Service not found", { errorName: "RobotRaconteur.ServiceNotFoundException" });
  }
}

function same(a: Uint8Array, b: Uint8Array): boolean {
  return a.length === b.length && a.every((byte, i) => byte === b[i]);
}
