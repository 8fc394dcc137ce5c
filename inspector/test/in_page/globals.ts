// SPDX-License-Identifier: Apache-2.0
// What Node has and pages do not, as far as the tests of the runtime use it.
function hexOf(bytes: Uint8Array): string {
  let text = "";
  for (const byte of bytes) text += byte.toString(16).padStart(2, "0");
  return text;
}

/** Bytes of a text, or a view of a buffer, that can be written as hex. */
export const Buffer = {
  from(given: string | ArrayBufferLike, how?: string | number, length?: number): Uint8Array {
    let bytes: Uint8Array;
    if (typeof given !== "string") bytes = new Uint8Array(given, how as number, length);
    else if (how === "hex") bytes = Uint8Array.from({ length: Math.floor(given.length / 2) }, (_, i) => Number.parseInt(given.slice(2 * i, 2 * i + 2), 16));
    else bytes = new TextEncoder().encode(given);
    const made = new Uint8Array(bytes.buffer, bytes.byteOffset, bytes.length);
    made.toString = () => hexOf(made);
    return made;
  },
  byteLength: (text: string): number => new TextEncoder().encode(text).length,
};

export const process = { env: { ROBDEF_CAPTURES_DIR: "captures" } };
