// SPDX-License-Identifier: Apache-2.0
// From a URL to a session (04, section 8; 07, section 5).
import { isFairAnswer, offeredCodes, plainTerms, termsOf } from "../channel/capabilities.js";
import { Connection, type Incoming } from "../channel/connection.js";
import type { StreamOpener } from "../channel/stream.js";
import { ElementType } from "../codec/element_type.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import { EntryType } from "../entry_type.js";
import { ErrorCode, makeError, type RRError } from "../errors.js";
import type { ServiceModule } from "../module.js";
import { NodeId } from "../node_id.js";
import type { NodeSettings } from "../options.js";
import { errorOf } from "../remote_error.js";
import type { ServiceUrl } from "../url.js";
import { numbersElement, Packer, textElement } from "../value/pack.js";
import { readNumbers } from "../value/numbers.js";
import { findElement, optionalElement } from "../value/shapes.js";
import { Unpacker, textOf } from "../value/unpack.js";
import { makeType, stringType } from "../definition/types.js";
import { ClientSession } from "./session.js";

/** How to connect to a service. */
export interface ConnectOptions {
  /** Of a service that has users; then `credentials` usually holds `password`. */
  username?: string;
  /** Values, or VarValues, by their names. */
  credentials?: Readonly<Record<string, unknown>>;
  /** Qualified name of the type that the root object must have or implement. */
  objectType?: string;
  /** Ends connecting. A session that is there stays. */
  signal?: AbortSignal;
  /** Milliseconds for calls of this client, instead of the node's. */
  requestTimeout?: number;
  /** Of generated code: its exceptions become the classes that it declares. */
  modules?: readonly ServiceModule[];
}

/** A session that is connected, and what was learned. */
export interface Connected {
  session: ClientSession;
  rootType: string;
  attributes: Map<string, unknown>;
}

/** What peers take this implementation for when they choose object types (07, section 4). */
const clientVersion = "1.2.8";
const stringMap = makeType({ kind: "any" }, { kind: "scalar" }, "string");
const stringList = makeType(stringType.base, stringType.array, "list");

export async function connectSession(
  settings: NodeSettings,
  url: ServiceUrl,
  open: StreamOpener,
  options: ConnectOptions,
): Promise<Connected> {
  const waiting = new AbortController();
  const abort = (): void => {
    waiting.abort(options.signal?.reason);
  };
  options.signal?.addEventListener("abort", abort, { once: true });
  if (options.signal?.aborted) abort();
  const timer = setTimeout(() => {
    waiting.abort(makeError(ErrorCode.ConnectionError, `no connection to ${url.host} within ${settings.connectTimeout} ms`));
  }, settings.connectTimeout);
  const session = new ClientSession(settings);
  session.service = url.service;
  if (url.nodeId) session.wantedNode = url.nodeId.bytes.slice();
  if (options.requestTimeout !== undefined) session.requestTimeout = options.requestTimeout;
  for (const module of options.modules ?? []) module.declare(session.definitions, session.errorClasses);
  try {
    let stream;
    try {
      stream = await open(url, { signal: waiting.signal });
    } catch (error) {
      throw waiting.signal.aborted ? waiting.signal.reason : error;
    }
    await shakeHands(session, settings, url, (events) => new Connection(stream, settings, events, false), waiting.signal);
  } finally {
    clearTimeout(timer);
    options.signal?.removeEventListener("abort", abort);
  }
  try {
    const { connection } = session;
    const connected = connection.terms.combinedConnect
      ? await connectCombined(session, options)
      : await connectInSteps(session, options);
    connection.isAuthorized = true;
    checkRootType(session, connected.rootType, options.objectType);
    session.connected();
    return connected;
  } catch (error) {
    await session.giveUp();
    throw error;
  }
}

type MakeConnection = (events: { message: (message: Incoming) => void; closed: (reason: RRError) => void }) => Connection;

/** CreateConnection: who the other side is, and what it can do. */
function shakeHands(session: ClientSession, settings: NodeSettings, url: ServiceUrl, make: MakeConnection, signal: AbortSignal): Promise<void> {
  return new Promise((resolve, reject) => {
    const offered = offeredCodes(settings.clientOffer);
    let isDone = false;
    const abort = (): void => {
      connection.close("connecting was given up");
      reject(signal.reason as Error);
    };
    const connection = make({
      message: (message) => {
        if (isDone) {
          session.take(message);
          return;
        }
        const [entry] = message.entries;
        if (entry?.type !== EntryType.streamOpRet || entry.member !== "CreateConnection") return;
        isDone = true;
        signal.removeEventListener("abort", abort);
        try {
          acceptAnswer(connection, message, entry, url, offered);
          resolve();
        } catch (error) {
          reject(error);
          connection.close("the connection is not the one that was wanted");
        }
      },
      closed: (reason) => {
        signal.removeEventListener("abort", abort);
        reject(reason);
        session.lost(reason);
      },
    });
    session.connection = connection;
    if (signal.aborted) {
      abort();
      return;
    }
    signal.addEventListener("abort", abort, { once: true });
    const entry: MessageEntry = {
      type: EntryType.streamOp,
      path: "",
      member: "CreateConnection",
      requestId: 0,
      error: 0,
      elements: [numbersElement("capabilities", "uint32", offered)],
    };
    connection.send({
      entries: [entry],
      isHandshake: true,
      senderName: settings.name,
      receiverName: url.nodeName,
      receiverNode: (url.nodeId ?? NodeId.any).bytes,
    });
  });
}

function acceptAnswer(connection: Connection, message: Incoming, entry: MessageEntry, url: ServiceUrl, offered: readonly number[]): void {
  // A service that does not know the operation answers ProtocolError, and speaks format 2.
  if (entry.error !== 0 && entry.error !== ErrorCode.ProtocolError) throw errorOf(entry.error, entry.elements);
  const isNode = (!url.nodeId || NodeId.fromBytes(message.senderNode).equals(url.nodeId)) && (url.nodeName === "" || url.nodeName === message.senderName);
  if (!isNode) throw makeError(ErrorCode.ConnectionError, `another node answers: ${message.senderName.slice(0, 80)} ${NodeId.fromBytes(message.senderNode).toString()}`);
  connection.remoteNode = message.senderNode.slice();
  const element = entry.error === 0 ? optionalElement(entry.elements, "capabilities") : undefined;
  if (!element) {
    connection.terms = plainTerms;
    return;
  }
  const codes = element.type === ElementType.uint32 && element.data ? Array.from(readNumbers("uint32", element.data) as Uint32Array) : [];
  if (!isFairAnswer(offered, codes)) throw makeError(ErrorCode.ProtocolError, "the capabilities of the other side contradict themselves");
  connection.terms = termsOf(codes);
}

/** The node that requests outside of a session are for, as the URL says it. */
function special(session: ClientSession, type: number, elements: MessageElement[], onAnswer?: (answer: MessageEntry) => void): Promise<MessageEntry> {
  return session.request({ type, path: session.service, elements, ...(onAnswer ? { onAnswer } : {}) });
}

const version = (): MessageElement => textElement("clientversion", clientVersion);

async function connectCombined(session: ClientSession, options: ConnectOptions): Promise<Connected> {
  const elements = [version(), textElement("returnservicedefs", "true")];
  if (options.username) elements.push(...loginElements(session, options.username, options.credentials));
  const answer = await special(session, EntryType.connectClientCombined, elements);
  const definitions = optionalElement(answer.elements, "servicedefs");
  if (!definitions) throw makeError(ErrorCode.ServiceDefinitionError, "the service sent no definitions");
  for (const text of unpack(session, stringList, definitions) as string[]) addDefinition(session, text);
  return { session, rootType: textOf(findElement(answer.elements, "objecttype")), attributes: attributesIn(session, answer) };
}

async function connectInSteps(session: ClientSession, options: ConnectOptions): Promise<Connected> {
  const first = await special(session, EntryType.getServiceDesc, [version()]);
  const definition = addDefinition(session, textOf(findElement(first.elements, "servicedef")));
  const extra = optionalElement(first.elements, "extraimports");
  const wanted = extra ? (unpack(session, stringList, extra) as string[]) : [];
  await pullDefinitions(session, [...definition.imports, ...wanted]);
  const type = await special(session, EntryType.objectTypeName, [version()]);
  await special(session, EntryType.connectClient, []);
  session.connection.isAuthorized = true;
  if (options.username) await authenticate(session, options.username, options.credentials);
  return { session, rootType: textOf(findElement(type.elements, "objecttype")), attributes: attributesIn(session, first) };
}

/** Asks for definitions that are not known, and for what they import. */
export async function pullDefinitions(session: ClientSession, names: readonly string[]): Promise<void> {
  const wanted = new Set(names);
  // A set gives what is added to it while it is walked through.
  for (const name of wanted) {
    if (!session.definitions.has(name)) {
      const answer = await special(session, EntryType.getServiceDesc, [textElement("ServiceType", name), version()]);
      const added = addDefinition(session, textOf(findElement(answer.elements, "servicedef")));
      if (added.name !== name) throw makeError(ErrorCode.ServiceDefinitionError, `${added.name} came instead of the definition ${name}`);
    }
    for (const one of session.definitions.find(name)?.imports ?? []) wanted.add(one);
  }
}

function addDefinition(session: ClientSession, text: string): { name: string; imports: readonly string[] } {
  const { limits } = session.settings;
  const known = session.definitions.names();
  let size = text.length;
  for (const name of known) size += session.definitions.find(name)?.text.length ?? 0;
  if (text.length > limits.definitionSize || size > limits.definitionsSize || known.length >= limits.definitions) {
    throw makeError(ErrorCode.ServiceDefinitionError, "the service has too many definitions, or too long ones");
  }
  return session.definitions.add(text);
}

function unpack(session: ClientSession, type: Parameters<Unpacker["value"]>[0], element: MessageElement): unknown {
  return new Unpacker(session.definitions).value(type, element);
}

function attributesIn(session: ClientSession, answer: MessageEntry): Map<string, unknown> {
  const element = optionalElement(answer.elements, "attributes");
  return (element ? (unpack(session, stringMap, element) as Map<string, unknown> | null) : null) ?? new Map<string, unknown>();
}

function loginElements(session: ClientSession, username: string, credentials: Readonly<Record<string, unknown>> = {}): MessageElement[] {
  return [textElement("username", username), new Packer(session.definitions).value(stringMap, credentials, "credentials")];
}

/** Logs in a session that is connected. Rejects with AuthenticationError. */
export async function authenticate(session: ClientSession, username: string, credentials?: Readonly<Record<string, unknown>>): Promise<void> {
  await sessionOperation(session, session.service, "AuthenticateUser", loginElements(session, username, credentials));
}

/** An operation on a session, whose answer must be `OK` or one of the given words. */
export async function sessionOperation(session: ClientSession, path: string, member: string, elements: MessageElement[], words: readonly string[] = ["OK"], timeout = session.requestTimeout): Promise<string> {
  const answer = await session.request({ type: EntryType.clientSessionOp, path, member, elements, timeout });
  const found = optionalElement(answer.elements, "return");
  const word = found ? textOf(found) : "OK";
  if (!words.includes(word)) throw makeError(ErrorCode.ProtocolError, `${member} was answered with "${word.slice(0, 40)}"`);
  return word;
}

function checkRootType(session: ClientSession, type: string, wanted: string | undefined): void {
  if (wanted === undefined || wanted === "" || session.definitions.isKindOf(type, wanted)) return;
  throw makeError(ErrorCode.ServiceError, `the root object is a ${type.slice(0, 200)}, which is no ${wanted}`);
}

/** The type of the object at a path, as the service tells it; its definitions are known afterwards. */
export async function findObjectType(session: ClientSession, path: string): Promise<string> {
  const answer = await session.request({ type: EntryType.objectTypeName, path, elements: [version()] });
  const type = textOf(findElement(answer.elements, "objecttype"));
  if (!session.definitions.hasObject(type)) await pullDefinitions(session, [type.slice(0, Math.max(0, type.lastIndexOf(".")))]);
  return type;
}
