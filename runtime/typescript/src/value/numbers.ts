// SPDX-License-Identifier: Apache-2.0
// Packed numbers to typed arrays and back.
import { numberTypes, type NumberName } from "../definition/types.js";
import { itemSize } from "../codec/element_type.js";
import { ErrorCode, makeError } from "../errors.js";
import type { Complex, NumberArray } from "./values.js";

/** What an array of numbers is read as. */
export type NumbersValue = NumberArray | boolean[] | Complex[];

const isLittleEndian = new Uint8Array(new Uint16Array([1]).buffer)[0] === 1;

/** Arrays below this size are copied, so that a small value does not keep a large message in memory. */
const viewedSize = 4096;

interface NumberArrayConstructor {
  new (length: number): NumberArray;
  new (buffer: ArrayBufferLike, offset: number, length: number): NumberArray;
  readonly BYTES_PER_ELEMENT: number;
}

const constructors: Partial<Record<NumberName, NumberArrayConstructor>> = {
  double: Float64Array,
  single: Float32Array,
  int8: Int8Array,
  uint8: Uint8Array,
  int16: Int16Array,
  uint16: Uint16Array,
  int32: Int32Array,
  uint32: Uint32Array,
  int64: BigInt64Array,
  uint64: BigUint64Array,
};

/** The kind of number that a typed array holds. */
export function numberOfArray(array: unknown): NumberName | undefined {
  for (const [name, constructor] of Object.entries(constructors)) {
    if (array instanceof constructor) return name as NumberName;
  }
  return undefined;
}

/** Bytes of one number. */
export function sizeOfNumber(number: NumberName): number {
  return itemSize(numberTypes[number]) ?? 0;
}

/** A copy whose bytes are in the machine's order, at an offset that typed arrays can have. */
function own(bytes: Uint8Array, size: number): Uint8Array {
  // Not by slice, which a Buffer of Node does not copy by.
  const copy = new Uint8Array(bytes);
  return isLittleEndian ? copy : swapped(copy, size);
}

function swapped(bytes: Uint8Array, size: number): Uint8Array {
  for (let at = 0; at + size <= bytes.length; at += size) bytes.subarray(at, at + size).reverse();
  return bytes;
}

function floats(number: "cdouble" | "csingle", bytes: Uint8Array): Float64Array | Float32Array {
  const size = number === "cdouble" ? 8 : 4;
  const { buffer, byteOffset, length } = own(bytes, size);
  return size === 8 ? new Float64Array(buffer, byteOffset, length / 8) : new Float32Array(buffer, byteOffset, length / 4);
}

/**
 * All numbers of a packed array. Large arrays whose bytes are aligned are views of `bytes`, others are one
 * copy.
 */
export function readNumbers(number: NumberName, bytes: Uint8Array): NumbersValue {
  if (number === "bool") return Array.from(bytes, (byte) => byte !== 0);
  if (number === "cdouble" || number === "csingle") {
    const parts = floats(number, bytes);
    return Array.from({ length: parts.length / 2 }, (_, i) => ({ re: parts[2 * i] ?? 0, im: parts[2 * i + 1] ?? 0 }));
  }
  const constructor = constructors[number];
  if (!constructor) throw makeError(ErrorCode.InternalError, `no array holds ${number}`);
  const size = constructor.BYTES_PER_ELEMENT;
  const canView = bytes.length >= viewedSize && isLittleEndian && bytes.byteOffset % size === 0;
  const source = canView ? bytes : own(bytes, size);
  return new constructor(source.buffer, source.byteOffset, source.length / size);
}

/** The first number. `bytes` must hold one. */
export function readNumber(number: NumberName, bytes: Uint8Array): number | bigint | boolean | Complex {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  switch (number) {
    case "double":
      return view.getFloat64(0, true);
    case "single":
      return view.getFloat32(0, true);
    case "int8":
      return view.getInt8(0);
    case "uint8":
      return view.getUint8(0);
    case "int16":
      return view.getInt16(0, true);
    case "uint16":
      return view.getUint16(0, true);
    case "int32":
      return view.getInt32(0, true);
    case "uint32":
      return view.getUint32(0, true);
    case "int64":
      return view.getBigInt64(0, true);
    case "uint64":
      return view.getBigUint64(0, true);
    case "cdouble":
      return { re: view.getFloat64(0, true), im: view.getFloat64(8, true) };
    case "csingle":
      return { re: view.getFloat32(0, true), im: view.getFloat32(4, true) };
    case "bool":
      return view.getUint8(0) !== 0;
  }
}

const ranges: Partial<Record<NumberName, readonly [number, number]>> = {
  int8: [-0x80, 0x7f],
  uint8: [0, 0xff],
  int16: [-0x8000, 0x7fff],
  uint16: [0, 0xffff],
  int32: [-0x80000000, 0x7fffffff],
  uint32: [0, 0xffffffff],
};

function mismatch(number: NumberName, value: unknown): never {
  const text = typeof value === "object" ? "an object" : String(value).slice(0, 40);
  throw makeError(ErrorCode.DataTypeMismatch, `${text} is no ${number}`);
}

function finiteOrNot(number: NumberName, value: unknown): number {
  if (typeof value !== "number") mismatch(number, value);
  return value;
}

function bigOf(number: NumberName, value: unknown): bigint {
  const big = typeof value === "number" && Number.isSafeInteger(value) ? BigInt(value) : value;
  if (typeof big !== "bigint") mismatch(number, value);
  const cut = number === "int64" ? BigInt.asIntN(64, big) : BigInt.asUintN(64, big);
  if (cut !== big) throw makeError(ErrorCode.OutOfRange, `${big} is no ${number}`);
  return big;
}

function isComplex(value: unknown): value is Complex {
  return typeof value === "object" && value !== null && "re" in value && "im" in value;
}

function writeNumber(number: NumberName, view: DataView, at: number, value: unknown): void {
  switch (number) {
    case "double":
      view.setFloat64(at, finiteOrNot(number, value), true);
      return;
    case "single":
      view.setFloat32(at, finiteOrNot(number, value), true);
      return;
    case "cdouble":
    case "csingle": {
      const parts = typeof value === "number" ? { re: value, im: 0 } : value;
      if (!isComplex(parts)) mismatch(number, value);
      const part = number === "cdouble" ? "double" : "single";
      writeNumber(part, view, at, parts.re);
      writeNumber(part, view, at + sizeOfNumber(part), parts.im);
      return;
    }
    case "bool":
      if (typeof value !== "boolean") mismatch(number, value);
      view.setUint8(at, value ? 1 : 0);
      return;
    case "int64":
      view.setBigInt64(at, bigOf(number, value), true);
      return;
    case "uint64":
      view.setBigUint64(at, bigOf(number, value), true);
      return;
    default: {
      const whole = typeof value === "bigint" ? Number(value) : value;
      if (typeof whole !== "number" || !Number.isInteger(whole)) mismatch(number, value);
      const [low, high] = ranges[number] ?? [0, 0];
      if (whole < low || whole > high) throw makeError(ErrorCode.OutOfRange, `${whole} is no ${number}`);
      const size = sizeOfNumber(number);
      if (size === 1) view.setUint8(at, whole & 0xff);
      else if (size === 2) view.setUint16(at, whole & 0xffff, true);
      else view.setUint32(at, whole >>> 0, true);
    }
  }
}

/** The bytes of one number. Throws DataTypeMismatch or OutOfRange. */
export function packNumber(number: NumberName, value: unknown): Uint8Array {
  const bytes = new Uint8Array(sizeOfNumber(number));
  writeNumber(number, new DataView(bytes.buffer), 0, value);
  return bytes;
}

/**
 * The bytes of several numbers: a view of `values` when that is the typed array of this kind, else a copy of
 * each number, which must fit. Throws DataTypeMismatch or OutOfRange.
 */
export function packNumbers(number: NumberName, values: ArrayLike<unknown>): Uint8Array {
  const constructor = constructors[number];
  if (constructor && values instanceof constructor) {
    const bytes = new Uint8Array(values.buffer, values.byteOffset, values.byteLength);
    return isLittleEndian ? bytes : swapped(bytes.slice(), constructor.BYTES_PER_ELEMENT);
  }
  const size = sizeOfNumber(number);
  const bytes = new Uint8Array(size * values.length);
  const view = new DataView(bytes.buffer);
  for (let i = 0; i < values.length; ++i) writeNumber(number, view, i * size, values[i]);
  return bytes;
}
