// SPDX-License-Identifier: Apache-2.0
import { ElementType, EntryType, readMessage, type Message, type MessageElement } from "@robdef/runtime/messages";

const headSize = 8;
const magic = 0x43415252;

/** Cuts a stream into messages: each begins with `RRAC` and its size. */
export class MessageCutter {
  private parts: Uint8Array[] = [];
  private size = 0;
  private isBroken = false;

  constructor(private readonly take: (message: Uint8Array) => void) {}

  push(bytes: Uint8Array): void {
    if (this.isBroken || bytes.length === 0) return;
    this.parts.push(bytes);
    this.size += bytes.length;
    while (this.size >= headSize) {
      const head = this.first(headSize);
      const view = new DataView(head.buffer, head.byteOffset, head.byteLength);
      const wanted = view.getUint32(4, true);
      if (view.getUint32(0, true) !== magic || wanted < headSize) {
        this.isBroken = true;
        this.parts = [];
        return;
      }
      if (this.size < wanted) return;
      const all = this.first(wanted);
      this.take(all.subarray(0, wanted));
      const rest = all.subarray(wanted);
      this.parts.shift();
      if (rest.length > 0) this.parts.unshift(rest);
      this.size -= wanted;
    }
  }

  /** The first part, made long enough. */
  private first(size: number): Uint8Array {
    const [part] = this.parts;
    if (part && part.length >= size) return part;
    const whole = new Uint8Array(this.size);
    let at = 0;
    for (const one of this.parts) {
      whole.set(one, at);
      at += one.length;
    }
    this.parts = [whole];
    return whole;
  }
}

/** A message, or undefined for bytes that are none. */
export function messageOf(bytes: Uint8Array): Message | undefined {
  try {
    return readMessage(bytes, { keepUnknownCodes: true });
  } catch {
    return undefined;
  }
}

/** The same bytes with the credentials of logins masked: texts with stars, numbers with zeros. */
export function maskedLogin(message: Message, bytes: Uint8Array): Uint8Array {
  const masks = message.entries.some(({ type, elements }) => (type === EntryType.connectClientCombined || type === EntryType.clientSessionOp) && elements.some((one) => one.name === "credentials"));
  if (!masks) return bytes;
  const copy = bytes.slice();
  for (const entry of messageOf(copy)?.entries ?? []) {
    for (const element of entry.elements) if (element.name === "credentials") mask(element);
  }
  return copy;
}

function mask(element: MessageElement): void {
  element.extended?.fill(0);
  element.data?.fill(element.type === ElementType.string ? 0x2a : 0);
  for (const one of element.elements ?? []) mask(one);
}

