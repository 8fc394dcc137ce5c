// SPDX-License-Identifier: Apache-2.0
// One connection of two nodes: messages over a stream, routing, connection tests.
import { FormatError } from "../codec/format_error.js";
import type { Message, MessageEntry } from "../codec/message.js";
import { readMessage } from "../codec/read_message.js";
import { useCodes } from "../codec/string_table.js";
import { sizeOf, writeMessage } from "../codec/write_message.js";
import { EntryType, isSpecialType } from "../entry_type.js";
import { ErrorCode, makeError, type RRError } from "../errors.js";
import type { NodeSettings } from "../options.js";
import { plainTerms, type Terms } from "./capabilities.js";
import { Framing } from "./framing.js";
import { GatheredSends } from "./gathered_sends.js";
import type { ByteStream } from "./stream.js";

/** What is to be sent. What is not said is left out, or zero. */
export interface Outgoing {
  entries: MessageEntry[];
  sender?: number;
  receiver?: number;
  senderName?: string;
  receiverName?: string;
  /** This node's and the other's unless said otherwise. */
  senderNode?: Uint8Array;
  receiverNode?: Uint8Array;
  metadata?: string;
  messageId?: number;
  /** The answer to a connection test has no routing in format 4. */
  withoutRouting?: boolean;
  /** Format 2 whatever was agreed. */
  isHandshake?: boolean;
}

/** An incoming message, with what format 4 leaves out filled in. */
export interface Incoming extends Message {
  senderNode: Uint8Array;
  receiverNode: Uint8Array;
  senderEndpoint: number;
  receiverEndpoint: number;
  senderName: string;
  receiverName: string;
}

export interface ConnectionEvents {
  /** Errors that it throws close the connection. */
  message(message: Incoming): void;
  closed(reason: RRError): void;
}

const sendMargin = 100;
const kibi64 = 64 * 1024;
/** So much may wait to be sent before values of which only the newest counts are kept back. */
const newestOnlyFrom = 256 * 1024;
const anyNode = new Uint8Array(16);

export class Connection {
  terms: Terms = plainTerms;
  /** Undefined until the other node has said who it is. */
  remoteNode: Uint8Array | undefined;
  localEndpoint = 0;
  remoteEndpoint = 0;
  /** Whether large messages are allowed. */
  isAuthorized = false;
  private readonly framing: Framing;
  private readonly sends: GatheredSends;
  private readonly ticks: ReturnType<typeof setInterval>;
  private readonly newest = new Map<string, () => void>();
  private lastSent: number;
  private lastReceived: number;
  private messageBegan = 0;
  private hasMessage = false;
  private isOpen = true;

  constructor(
    private readonly stream: ByteStream,
    readonly settings: NodeSettings,
    private readonly events: ConnectionEvents,
    private readonly isServer: boolean,
  ) {
    const { limits } = settings;
    this.framing = new Framing(() => (this.isAuthorized ? limits.messageSize : Math.min(limits.messageSize, limits.sizeBeforeSession)));
    this.sends = new GatheredSends(stream);
    this.lastSent = this.lastReceived = Date.now();
    const period = Math.max(10, Math.min(400, settings.heartbeatPeriod / 4));
    this.ticks = setInterval(() => {
      this.tick();
    }, period);
    unref(this.ticks);
    // What has come already is handled once the owner has the connection.
    queueMicrotask(() => {
      this.start();
    });
  }

  private start(): void {
    this.stream.start({
      data: (bytes) => {
        this.receive(bytes);
      },
      closed: (reason) => {
        this.end(reason?.message ?? "the connection was closed by the other side");
      },
      drained: () => {
        const waiting = [...this.newest.values()];
        this.newest.clear();
        for (const send of waiting) send();
      },
    });
  }

  get isClosed(): boolean {
    return !this.isOpen;
  }

  get remoteAddress(): string {
    return this.stream.remoteAddress;
  }

  /** Milliseconds since 1970 when something was sent or received last. */
  get lastSentAt(): number {
    return this.lastSent;
  }

  get lastReceivedAt(): number {
    return this.lastReceived;
  }

  pause(): void {
    this.stream.pause();
  }

  resume(): void {
    this.stream.resume();
  }

  /** Bytes that wait to be sent. */
  get waiting(): number {
    return this.sends.waiting;
  }

  /**
   * Sends a message. Throws ProtocolError for one that is too large, ConnectionError when the connection is
   * closed.
   */
  send(out: Outgoing): void {
    if (!this.isOpen) throw makeError(ErrorCode.ConnectionError, "the connection is closed");
    const { limits } = this.settings;
    const message = this.message(out);
    const codes = { standard: this.terms.standardCodes, local: this.terms.localCodes };
    const coded = message.version === 4 && (codes.standard || codes.local) ? useCodes(message, codes) : message;
    const pieces = writeMessage(coded);
    const size = sizeOf(pieces);
    const limit = this.isAuthorized ? limits.messageSize - sendMargin : Math.min(limits.sizeBeforeSession, limits.messageSize - sendMargin);
    if (size > limit) throw makeError(ErrorCode.ProtocolError, `a message of ${size} bytes is larger than the ${limit} that may be sent`);
    if (this.waiting + size > limits.sendQueue) {
      this.close("too much waits to be sent");
      throw makeError(ErrorCode.ConnectionError, "too much waits to be sent");
    }
    this.lastSent = Date.now();
    this.sends.send(pieces, size);
  }

  /** Sends now, or when the stream has room again; then only the newest of this key. */
  sendNewest(key: string, send: () => void): void {
    if (!this.isOpen) return;
    if (this.waiting < newestOnlyFrom) {
      this.newest.delete(key);
      send();
      return;
    }
    this.newest.set(key, () => {
      try {
        send();
      } catch (error) {
        this.settings.log("warning", `a value was not sent: ${String(error)}`);
      }
    });
  }

  /** Closes once everything is sent. */
  close(reason: string): void {
    if (!this.isOpen) return;
    this.sends.flush();
    this.stream.close();
    this.end(reason);
  }

  private end(reason: string): void {
    if (!this.isOpen) return;
    this.isOpen = false;
    clearInterval(this.ticks);
    this.newest.clear();
    this.events.closed(makeError(ErrorCode.ConnectionError, reason));
  }

  private message(out: Outgoing): Message {
    const senderNode = out.senderNode ?? this.settings.id.bytes;
    const receiverNode = out.receiverNode ?? this.remoteNode ?? anyNode;
    const { entries } = out;
    const version = out.isHandshake ? 2 : this.terms.version;
    const isSpecial = entries.length === 1 && isSpecialType(entries[0]?.type);
    const sender = out.sender ?? 0;
    const receiver = out.receiver ?? 0;
    const isKnown =
      version === 4 &&
      !isSpecial &&
      out.senderNode === undefined &&
      out.receiverNode === undefined &&
      this.remoteNode !== undefined &&
      this.remoteEndpoint !== 0 &&
      sender === this.localEndpoint &&
      receiver === this.remoteEndpoint;
    const message: Message = { version, entries, metadata: out.metadata ?? "", messageId: out.messageId ?? 0 };
    if (version === 4 && (isKnown || out.withoutRouting)) return message;
    message.senderNode = senderNode;
    message.receiverNode = receiverNode;
    message.senderName = out.senderName ?? "";
    message.receiverName = out.receiverName ?? "";
    message.senderEndpoint = sender;
    message.receiverEndpoint = receiver;
    return message;
  }

  private receive(bytes: Uint8Array): void {
    if (!this.isOpen) return;
    try {
      if (this.framing.waiting === 0) this.messageBegan = Date.now();
      this.framing.push(bytes, (message) => {
        if (!this.isOpen) return;
        this.lastReceived = this.messageBegan = Date.now();
        this.hasMessage = true;
        this.take(message);
      });
    } catch (error) {
      if (!(error instanceof FormatError)) this.settings.log("error", `while a message was handled: ${String(error)}`);
      this.close(error instanceof Error ? error.message : String(error));
    }
  }

  private take(bytes: Uint8Array): void {
    const { limits } = this.settings;
    const message = readMessage(bytes, {
      stringTable: this.terms.standardCodes,
      limits: { depth: limits.depth, elements: this.isAuthorized ? limits.elements : Math.min(limits.elementsBeforeSession, limits.elements) },
    });
    if (message.entries.length === 0) throw new FormatError("a message has no entries");
    const incoming: Incoming = {
      ...message,
      senderNode: message.senderNode ?? this.remoteNode ?? anyNode,
      receiverNode: message.receiverNode ?? this.settings.id.bytes,
      senderEndpoint: message.senderEndpoint ?? this.remoteEndpoint,
      receiverEndpoint: message.receiverEndpoint ?? this.localEndpoint,
      senderName: message.senderName ?? "",
      receiverName: message.receiverName ?? "",
    };
    const first = message.entries[0];
    if (message.entries.length === 1 && first) {
      if (first.type === EntryType.connectionTest) {
        this.answerTest(incoming, first);
        return;
      }
      if (first.type === EntryType.connectionTestRet) return;
    }
    this.events.message(incoming);
  }

  private answerTest(incoming: Incoming, test: MessageEntry): void {
    const { path, member, requestId } = test;
    this.send({
      entries: [{ type: EntryType.connectionTestRet, path, member, requestId, error: 0, elements: [] }],
      senderName: this.settings.name,
      receiverName: incoming.senderName,
      receiver: incoming.senderEndpoint,
      receiverNode: incoming.senderNode,
      withoutRouting: true,
    });
  }

  private tick(): void {
    const { heartbeatPeriod, receiveTimeout, messageTimeout, firstMessageTimeout } = this.settings;
    const now = Date.now();
    if (this.isServer && !this.hasMessage && now - this.messageBegan > firstMessageTimeout && now - this.lastReceived > firstMessageTimeout) {
      this.close("no message came");
      return;
    }
    if (this.framing.waiting > 0) {
      const allowed = messageTimeout + (1000 * this.framing.expected) / kibi64;
      if (now - this.messageBegan > allowed) {
        this.close("a message did not become whole");
        return;
      }
    }
    if (this.lastSent - this.lastReceived > receiveTimeout) {
      this.close("nothing came from the other side");
      return;
    }
    if (now - this.lastSent > heartbeatPeriod * (this.isServer ? 1.2 : 1)) this.sendTest();
  }

  private sendTest(): void {
    try {
      this.send({
        entries: [{ type: EntryType.connectionTest, path: "", member: "", requestId: 0, error: 0, elements: [] }],
        receiverNode: anyNode,
      });
    } catch {
      // The connection is closed, and whom it concerns was told.
    }
  }
}

/** A timer that does not keep a program alive; browsers have numbers instead. */
export function unref(timer: unknown): void {
  if (typeof timer === "object" && timer !== null && "unref" in timer && typeof timer.unref === "function") {
    (timer as { unref: () => void }).unref();
  }
}
