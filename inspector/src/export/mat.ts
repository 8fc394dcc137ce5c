// SPDX-License-Identifier: Apache-2.0
// MAT-files of level 5, which MATLAB 5 and later, Octave and SciPy read: columns of doubles, not compressed.
import type { Column } from "./column.js";

const miInt8 = 1;
const miInt32 = 5;
const miUint32 = 6;
const miDouble = 9;
const miMatrix = 14;
const doubleClass = 6;
const headerSize = 128;
const longestName = 63;

/** For each line two variables: `name` and `name_time`. Names are made such as MATLAB has them. */
export function matOf(columns: readonly Column[], now: Date): Uint8Array<ArrayBuffer> {
  const taken = new Set<string>();
  const parts: Uint8Array[] = [header(now)];
  for (const column of columns) {
    const name = variableName(column.name, taken);
    parts.push(matrix(`${name}_time`, column.times), matrix(name, column.values));
  }
  const all = new Uint8Array(parts.reduce((size, part) => size + part.length, 0));
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

function header(now: Date): Uint8Array {
  const bytes = new Uint8Array(headerSize).fill(0x20);
  bytes.set(new TextEncoder().encode(`MATLAB 5.0 MAT-file, written by the inspector of Robdef, ${now.toISOString()}`).subarray(0, 116));
  bytes.fill(0, 116, 124);
  const view = new DataView(bytes.buffer);
  view.setUint16(124, 0x0100, true);
  view.setUint16(126, 0x4d49, true); // "MI": little endian
  return bytes;
}

function matrix(name: string, values: Float64Array): Uint8Array {
  const nameBytes = new TextEncoder().encode(name);
  const nameSize = padded(nameBytes.length);
  const size = 16 + 16 + 8 + nameSize + 8 + values.length * 8;
  const bytes = new Uint8Array(8 + size);
  const view = new DataView(bytes.buffer);
  let at = 0;
  const u32 = (...numbers: number[]): void => {
    for (const number of numbers) {
      view.setUint32(at, number, true);
      at += 4;
    }
  };
  u32(miMatrix, size);
  u32(miUint32, 8, doubleClass, 0);
  u32(miInt32, 8, values.length, 1);
  u32(miInt8, nameBytes.length);
  bytes.set(nameBytes, at);
  at += nameSize;
  u32(miDouble, values.length * 8);
  for (const value of values) {
    view.setFloat64(at, value, true);
    at += 8;
  }
  return bytes;
}

function padded(size: number): number {
  return Math.ceil(size / 8) * 8;
}

/** A letter, then letters, digits and underscores; another one than those taken. */
export function variableName(text: string, taken: Set<string>): string {
  const room = longestName - "_time".length - 4;
  let plain = text.replace(/[^A-Za-z0-9]+/g, "_").replace(/^_+|_+$/g, "");
  if (!/^[A-Za-z]/.test(plain)) plain = `x_${plain}`;
  plain = plain.slice(0, room);
  let name = plain;
  for (let number = 2; taken.has(name); ++number) name = `${plain}_${number}`;
  taken.add(name);
  return name;
}
