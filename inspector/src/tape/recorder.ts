// SPDX-License-Identifier: Apache-2.0
// Records what goes over the page's connections, as a file that `robdef inspect` and `robdef replay` read.
import { signal } from "@preact/signals";
import type { ByteStream, ServiceUrl, StreamEvents, StreamOpener } from "@robdef/runtime";
import { EntryType, type Message } from "@robdef/runtime/messages";
import { maskedLogin, MessageCutter, messageOf } from "./messages.js";
import { joined, RecordKind, tapeHeader, tapeRecord, tapeText, type Direction, type TapeRecord } from "./file.js";

/** Bytes that a recording has at most: it is kept in memory until it is saved. */
const mostBytes = 256 * 1024 * 1024;
const tapAtClient = 1;
const handshakeMessages = 4;

/** What is known of a connection, recorded or not. */
interface Known {
  readonly number: number;
  readonly url: string;
  agreed: Uint8Array | undefined;
  isClosed: boolean;
}

interface Running {
  readonly parts: Uint8Array[];
  readonly begin: number;
  readonly definitions: Set<string>;
  readonly opened: Set<number>;
  lost: number;
  lostBytes: number;
}

/** A tap on all connections of the page. */
export class Recorder {
  /** Bytes so far; undefined while nothing is recorded. */
  readonly size = signal<number | undefined>(undefined);
  readonly lost = signal(0);
  private readonly connections = new Map<number, Known>();
  private last = 0;
  private running: Running | undefined;

  /** An opener whose streams are looked at. */
  around(open: StreamOpener): StreamOpener {
    return async (url, options) => new TappedStream(await open(url, options), this.connection(url));
  }

  private connection(url: ServiceUrl): Tap {
    const known: Known = { number: ++this.last, url: url.text, agreed: undefined, isClosed: false };
    this.connections.set(known.number, known);
    let seen = 0;
    let clientNode: Uint8Array = new Uint8Array(16);
    let clientName = "";
    return {
      message: (bytes, direction) => {
        const isHandshake = !known.agreed && seen < handshakeMessages;
        if (!isHandshake && !this.running) return;
        ++seen;
        const message = messageOf(bytes);
        if (this.running) {
          this.open(known);
          this.add({ kind: RecordKind.message, direction, connection: known.number, body: message ? maskedLogin(message, bytes) : bytes.slice() });
        }
        if (!isHandshake || !message) return;
        const [entry] = message.entries;
        if (entry?.type === EntryType.streamOp && entry.member === "CreateConnection") {
          clientNode = message.senderNode?.slice() ?? clientNode;
          clientName = message.senderName ?? "";
        }
        if (entry?.type === EntryType.streamOpRet && entry.member === "CreateConnection") {
          known.agreed = agreedBody(message, clientNode, clientName);
          if (this.running) this.add({ kind: RecordKind.agreed, direction: undefined, connection: known.number, body: known.agreed });
        }
      },
      closed: (reason) => {
        known.isClosed = true;
        this.connections.delete(known.number);
        if (!this.running?.opened.has(known.number)) return;
        this.add({ kind: RecordKind.closed, direction: undefined, connection: known.number, body: joined([Uint8Array.of(reason === "" ? 0 : 1, 0), tapeText(reason)]) });
      },
    };
  }

  /** `opened`, and `agreed` where both sides agreed before the recording began. */
  private open(known: Known): void {
    const { running } = this;
    if (!running || running.opened.has(known.number)) return;
    running.opened.add(known.number);
    this.add({ kind: RecordKind.opened, direction: undefined, connection: known.number, body: joined([Uint8Array.of(tapAtClient), tapeText(known.url), tapeText("")]) });
    if (known.agreed) this.add({ kind: RecordKind.agreed, direction: undefined, connection: known.number, body: known.agreed });
  }

  private add(record: Omit<TapeRecord, "time">): void {
    const { running } = this;
    if (!running) return;
    const size = this.size.peek() ?? 0;
    if (size + record.body.length > mostBytes) {
      ++running.lost;
      running.lostBytes += record.body.length;
      this.lost.value = running.lost;
      return;
    }
    const time = BigInt(Math.round((performance.now() - running.begin) * 1e6));
    const bytes = tapeRecord({ ...record, time });
    running.parts.push(bytes);
    this.size.value = size + bytes.length;
  }

  /** Begins, with the definitions that are known. */
  start(definitions: Iterable<string>): void {
    if (this.running) return;
    const now = performance.now();
    const began = BigInt(Math.round((performance.timeOrigin + now) * 1000)) * 1000n;
    this.running = { parts: [tapeHeader(began)], begin: now, definitions: new Set(), opened: new Set(), lost: 0, lostBytes: 0 };
    this.size.value = 32;
    this.lost.value = 0;
    this.define(definitions);
    for (const known of this.connections.values()) this.open(known);
  }

  /** Definitions that came in the meantime; each is recorded once. */
  define(definitions: Iterable<string>): void {
    const { running } = this;
    if (!running) return;
    for (const text of definitions) {
      if (running.definitions.has(text)) continue;
      running.definitions.add(text);
      this.add({ kind: RecordKind.definition, direction: undefined, connection: 0, body: new TextEncoder().encode(text) });
    }
  }

  /** Ends, and gives the file; undefined when nothing was recorded. */
  stop(): Uint8Array<ArrayBuffer> | undefined {
    const { running } = this;
    if (!running) return undefined;
    const time = BigInt(Math.round((performance.now() - running.begin) * 1e6));
    if (running.lost > 0) {
      const body = new Uint8Array(16);
      const view = new DataView(body.buffer);
      view.setBigUint64(0, BigInt(running.lost), true);
      view.setBigUint64(8, BigInt(running.lostBytes), true);
      running.parts.push(tapeRecord({ kind: RecordKind.lost, direction: undefined, connection: 0, time, body }));
    }
    running.parts.push(tapeRecord({ kind: RecordKind.end, direction: undefined, connection: 0, time, body: new Uint8Array(0) }));
    this.running = undefined;
    this.size.value = undefined;
    return joined(running.parts);
  }
}

function agreedBody(answer: Message, clientNode: Uint8Array, clientName: string): Uint8Array {
  const [entry] = answer.entries;
  const data = entry?.error === 0 ? entry.elements.find((one) => one.name === "capabilities")?.data : undefined;
  const codes: number[] = [];
  if (data) {
    const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
    for (let at = 0; at + 4 <= data.length; at += 4) codes.push(view.getUint32(at, true));
  }
  // The page of a code is in its upper twelve bits: 2.0, 4.0, string tables of 4.
  const flags = (page: number): number => (codes.find((code) => (code & 0xfff00000) >>> 0 === page) ?? 0) & 0xfffff;
  const is4 = (flags(0x04000000) & 1) !== 0;
  const basic = is4 ? flags(0x04000000) : flags(0x02000000);
  const strings = is4 && (flags(0x04100000) & 1) !== 0 ? flags(0x04100000) : 0;
  const terms = ((basic & 2) !== 0 ? 1 : 0) | ((strings & 2) !== 0 ? 2 : 0) | ((strings & 4) !== 0 ? 4 : 0);
  return joined([Uint8Array.of(is4 ? 4 : 2, terms), clientNode, answer.senderNode?.slice() ?? new Uint8Array(16), tapeText(clientName), tapeText(answer.senderName ?? "")]);
}

interface Tap {
  message(bytes: Uint8Array, direction: Direction): void;
  closed(reason: string): void;
}

/** A stream that is passed on as it is. */
class TappedStream implements ByteStream {
  private readonly outgoing: MessageCutter;
  private readonly incoming: MessageCutter;

  constructor(
    private readonly stream: ByteStream,
    private readonly tap: Tap,
  ) {
    this.outgoing = new MessageCutter((message) => {
      tap.message(message, "service");
    });
    this.incoming = new MessageCutter((message) => {
      tap.message(message, "client");
    });
  }

  get waiting(): number {
    return this.stream.waiting;
  }

  get remoteAddress(): string {
    return this.stream.remoteAddress;
  }

  send(pieces: readonly Uint8Array[]): void {
    // Recorded before it leaves.
    for (const piece of pieces) this.outgoing.push(piece);
    this.stream.send(pieces);
  }

  start(events: StreamEvents): void {
    this.stream.start({
      data: (bytes) => {
        this.incoming.push(bytes);
        events.data(bytes);
      },
      closed: (reason) => {
        this.tap.closed(reason?.message ?? "");
        events.closed(reason);
      },
      drained: () => {
        events.drained();
      },
    });
  }

  close(): void {
    this.stream.close();
  }

  destroy(): void {
    this.stream.destroy();
  }

  pause(): void {
    this.stream.pause();
  }

  resume(): void {
    this.stream.resume();
  }
}
