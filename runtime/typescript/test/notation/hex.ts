// SPDX-License-Identifier: Apache-2.0

export function hexOf(pieces: Uint8Array | readonly Uint8Array[]): string {
  const list = pieces instanceof Uint8Array ? [pieces] : pieces;
  return list.map((piece) => Buffer.from(piece.buffer, piece.byteOffset, piece.length).toString("hex")).join("");
}

export function bytesOf(hex: string): Uint8Array {
  const bytes = Uint8Array.from(Buffer.from(hex, "hex"));
  if (2 * bytes.length !== hex.length) throw new Error(`no hex: ${hex.slice(0, 40)}`);
  return bytes;
}
