// SPDX-License-Identifier: Apache-2.0
// Rows of items, and blocks that are copied between them.
import type { BaseType, RecordType } from "../definition/types.js";
import { product } from "../definition/types.js";
import { sizeOfNumber } from "./numbers.js";
import { readNumbers } from "./numbers.js";

/** A row for so many items: of numbers their typed array, else a plain array. */
export function emptyRow(base: BaseType, count: number): ArrayLike<unknown> {
  if (base.kind !== "number") return new Array<unknown>(count);
  if (base.number === "bool" || base.number === "cdouble" || base.number === "csingle") return new Array<unknown>(count);
  return readNumbers(base.number, new Uint8Array(count * sizeOfNumber(base.number)));
}

/** Part of a row; of a typed array a view. */
export function slice(row: ArrayLike<unknown>, from: number, to: number): ArrayLike<unknown> {
  if (from === 0 && to === row.length) return row;
  if (Array.isArray(row)) return (row as unknown[]).slice(from, to);
  return (row as Uint8Array).subarray(from, to);
}

/** Copies a block of `count` items between rows of the dimensions `fromDims` and `toDims`. */
export function copyBlock(
  from: ArrayLike<unknown>,
  fromStart: readonly number[],
  fromDims: readonly number[],
  to: ArrayLike<unknown>,
  toStart: readonly number[],
  toDims: readonly number[],
  count: readonly number[],
): void {
  const target = to as unknown[];
  const index = count.map(() => 0);
  const run = count[0] ?? 1;
  const runs = product(count.slice(1));
  for (let i = 0; i < runs; ++i) {
    const source = offset(fromStart, index, fromDims);
    const destination = offset(toStart, index, toDims);
    for (let j = 0; j < run; ++j) target[destination + j] = from[source + j];
    for (let d = 1; d < count.length; ++d) {
      index[d] = (index[d] ?? 0) + 1;
      if ((index[d] ?? 0) < (count[d] ?? 0)) break;
      index[d] = 0;
    }
  }
}

function offset(start: readonly number[], index: readonly number[], dims: readonly number[]): number {
  let at = 0;
  let step = 1;
  for (let d = 0; d < dims.length; ++d) {
    at += ((start[d] ?? 0) + (index[d] ?? 0)) * step;
    step *= dims[d] ?? 1;
  }
  return at;
}

const elementHead = 16;

/**
 * What a part of a memory is measured by (07, section 13): bytes of a number, most bytes of a pod in format 2,
 * and of a namedarray those of one number, as existing implementations count.
 */
export function packedSize(base: BaseType): number {
  if (base.kind === "number") return sizeOfNumber(base.number);
  if (base.kind !== "record") return 4;
  const { record } = base;
  return record.kind === "namedarray" ? sizeOfNumber(record.number ?? "double") : podSize(record, 1);
}

function podSize(record: RecordType, depth: number): number {
  let size = elementHead + 10;
  if (depth > 64) return size;
  for (const { name, type } of record.fields) {
    const { base, array } = type;
    const times = array.kind === "scalar" ? 1 : array.kind === "array" ? (array.length ?? 1) : product(array.dims ?? []);
    size += elementHead + name.length;
    if (base.kind === "number") size += times * sizeOfNumber(base.number);
    else if (base.kind === "record" && base.record.kind === "namedarray") {
      size += base.record.name.length + elementHead + 5 + times * (base.record.count ?? 1) * sizeOfNumber(base.record.number ?? "double");
    } else if (base.kind === "record") size += base.record.name.length + times * podSize(base.record, depth + 1);
  }
  return size;
}
