// SPDX-License-Identifier: Apache-2.0
// UTF-8, with a quick way for the short ASCII names that messages are full of.

const decoder = new TextDecoder("utf-8", { ignoreBOM: true });
const strictDecoder = new TextDecoder("utf-8", { ignoreBOM: true, fatal: true });
const encoder = new TextEncoder();
const shortLength = 24;

/** Bytes that are no UTF-8 become U+FFFD. */
export function decodeText(bytes: Uint8Array): string {
  if (bytes.length > shortLength) return decoder.decode(bytes);
  let text = "";
  for (const byte of bytes) {
    if (byte > 0x7f) return decoder.decode(bytes);
    text += String.fromCharCode(byte);
  }
  return text;
}

/** Undefined for bytes that are no UTF-8. */
export function decodeStrictText(bytes: Uint8Array): string | undefined {
  try {
    return strictDecoder.decode(bytes);
  } catch {
    return undefined;
  }
}

export function encodeText(text: string): Uint8Array {
  return encoder.encode(text);
}

/** Bytes that a text has in UTF-8; a lone surrogate counts as U+FFFD, as it is encoded. */
export function textLength(text: string): number {
  let length = text.length;
  for (let i = 0; i < text.length; ++i) {
    const code = text.charCodeAt(i);
    if (code < 0x80) continue;
    length += code < 0x800 ? 1 : 2;
    if (code >= 0xd800 && code < 0xdc00) {
      const next = text.charCodeAt(i + 1);
      // A pair has four bytes, two of which have been counted for each half.
      if (next >= 0xdc00 && next < 0xe000) ++i;
    }
  }
  return length;
}
