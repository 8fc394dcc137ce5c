// SPDX-License-Identifier: Apache-2.0
// Paths of objects (07, section 3).
import { encodeText } from "./codec/text.js";
import { ErrorCode, makeError } from "./errors.js";

const longestPath = 65_535;

function isPlain(byte: number): boolean {
  return (byte >= 0x30 && byte <= 0x39) || (byte >= 0x41 && byte <= 0x5a) || (byte >= 0x61 && byte <= 0x7a);
}

/** An index as paths spell it: every byte but ASCII letters and digits with two digits. */
export function escapeIndex(index: string): string {
  let text = "";
  for (const byte of encodeText(index)) {
    text += isPlain(byte) ? String.fromCharCode(byte) : `%${byte.toString(16).padStart(2, "0")}`;
  }
  return text;
}

/** The path of the object that an objref of an object gives. */
export function childPath(parent: string, objref: string, index?: number | string): string {
  return index === undefined ? `${parent}.${objref}` : `${parent}.${objref}[${escapeIndex(String(index))}]`;
}

/** Whether a path is another one, or of an object below it. */
export function isAtOrBelow(path: string, above: string): boolean {
  return path === above || path.startsWith(`${above}.`);
}

export interface PathSegment {
  readonly name: string;
  /** Decoded. */
  readonly index: string | undefined;
}

const segmentPattern = /^([a-zA-Z](?:[a-zA-Z0-9_]*[a-zA-Z0-9])?)(?:\[((?:[a-zA-Z0-9_]|%[0-9a-fA-F]{2})+)\])?$/;

/** Throws ServiceError for a path that is not well-formed. */
export function parsePath(path: string): PathSegment[] {
  if (path.length > longestPath) throw makeError(ErrorCode.ServiceError, "a service path is too long");
  return path.split(".").map((text) => {
    const match = segmentPattern.exec(text);
    if (!match) throw makeError(ErrorCode.ServiceError, `"${path.slice(0, 200)}" is no service path`);
    const [, name = "", index] = match;
    return { name, index: index === undefined ? undefined : decodeIndex(index) };
  });
}

function decodeIndex(index: string): string {
  try {
    return decodeURIComponent(index);
  } catch {
    // Bytes that are no UTF-8 are an index all the same, which names nothing.
    return index;
  }
}
