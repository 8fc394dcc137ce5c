// SPDX-License-Identifier: Apache-2.0
// A recording as values over time: what each member was at any moment.
import { Definitions, millisecondsOf, type Member, type ValueType } from "@robdef/runtime";
import { EntryType, errorOf, findElement, optionalElement, readMessage, timeOf, Unpacker, type Message, type MessageElement, type MessageEntry } from "@robdef/runtime/messages";
import { errorText } from "../model/errors.js";
import { BodyReader, readTape, RecordKind, type Direction, type TapeFile, type TapeRecord } from "./file.js";

/** Something that happened to a member, or a message that stands for itself. */
export interface TapeEvent {
  /** Seconds since the recording began. */
  readonly time: number;
  readonly connection: number;
  readonly direction: Direction;
  /** As `get`, `call`, `wire`, `event`. */
  readonly what: string;
  readonly path: string;
  readonly member: string;
  readonly error: string;
  readonly record: number;
  readonly entry: number;
  /** Which element is the value: a pipe's packets come several in an entry. */
  readonly element: number;
}

/** Values of one member in one direction, over time. */
export interface Track {
  readonly key: string;
  readonly connection: number;
  readonly path: string;
  readonly member: string;
  readonly what: "property" | "wire" | "wire out" | "pipe" | "pipe out" | "event" | "result";
  readonly declared: Member | undefined;
  /** Of the values; undefined when it is not known. */
  readonly type: ValueType | undefined;
  readonly events: TapeEvent[];
}

export interface TapeConnection {
  readonly number: number;
  readonly url: string;
  service: string;
  rootType: string;
  /** Types of objects by their paths, as the service told them. */
  readonly types: Map<string, string>;
  agreed: string;
  closing: string;
}

interface Request {
  readonly what: string;
  readonly path: string;
  readonly member: string;
  readonly type: number;
}

const recordsAtOnce = 5000;

/** A recording that was read. */
export class Tape {
  readonly tracks: Track[] = [];
  readonly events: TapeEvent[] = [];
  readonly connections = new Map<number, TapeConnection>();
  readonly definitions = new Definitions();
  /** Why messages or definitions could not be read, each once. */
  readonly problems = new Set<string>();
  /** Seconds. */
  duration = 0;
  messages = 0;
  lost = 0;
  private readonly byKey = new Map<string, Track>();
  private readonly requests = new Map<string, Request>();
  private cached: { record: number; message: Message } | undefined;

  private constructor(
    readonly name: string,
    private readonly file: TapeFile,
  ) {}

  /** Milliseconds since 1970 when it began. */
  get began(): number {
    return Number(this.file.began / 1000n) / 1000;
  }

  get ending(): TapeFile["ending"] {
    return this.file.ending;
  }

  /** Reads a file; lets the page live in between. Rejects with an Error in words. */
  static async open(name: string, bytes: Uint8Array, progress: (part: number) => void = () => undefined): Promise<Tape> {
    const file = readTape(bytes);
    const tape = new Tape(name, file);
    // Definitions first: values before them in the file need them, too.
    for (const record of file.records) if (record.kind === RecordKind.definition) tape.define(new TextDecoder().decode(record.body));
    const replaced = replacedMessages(file.records);
    let number = 0;
    for (const [index, record] of file.records.entries()) {
      if (record.kind === RecordKind.message && replaced.has(++number)) continue;
      tape.take(record, index);
      if (index % recordsAtOnce === recordsAtOnce - 1) {
        progress(index / file.records.length);
        await new Promise((resolve) => setTimeout(resolve));
      }
    }
    tape.finish();
    return tape;
  }

  private define(text: string): void {
    try {
      this.definitions.add(text);
    } catch (error) {
      this.problems.add(`A definition cannot be read: ${errorText(error)}`);
    }
  }

  private finish(): void {
    for (const track of this.tracks) track.events.sort((a, b) => a.time - b.time);
    this.events.sort((a, b) => a.time - b.time);
    this.requests.clear();
  }

  private take(record: TapeRecord, index: number): void {
    const time = Number(record.time) / 1e9;
    this.duration = Math.max(this.duration, time);
    try {
      switch (record.kind) {
        case RecordKind.opened: {
          const body = new BodyReader(record.body);
          body.u8();
          const url = body.text();
          const other = body.text();
          const service = decodeURIComponent(/[?&]service=([^&#]*)/.exec(url || other)?.[1] ?? "");
          this.connections.set(record.connection, { number: record.connection, url: url || other, service, rootType: "", types: new Map(), agreed: "", closing: "" });
          return;
        }
        case RecordKind.agreed: {
          const connection = this.connections.get(record.connection);
          if (connection) connection.agreed = `format ${new BodyReader(record.body).u8()}`;
          return;
        }
        case RecordKind.closed: {
          const connection = this.connections.get(record.connection);
          const body = new BodyReader(record.body);
          body.u16();
          if (connection) connection.closing = body.text();
          return;
        }
        case RecordKind.lost:
          this.lost += Number(new BodyReader(record.body).u64());
          return;
        case RecordKind.message:
          this.message(record, index, time);
      }
    } catch (error) {
      this.problems.add(error instanceof Error ? error.message : String(error));
    }
  }

  private message(record: TapeRecord, index: number, time: number): void {
    ++this.messages;
    const message = readMessage(record.body, { keepUnknownCodes: true });
    message.entries.forEach((entry, number) => {
      this.entry({ record: index, entry: number, element: 0, time, connection: record.connection, direction: record.direction ?? "service", path: entry.path, member: entry.member, what: "", error: "" }, entry);
    });
  }

  private entry(event: TapeEvent, entry: MessageEntry): void {
    const { type, path, member } = entry;
    const connection = this.connections.get(event.connection);
    const add = (what: string, more: Partial<TapeEvent> = {}): TapeEvent => {
      const made = { ...event, what, ...more };
      this.events.push(made);
      return made;
    };
    const key = `${event.connection}/${entry.requestId}`;
    const requestWord = requestWords[type];
    if (requestWord !== undefined) {
      this.requests.set(`${key}/${type}`, { what: requestWord, path, member, type });
      const made = add(requestWord);
      if (type === EntryType.propertySet) this.track(made, "property")?.events.push(made);
      return;
    }
    const request = this.requests.get(`${key}/${type - 1}`);
    if (request) {
      this.requests.delete(`${key}/${type - 1}`);
      this.answer(event, entry, request, connection);
      return;
    }
    if (type === EntryType.event) {
      const made = add("event");
      this.track(made, "event")?.events.push(made);
    } else if (type === EntryType.wirePacket) {
      const made = add("wire");
      this.track(made, event.direction === "client" ? "wire" : "wire out")?.events.push(made);
    } else if (type === EntryType.pipePacket) {
      entry.elements.forEach((_, element) => {
        const made = add("pipe", { element });
        this.track(made, event.direction === "client" ? "pipe" : "pipe out")?.events.push(made);
      });
    }
  }

  private answer(event: TapeEvent, entry: MessageEntry, request: Request, connection: TapeConnection | undefined): void {
    const { path, member } = request;
    const error = entry.error === 0 ? "" : errorText(errorOf(entry.error, entry.elements));
    const made: TapeEvent = { ...event, path, member, what: `${request.what} answer`, error };
    this.events.push(made);
    if (entry.error !== 0) return;
    if (request.type === EntryType.objectTypeName || request.type === EntryType.connectClientCombined) {
      const told = optionalElement(entry.elements, "objecttype")?.data;
      if (told && connection) connection.types.set(path, new TextDecoder().decode(told));
      const texts = optionalElement(entry.elements, "servicedefs");
      for (const one of texts?.elements ?? []) if (one.data) this.define(new TextDecoder().decode(one.data));
    } else if (request.type === EntryType.getServiceDesc) {
      const text = optionalElement(entry.elements, "servicedef")?.data;
      if (text) this.define(new TextDecoder().decode(text));
    } else if (request.type === EntryType.propertyGet) this.track(made, "property")?.events.push(made);
    else if (request.type === EntryType.functionCall || request.type === EntryType.generatorNext) this.track(made, "result")?.events.push(made);
    else if (request.type === EntryType.wirePeekIn) this.track(made, "wire")?.events.push(made);
  }

  /** The type of an object: as the service told it, or as the objrefs on the way declare it. */
  objectType(connection: TapeConnection | undefined, path: string): string {
    const told = connection?.types.get(path);
    if (told !== undefined) return told;
    const dot = path.lastIndexOf(".");
    if (dot < 0) return "";
    const parent = this.objectType(connection, path.slice(0, dot));
    try {
      return parent === "" ? "" : (this.definitions.object(parent).members.get(path.slice(dot + 1).replace(/\[.*$/, ""))?.objectType ?? "");
    } catch {
      return "";
    }
  }

  private track(event: TapeEvent, what: Track["what"]): Track | undefined {
    const key = `${event.connection}\n${event.path}\n${event.member}\n${what}`;
    const known = this.byKey.get(key);
    if (known) return known;
    let declared: Member | undefined;
    try {
      const type = this.objectType(this.connections.get(event.connection), event.path);
      declared = type === "" ? undefined : this.definitions.object(type).members.get(event.member);
    } catch (error) {
      this.problems.add(errorText(error));
    }
    const made: Track = { key, connection: event.connection, path: event.path, member: event.member, what, declared, type: declared?.type, events: [] };
    this.byKey.set(key, made);
    this.tracks.push(made);
    return made;
  }

  private messageAt(record: number): Message {
    if (this.cached?.record === record) return this.cached.message;
    const bytes = this.file.records[record]?.body ?? new Uint8Array(0);
    const message = readMessage(bytes, { keepUnknownCodes: true });
    this.cached = { record, message };
    return message;
  }

  /** The value of an event of a track. Throws where it cannot be read. */
  value(track: Track, event: TapeEvent): unknown {
    const entry = this.messageAt(event.record).entries[event.entry];
    const { declared } = track;
    if (!entry || !declared) throw new Error("the type of this member is not in the recording");
    const unpacker = new Unpacker(this.definitions);
    if (track.what === "event") return declared.parameters.map(({ name, type }) => unpacker.value(type, findElement(entry.elements, name)));
    const type = declared.type;
    if (type.base.kind === "void") return undefined;
    return unpacker.value(type, this.valueElement(track, event, entry.elements));
  }

  private valueElement(track: Track, event: TapeEvent, elements: readonly MessageElement[]): MessageElement {
    switch (track.what) {
      case "property":
        return findElement(elements, "value");
      case "result":
        return findElement(elements, "return");
      case "pipe":
      case "pipe out":
        return findElement(elements[event.element]?.elements, "packet");
      default:
        return findElement(elements, "packet");
    }
  }

  /** Seconds since 1970 of a value: the sender's where the wire tells it. */
  timeOf(track: Track, event: TapeEvent): number {
    const entry = this.messageAt(event.record).entries[event.entry];
    if (entry && (track.what === "wire" || track.what === "wire out")) {
      try {
        return millisecondsOf(timeOf(entry.elements)) / 1000;
      } catch {
        // Without a time it is that of the recording.
      }
    }
    return this.began / 1000 + event.time;
  }

  /** The newest event of a track at a time, in seconds since the beginning. */
  at(track: Track, time: number): TapeEvent | undefined {
    const { events } = track;
    let low = 0;
    let high = events.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((events[middle]?.time ?? 0) <= time) low = middle + 1;
      else high = middle;
    }
    return events[low - 1];
  }
}

const requestWords: Readonly<Record<number, string>> = {
  [EntryType.getServiceDesc]: "definition",
  [EntryType.objectTypeName]: "object type",
  [EntryType.connectClient]: "connect",
  [EntryType.connectClientCombined]: "connect",
  [EntryType.disconnectClient]: "disconnect",
  [EntryType.clientSessionOp]: "session",
  [EntryType.propertyGet]: "get",
  [EntryType.propertySet]: "set",
  [EntryType.functionCall]: "call",
  [EntryType.generatorNext]: "next",
  [EntryType.callbackCall]: "callback",
  [EntryType.pipeConnect]: "connect pipe",
  [EntryType.pipeDisconnect]: "close pipe",
  [EntryType.wireConnect]: "connect wire",
  [EntryType.wireDisconnect]: "close wire",
  [EntryType.wirePeekIn]: "peek",
  [EntryType.wirePeekOut]: "peek out",
  [EntryType.wirePokeOut]: "poke",
  [EntryType.memoryRead]: "read memory",
  [EntryType.memoryWrite]: "write memory",
};

/** Numbers, from 1, of messages that were never sent: a newer one took their place. */
function replacedMessages(records: readonly TapeRecord[]): ReadonlySet<number> {
  const numbers = new Set<number>();
  for (const record of records) {
    if (record.kind === RecordKind.replaced && record.body.length >= 8) numbers.add(Number(new BodyReader(record.body).u64()));
  }
  return numbers;
}

