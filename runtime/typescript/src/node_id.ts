// SPDX-License-Identifier: Apache-2.0
import { randomBytes } from "./random.js";
import { RRError, ErrorCode } from "./errors.js";

const pattern = /^\{?([0-9a-f]{8})-([0-9a-f]{4})-([0-9a-f]{4})-([0-9a-f]{4})-([0-9a-f]{12})\}?$/i;

/** The identity of a node: 16 bytes, all zero for "any" or "unknown". */
export class NodeId {
  /** All zero: any node, or unknown. */
  static readonly any = new NodeId(new Uint8Array(16));

  private constructor(readonly bytes: Uint8Array) {}

  /** Copies the first 16 bytes. */
  static fromBytes(bytes: Uint8Array): NodeId {
    const copy = new Uint8Array(16);
    copy.set(bytes.subarray(0, 16));
    return new NodeId(copy);
  }

  /** Of `8-4-4-4-12` hexadecimal digits, with or without braces. Throws InvalidArgument. */
  static parse(text: string): NodeId {
    const match = pattern.exec(text.trim());
    if (!match) throw new RRError(ErrorCode.InvalidArgument, `"${text.slice(0, 80)}" is no node id`);
    const digits = match.slice(1).join("");
    return new NodeId(Uint8Array.from({ length: 16 }, (_, i) => parseInt(digits.slice(2 * i, 2 * i + 2), 16)));
  }

  /** A random (version 4) id. */
  static random(): NodeId {
    const bytes = randomBytes(16);
    bytes[6] = ((bytes[6] ?? 0) & 0x0f) | 0x40;
    bytes[8] = ((bytes[8] ?? 0) & 0x3f) | 0x80;
    return new NodeId(bytes);
  }

  /** Whether it is all zero. */
  get isAny(): boolean {
    return this.bytes.every((byte) => byte === 0);
  }

  /** Whether both are the same node. */
  equals(other: NodeId): boolean {
    return this.bytes.every((byte, i) => byte === other.bytes[i]);
  }

  /** Lower case, without braces. */
  toString(): string {
    const digits = Array.from(this.bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
    return [digits.slice(0, 8), digits.slice(8, 12), digits.slice(12, 16), digits.slice(16, 20), digits.slice(20)].join("-");
  }
}
