// SPDX-License-Identifier: Apache-2.0
// What values are in JavaScript; see runtime/typescript/README.md for the whole table.

/** A complex number. */
export interface Complex {
  /** The real part. */
  re: number;
  /** The imaginary part. */
  im: number;
}

/** Typed arrays that numbers travel in. */
export type NumberArray =
  | Float64Array
  | Float32Array
  | Int8Array
  | Uint8Array
  | Int16Array
  | Uint16Array
  | Int32Array
  | Uint32Array
  | BigInt64Array
  | BigUint64Array;

/**
 * An array with several dimensions. Its items lie in one row, the first index fastest: item (i, j) of
 * `dims` [rows, columns] is at i + j * rows.
 */
export class MultiDimArray<A extends ArrayLike<unknown> = ArrayLike<unknown>> {
  /** The length of each dimension. */
  readonly dims: readonly number[];
  /** All items, first index fastest. */
  readonly array: A;

  /** Throws RangeError when the array has another count of items than the dimensions say. */
  constructor(dims: readonly number[], array: A) {
    const count = dims.length === 0 ? 0 : dims.reduce((all, dim) => all * dim, 1);
    if (dims.some((dim) => !Number.isInteger(dim) || dim < 0) || count !== array.length) {
      throw new RangeError(`${array.length} items are no array of ${dims.join(" x ")}`);
    }
    this.dims = dims;
    this.array = array;
  }

  /** The item at an index for each dimension; undefined outside. */
  at(...index: number[]): A[number] | undefined {
    if (index.length !== this.dims.length) return undefined;
    let position = 0;
    let step = 1;
    for (let i = 0; i < index.length; ++i) {
      const dim = this.dims[i] ?? 0;
      const one = index[i] ?? 0;
      if (one < 0 || one >= dim) return undefined;
      position += one * step;
      step *= dim;
    }
    return this.array[position];
  }
}

/**
 * A value with its type: what a `varvalue` holds. Types are spelled as in definitions, named ones qualified:
 * `double[]`, `string`, `com.robotraconteur.geometry.Pose[]`, `varvalue{list}`.
 */
export class VarValue<T = unknown> {
  constructor(
    /** As definitions spell it, named types qualified. */
    readonly type: string,
    /** What it is in JavaScript. */
    readonly value: T,
  ) {}
}

/** Time since 1970-01-01 UTC; nanoseconds from 0 to 999,999,999. */
export interface TimeSpec {
  /** Negative before 1970. */
  seconds: bigint;
  /** From 0 to 999,999,999. */
  nanoseconds: number;
}

/** Negative when `a` is before `b`, 0 when they are the same time. */
export function compareTimes(a: TimeSpec, b: TimeSpec): number {
  if (a.seconds !== b.seconds) return a.seconds < b.seconds ? -1 : 1;
  return a.nanoseconds - b.nanoseconds;
}

/** Milliseconds since 1970, as Date has them; less than a microsecond is lost. */
export function millisecondsOf(time: TimeSpec): number {
  return Number(time.seconds) * 1000 + time.nanoseconds / 1e6;
}
