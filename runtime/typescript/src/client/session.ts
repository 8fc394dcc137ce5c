// SPDX-License-Identifier: Apache-2.0
// A client's side of a session with a service: requests, answers, and what comes by itself.
import { randomUint32 } from "../random.js";
import type { Connection, Incoming, Outgoing } from "../channel/connection.js";
import { unref } from "../channel/connection.js";
import type { MessageElement, MessageEntry } from "../codec/message.js";
import { Definitions } from "../definition/definitions.js";
import { EntryType, firstSessionType } from "../entry_type.js";
import { ErrorCode, makeError, type ErrorClass, type RRError } from "../errors.js";
import { Listeners } from "../listeners.js";
import type { NodeSettings } from "../options.js";
import { errorElements, errorOf, sentError } from "../remote_error.js";
import { textElement } from "../value/pack.js";

/** How long a call waits, and what ends it before. */
export interface CallOptions {
  /** Aborting ends the waiting; what the service does meanwhile it finishes. */
  signal?: AbortSignal;
  /** Milliseconds, instead of the client's or node's. */
  timeout?: number;
}

/** A request. */
export interface Request extends CallOptions {
  type: number;
  path: string;
  member?: string;
  elements?: MessageElement[];
  /** Generators are closed and aborted by requests with an error. */
  error?: number;
  /** Called with the answer before anything that came behind it is looked at. */
  onAnswer?: (answer: MessageEntry) => void;
}

interface Pending {
  type: number;
  settle(answer: MessageEntry): void;
  fail(error: Error): void;
}

/** What gets entries that come by themselves, for the object at a path. */
export interface EntrySink {
  take(entry: MessageEntry): void;
  ended(): void;
}

const disconnectPatience = 500;
const noLimit = Infinity;

export class ClientSession {
  readonly definitions = new Definitions();
  readonly errorClasses = new Map<string, ErrorClass>();
  /** What is at which path. */
  readonly sinks = new Map<string, EntrySink>();
  readonly closed: Listeners<[RRError]>;
  readonly pathReleased: Listeners<[string]>;
  readonly localEndpoint = randomEndpoint();
  requestTimeout: number;
  connection!: Connection;
  service = "";
  remoteName = "";
  /** The node of the URL, which requests are for until the service has answered one. */
  wantedNode = new Uint8Array(16);
  /** Whether a connect request was answered, be it with an error. */
  private isAnswered = false;
  private readonly pending = new Map<number, Pending>();
  private lastRequest = 0;
  private messageId = 0;
  private ending: RRError | undefined;
  private keepAlive: ReturnType<typeof setInterval> | undefined;

  constructor(readonly settings: NodeSettings) {
    this.requestTimeout = settings.requestTimeout;
    const report = (error: unknown): void => {
      this.report(error);
    };
    this.closed = new Listeners(report);
    this.pathReleased = new Listeners(report);
  }

  get isOpen(): boolean {
    return this.ending === undefined;
  }

  /** What a handler threw. */
  report(error: unknown): void {
    this.settings.log("error", `a handler failed: ${String(error)}`);
  }

  /** Sends a request, and gives its answer. Rejects with what the service answers instead. */
  request(request: Request): Promise<MessageEntry> {
    const { signal } = request;
    if (this.ending) return Promise.reject(closedError(this.ending));
    if (signal?.aborted) return Promise.reject(signal.reason as Error);
    return new Promise((resolve, reject) => {
      const id = this.nextRequest();
      const timeout = request.timeout ?? this.requestTimeout;
      const timer = timeout < noLimit ? setTimeout(expire, Math.min(timeout, 0x7fffffff)) : undefined;
      const finish = (): void => {
        clearTimeout(timer);
        signal?.removeEventListener("abort", abort);
        this.pending.delete(id);
      };
      const fail = (error: Error): void => {
        finish();
        reject(error);
      };
      function expire(): void {
        fail(makeError(ErrorCode.RequestTimeout, `no answer came within ${timeout} ms`));
      }
      function abort(): void {
        fail(signal?.reason as Error);
      }
      signal?.addEventListener("abort", abort, { once: true });
      const settle = (answer: MessageEntry): void => {
        finish();
        try {
          if (answer.error !== 0) throw errorOf(answer.error, answer.elements, this.errorClasses);
          request.onAnswer?.(answer);
          resolve(answer);
        } catch (error) {
          reject(error);
        }
      };
      this.pending.set(id, { type: request.type, settle, fail });
      try {
        this.send(entryOf(request, id));
      } catch (error) {
        fail(error as Error);
      }
    });
  }

  /** Sends a packet, which has no answer. */
  packet(entry: Omit<Request, "onAnswer" | keyof CallOptions> & { metadata?: string }, isUnreliable = false): void {
    if (this.ending) throw closedError(this.ending);
    const made = entryOf(entry, 0);
    if (entry.metadata !== undefined) made.metadata = entry.metadata;
    this.send(made, isUnreliable ? { metadata: "unreliable\n" } : {});
  }

  private send(entry: MessageEntry, more: Partial<Outgoing> = {}): void {
    const { connection } = this;
    const isSpecial = entry.type < firstSessionType;
    connection.send({
      entries: [entry],
      ...(this.isAnswered ? {} : { receiverNode: this.wantedNode }),
      sender: this.localEndpoint,
      receiver: connection.remoteEndpoint,
      ...(isSpecial ? { senderName: this.settings.name, receiverName: this.remoteName } : {}),
      messageId: this.messageId,
      ...more,
    });
    this.messageId = (this.messageId + 1) & 0xffff;
  }

  private nextRequest(): number {
    do {
      this.lastRequest = (this.lastRequest + 1) >>> 0;
    } while (this.pending.has(this.lastRequest));
    return this.lastRequest;
  }

  /** Takes a message of the connection. */
  take(message: Incoming): void {
    if (message.receiverEndpoint !== this.localEndpoint) return;
    if (this.connection.remoteEndpoint !== 0 && message.senderEndpoint !== this.connection.remoteEndpoint && !isSpecialAnswer(message)) return;
    for (const entry of message.entries) this.entry(entry, message);
  }

  private entry(entry: MessageEntry, message: Incoming): void {
    // Errors of packets come back as entries, too: they are nobody's.
    if (entry.type % 2 === 0 && entry.type !== EntryType.pipePacketRet) {
      this.answer(entry, message);
      return;
    }
    switch (entry.type) {
      case EntryType.serviceClosed:
        this.end(makeError(ErrorCode.ServiceNotFound, "the service was closed"));
        this.connection.close("the service was closed");
        return;
      case EntryType.servicePathReleased:
        this.released(entry.path);
        return;
      case EntryType.callbackCall:
        this.callback(entry);
        return;
      default:
        this.sinks.get(entry.path)?.take(entry);
    }
  }

  private answer(entry: MessageEntry, message: Incoming): void {
    const pending = this.pending.get(entry.requestId);
    if (!pending) return;
    const isRight = entry.type === pending.type + 1 || (pending.type === EntryType.memoryWrite && entry.type === EntryType.memoryReadRet);
    if (!isRight) return;
    if (entry.type === EntryType.connectClientRet || entry.type === EntryType.connectClientCombinedRet) {
      this.isAnswered = true;
      this.remoteName = message.senderName;
      this.connection.localEndpoint = this.localEndpoint;
      this.connection.remoteEndpoint = message.senderEndpoint;
      this.connection.remoteNode = message.senderNode.slice();
    }
    if (entry.error === ErrorCode.InvalidEndpoint) {
      pending.settle(entry);
      void this.close(makeError(ErrorCode.InvalidEndpoint, "the service does not know this session"));
      return;
    }
    pending.settle(entry);
  }

  private callback(entry: MessageEntry): void {
    const sink = this.sinks.get(entry.path);
    if (sink) sink.take(entry);
    else this.answerCallback(entry, Promise.reject(makeError(ErrorCode.ServiceError, `there is no reference to ${entry.path}`)));
  }

  /** Answers a callback once its result is there. */
  answerCallback(entry: MessageEntry, result: Promise<MessageElement>): void {
    const answer = (elements: MessageElement[], error: number): void => {
      if (!this.isOpen) return;
      const { path, member, requestId } = entry;
      try {
        this.send({ type: EntryType.callbackCallRet, path, member, requestId, error, elements });
      } catch (reason) {
        if (error !== 0) throw reason;
        const sent = sentError(reason);
        answer(errorElements(sent), sent.code);
      }
    };
    result.then(
      (element) => {
        answer([element], 0);
      },
      (error: unknown) => {
        const sent = sentError(error);
        answer(errorElements(sent), sent.code);
      },
    ).catch((error: unknown) => {
      this.report(error);
    });
  }

  private released(path: string): void {
    for (const [one, sink] of this.sinks) {
      if (one !== path && !one.startsWith(`${path}.`)) continue;
      this.sinks.delete(one);
      sink.ended();
    }
    this.pathReleased.call(path);
  }

  /** Begins to tell the service that this client is there while it has nothing to say. */
  connected(): void {
    const { keepAlivePeriod } = this.settings;
    this.keepAlive = setInterval(() => {
      if (!this.isOpen || Date.now() - this.connection.lastSentAt < keepAlivePeriod) return;
      try {
        this.send({ type: EntryType.clientKeepAlive, path: this.service, member: "", requestId: 0, error: 0, elements: [] });
      } catch (error) {
        this.report(error);
      }
    }, Math.max(100, keepAlivePeriod / 12));
    unref(this.keepAlive);
  }

  /** Tells the service, waits for its answer for half a second at most, and ends the session. */
  async close(reason = makeError(ErrorCode.OperationAborted, "the client was closed")): Promise<void> {
    if (this.ending) return;
    const { connection } = this;
    const told = this.disconnect();
    this.end(reason);
    await told;
    connection.close(reason.message);
  }

  /** As after a refused connect request: tells the service, and does not wait. */
  async giveUp(): Promise<void> {
    if (this.ending) return;
    void this.disconnect();
    this.end(makeError(ErrorCode.ConnectionError, "connecting failed"));
    this.connection.close("connecting failed");
    await Promise.resolve();
  }

  private disconnect(): Promise<void> {
    if (this.connection.isClosed) return Promise.resolve();
    const id = this.nextRequest();
    return new Promise((resolve) => {
      const timer = setTimeout(done, disconnectPatience);
      function done(): void {
        clearTimeout(timer);
        resolve();
      }
      this.pending.set(id, { type: EntryType.disconnectClient, settle: done, fail: done });
      this.farewell = id;
      try {
        this.send({ type: EntryType.disconnectClient, path: "", member: "", requestId: id, error: 0, elements: [textElement("servicename", this.service)] });
      } catch {
        done();
      }
    });
  }

  /** The request whose answer may still come when the session has ended. */
  private farewell = 0;

  /** Ends everything that waits, once. */
  end(reason: RRError): void {
    if (this.ending) return;
    this.ending = reason;
    clearInterval(this.keepAlive);
    const error = reason.code === ErrorCode.ConnectionError ? reason : makeError(ErrorCode.ConnectionError, reason.message);
    for (const [id, pending] of [...this.pending]) {
      if (id !== this.farewell || this.connection.isClosed) pending.fail(error);
    }
    const sinks = [...this.sinks.values()];
    this.sinks.clear();
    for (const sink of sinks) sink.ended();
    this.closed.call(reason);
  }

  /** The connection is gone. */
  lost(reason: RRError): void {
    this.end(reason);
    for (const pending of [...this.pending.values()]) pending.fail(reason);
  }
}

function entryOf(request: Omit<Request, "onAnswer">, requestId: number): MessageEntry {
  return {
    type: request.type,
    path: request.path,
    member: request.member ?? "",
    requestId,
    error: request.error ?? 0,
    elements: request.elements ?? [],
  };
}

function isSpecialAnswer(message: Incoming): boolean {
  return message.entries.every((entry) => entry.type < firstSessionType);
}

function randomEndpoint(): number {
  return randomUint32() || 1;
}

/** Why nothing can be asked any more. */
function closedError(reason: RRError): RRError {
  return reason.code === ErrorCode.ConnectionError ? reason : makeError(ErrorCode.InvalidOperation, `the session has ended: ${reason.message}`);
}
