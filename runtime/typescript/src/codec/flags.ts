// SPDX-License-Identifier: Apache-2.0
// The flags that a normal sender of format 4 sets (02, sections 2 to 4).
import { EntryFlag, ElementFlag, HeaderFlag, type Message, type MessageElement, type MessageEntry } from "./message.js";

export function headerFlags(message: Message): number {
  let flags = 0;
  if (message.senderNode) flags |= HeaderFlag.routing;
  if (message.senderEndpoint !== undefined) flags |= HeaderFlag.endpoints;
  if (message.priority !== undefined) flags |= HeaderFlag.priority;
  if (message.metadata || message.messageId || message.messageResId) flags |= HeaderFlag.meta;
  if (message.strings) flags |= HeaderFlag.stringTable;
  if (message.entries.length !== 1) flags |= HeaderFlag.multipleEntries;
  if (message.extended?.length) flags |= HeaderFlag.extended;
  return flags;
}

export function entryFlags(entry: MessageEntry): number {
  let flags = EntryFlag.path | EntryFlag.member;
  if (entry.requestId !== 0) flags |= EntryFlag.requestId;
  if (entry.error !== 0) flags |= EntryFlag.error;
  if (entry.metadata) flags |= EntryFlag.meta;
  if (entry.extended?.length) flags |= EntryFlag.extended;
  return flags;
}

export function elementFlags(element: MessageElement): number {
  let flags: number = element.number === undefined ? ElementFlag.name : ElementFlag.number;
  if (element.typeName !== "") flags |= ElementFlag.typeName;
  if (element.metadata) flags |= ElementFlag.meta;
  if (element.extended?.length) flags |= ElementFlag.extended;
  return flags;
}
