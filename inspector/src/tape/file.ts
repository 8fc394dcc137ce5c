// SPDX-License-Identifier: Apache-2.0
// Files of recordings, version 1 (docs/howto/recording.md).

/** Kinds of records. */
export const RecordKind = { end: 0, message: 1, opened: 2, agreed: 3, closed: 4, definition: 5, lost: 6, replaced: 7 } as const;

export type Direction = "service" | "client";

/** One record, as it is in the file. */
export interface TapeRecord {
  readonly kind: number;
  /** Of a message: to whom it goes. */
  readonly direction: Direction | undefined;
  /** From 1; 0 for what belongs to no connection. */
  readonly connection: number;
  /** Nanoseconds since the recording began. */
  readonly time: bigint;
  /** A view of the file. */
  readonly body: Uint8Array;
}

export interface TapeFile {
  /** Nanoseconds since 1970, UTC. */
  readonly began: bigint;
  readonly records: TapeRecord[];
  /** How the file ends; what comes after a damaged record is not read. */
  readonly ending: "closed" | "open" | "cut off" | "damaged";
}

const magic = [0x52, 0x52, 0x54, 0x41, 0x50, 0x45, 0x1a, 0x0a];
const headerSize = 32;
const recordHead = 24;

const crcTable = Uint32Array.from({ length: 256 }, (_, i) => {
  let value = i;
  for (let bit = 0; bit < 8; ++bit) value = (value & 1) === 1 ? (value >>> 1) ^ 0xedb88320 : value >>> 1;
  return value;
});

/** CRC-32 over several parts. */
export function checksum(...parts: readonly Uint8Array[]): number {
  let value = 0xffffffff;
  for (const part of parts) {
    for (let i = 0; i < part.length; ++i) value = (value >>> 8) ^ (crcTable[(value ^ (part[i] ?? 0)) & 0xff] ?? 0);
  }
  return ~value >>> 0;
}

/** Reads a whole file. Throws an Error with words for a user when it is no recording. */
export function readTape(bytes: Uint8Array): TapeFile {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < headerSize || magic.some((byte, i) => bytes[i] !== byte)) throw new Error("This file is no recording: an .rrtape file begins with RRTAPE.");
  const version = view.getUint16(8, true);
  if (version !== 1) throw new Error(`This recording has version ${version} of the format; version 1 can be read.`);
  const begin = view.getUint16(10, true);
  if (begin < headerSize || view.getUint32(28, true) !== checksum(bytes.subarray(0, 28))) throw new Error("The beginning of this recording is damaged.");
  const records: TapeRecord[] = [];
  let at = begin;
  let ending: TapeFile["ending"] = "open";
  while (at < bytes.length) {
    const size = at + recordHead <= bytes.length ? view.getUint32(at, true) : Infinity;
    if (at + recordHead + size > bytes.length) {
      ending = "cut off";
      break;
    }
    const body = bytes.subarray(at + recordHead, at + recordHead + size);
    if (view.getUint32(at + 12, true) !== checksum(bytes.subarray(at, at + 12), bytes.subarray(at + 16, at + recordHead), body)) {
      ending = "damaged";
      break;
    }
    const kind = bytes[at + 4] ?? 0;
    if (kind === RecordKind.end) {
      ending = "closed";
      break;
    }
    const direction = bytes[at + 5];
    records.push({ kind, direction: direction === 1 ? "service" : direction === 2 ? "client" : undefined, connection: view.getUint32(at + 8, true), time: view.getBigUint64(at + 16, true), body });
    at += recordHead + size;
  }
  return { began: view.getBigInt64(16, true), records, ending };
}

/** The 32 bytes that a file begins with. */
export function tapeHeader(began: bigint): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(headerSize);
  const view = new DataView(bytes.buffer);
  bytes.set(magic);
  view.setUint16(8, 1, true);
  view.setUint16(10, headerSize, true);
  view.setBigInt64(16, began, true);
  view.setUint32(28, checksum(bytes.subarray(0, 28)), true);
  return bytes;
}

/** A record as it is in the file. */
export function tapeRecord(record: TapeRecord): Uint8Array<ArrayBuffer> {
  const { kind, direction, connection, time, body } = record;
  const bytes = new Uint8Array(recordHead + body.length);
  const view = new DataView(bytes.buffer);
  view.setUint32(0, body.length, true);
  bytes[4] = kind;
  bytes[5] = direction === "service" ? 1 : direction === "client" ? 2 : 0;
  view.setUint32(8, connection, true);
  view.setBigUint64(16, time, true);
  bytes.set(body, recordHead);
  view.setUint32(12, checksum(bytes.subarray(0, 12), bytes.subarray(16)), true);
  return bytes;
}

/** Reads the fields of a body. Throws RangeError at its end. */
export class BodyReader {
  private at = 0;
  private readonly view: DataView;

  constructor(private readonly bytes: Uint8Array) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  u8(): number {
    return this.view.getUint8(this.at++);
  }

  u16(): number {
    this.at += 2;
    return this.view.getUint16(this.at - 2, true);
  }

  u64(): bigint {
    this.at += 8;
    return this.view.getBigUint64(this.at - 8, true);
  }

  text(): string {
    const size = this.view.getUint32(this.at, true);
    const begin = this.at + 4;
    if (begin + size > this.bytes.length) throw new RangeError("a text goes over the end of its record");
    this.at = begin + size;
    return new TextDecoder().decode(this.bytes.subarray(begin, this.at));
  }
}

/** The bytes of a text in a body. */
export function tapeText(text: string): Uint8Array {
  const bytes = new TextEncoder().encode(text);
  const whole = new Uint8Array(4 + bytes.length);
  new DataView(whole.buffer).setUint32(0, bytes.length, true);
  whole.set(bytes, 4);
  return whole;
}

export function joined(parts: readonly Uint8Array[]): Uint8Array<ArrayBuffer> {
  const whole = new Uint8Array(parts.reduce((size, part) => size + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}
