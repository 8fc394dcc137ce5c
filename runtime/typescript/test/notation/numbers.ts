// SPDX-License-Identifier: Apache-2.0
// Packed numbers as the captures write them down; see conformance/captures/README.md, "Values".
import { ElementType, itemSize } from "../../src/codec/element_type.js";
import { list, type Json } from "./json.js";

function view(bytes: Uint8Array): DataView {
  return new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
}

function nanText(bits: bigint, digits: number, plain: bigint): string {
  return bits === plain ? "NaN" : `NaN:0x${bits.toString(16).padStart(digits, "0")}`;
}

function special(value: number): Json {
  return Number.isFinite(value) ? value : value > 0 ? "Infinity" : "-Infinity";
}

/** The shortest decimal that reads as the same single. */
export function shortSingle(value: number): number {
  if (value === 0) return value;
  for (let digits = 1; digits < 10; ++digits) {
    const short = Number(value.toPrecision(digits));
    if (Math.fround(short) === value) return short;
  }
  return value;
}

function readDouble(data: DataView, at: number): Json {
  const value = data.getFloat64(at, true);
  if (Number.isNaN(value)) return nanText(data.getBigUint64(at, true), 16, 0x7ff8000000000000n);
  return special(value);
}

function readSingle(data: DataView, at: number): Json {
  const value = data.getFloat32(at, true);
  if (Number.isNaN(value)) return nanText(BigInt(data.getUint32(at, true)), 8, 0x7fc00000n);
  return Number.isFinite(value) ? shortSingle(value) : special(value);
}

function readNumber(type: number, data: DataView, at: number): Json {
  switch (type) {
    case ElementType.double:
      return readDouble(data, at);
    case ElementType.single:
      return readSingle(data, at);
    case ElementType.int8:
      return data.getInt8(at);
    case ElementType.uint8:
      return data.getUint8(at);
    case ElementType.int16:
      return data.getInt16(at, true);
    case ElementType.uint16:
      return data.getUint16(at, true);
    case ElementType.int32:
      return data.getInt32(at, true);
    case ElementType.uint32:
      return data.getUint32(at, true);
    case ElementType.int64:
      return data.getBigInt64(at, true).toString();
    case ElementType.uint64:
      return data.getBigUint64(at, true).toString();
    case ElementType.cdouble:
      return [readDouble(data, at), readDouble(data, at + 8)];
    case ElementType.csingle:
      return [readSingle(data, at), readSingle(data, at + 4)];
    case ElementType.bool:
      return data.getUint8(at) !== 0;
    default:
      throw new Error(`no number type: ${type}`);
  }
}

/** Undefined for bools that are neither 0 nor 1. */
export function jsonOfNumbers(type: number, bytes: Uint8Array): Json[] | undefined {
  const size = itemSize(type) ?? 0;
  if (type === ElementType.bool && bytes.some((byte) => byte > 1)) return undefined;
  const data = view(bytes);
  const result: Json[] = [];
  for (let at = 0; at + size <= bytes.length; at += size) result.push(readNumber(type, data, at));
  return result;
}

export function floatOf(json: Json): number {
  if (typeof json === "number") return json;
  if (json === "NaN") return NaN;
  if (json === "Infinity") return Infinity;
  if (json === "-Infinity") return -Infinity;
  throw new Error(`not a number: ${JSON.stringify(json)}`);
}

function writeDouble(data: DataView, at: number, json: Json): void {
  if (typeof json === "string" && json.startsWith("NaN:")) data.setBigUint64(at, BigInt(json.slice(4)), true);
  else if (json === "NaN") data.setBigUint64(at, 0x7ff8000000000000n, true);
  else data.setFloat64(at, floatOf(json), true);
}

function writeSingle(data: DataView, at: number, json: Json): void {
  if (typeof json === "string" && json.startsWith("NaN:")) data.setUint32(at, Number(json.slice(4)), true);
  else if (json === "NaN") data.setUint32(at, 0x7fc00000, true);
  else data.setFloat32(at, floatOf(json), true);
}

function writeNumber(type: number, data: DataView, at: number, json: Json): void {
  const items = Array.isArray(json) ? json : [json];
  switch (type) {
    case ElementType.double:
    case ElementType.cdouble:
      items.forEach((item, i) => {
        writeDouble(data, at + 8 * i, item);
      });
      return;
    case ElementType.single:
    case ElementType.csingle:
      items.forEach((item, i) => {
        writeSingle(data, at + 4 * i, item);
      });
      return;
    case ElementType.int8:
    case ElementType.uint8:
    case ElementType.bool:
      data.setUint8(at, Number(json));
      return;
    case ElementType.int16:
    case ElementType.uint16:
      data.setUint16(at, Number(json), true);
      return;
    case ElementType.int32:
    case ElementType.uint32:
      data.setUint32(at, Number(json), true);
      return;
    case ElementType.int64:
    case ElementType.uint64:
      data.setBigUint64(at, BigInt.asUintN(64, BigInt(json as string | number)), true);
      return;
    default:
      throw new Error(`no number type: ${type}`);
  }
}

export function numbersOfJson(type: number, json: Json | undefined): Uint8Array {
  const items = list(json);
  const size = itemSize(type) ?? 0;
  const bytes = new Uint8Array(size * items.length);
  const data = view(bytes);
  items.forEach((item, i) => {
    writeNumber(type, data, i * size, item);
  });
  return bytes;
}
