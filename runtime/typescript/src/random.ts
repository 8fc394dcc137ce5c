// SPDX-License-Identifier: Apache-2.0

type Fill = (array: Uint8Array<ArrayBuffer> | Uint32Array<ArrayBuffer>) => void;

let fill: Fill = (array) => {
  crypto.getRandomValues(array);
};

/** Node 18 has no global `crypto`, so its entry point says where random numbers are. */
export function useRandomSource(source: Fill): void {
  fill = source;
}

/** So many random bytes. */
export function randomBytes(count: number): Uint8Array {
  const bytes = new Uint8Array(count);
  fill(bytes);
  return bytes;
}

/** A random number of 32 bits. */
export function randomUint32(): number {
  const one = new Uint32Array(1);
  fill(one);
  return one[0] ?? 0;
}
