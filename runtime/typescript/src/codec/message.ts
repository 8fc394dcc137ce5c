// SPDX-License-Identifier: Apache-2.0

/**
 * A value on its way, or a list of such (01, section 4). A reader fills in `flags` and codes as they were;
 * a writer makes its own flags where there are none.
 */
export interface MessageElement {
  /** Undefined where a number stands instead. */
  name?: string;
  /** Of list items, integer keys and the like, in format 4. */
  number?: number;
  type: number;
  typeName: string;
  metadata?: string;
  extended?: Uint8Array;
  /** Items of an array, bytes of a string, or elements. */
  count: number;
  /** The bytes of a packed array or string: a view of the message. */
  data?: Uint8Array;
  elements?: MessageElement[];
  flags?: number;
  nameCode?: number;
  typeNameCode?: number;
}

/** A request, an answer or a packet (01, section 3). */
export interface MessageEntry {
  type: number;
  path: string;
  member: string;
  requestId: number;
  error: number;
  metadata?: string;
  extended?: Uint8Array;
  elements: MessageElement[];
  flags?: number;
  pathCode?: number;
  memberCode?: number;
}

/** The unit of transfer. */
export interface Message {
  version: 2 | 4;
  flags?: number;
  /** 16 bytes each; undefined where format 4 leaves routing out. */
  senderNode?: Uint8Array;
  receiverNode?: Uint8Array;
  senderName?: string;
  receiverName?: string;
  /** Undefined where format 4 leaves endpoints out. */
  senderEndpoint?: number;
  receiverEndpoint?: number;
  priority?: number;
  metadata?: string;
  messageId?: number;
  messageResId?: number;
  strings?: [number, string][];
  extended?: Uint8Array;
  entries: MessageEntry[];
}

/** Flags of a header of format 4 (02, section 2). */
export const HeaderFlag = {
  routing: 0x01,
  endpoints: 0x02,
  priority: 0x04,
  meta: 0x10,
  stringTable: 0x20,
  multipleEntries: 0x40,
  extended: 0x80,
} as const;

/** Flags of an entry of format 4 (02, section 3). */
export const EntryFlag = {
  path: 0x01,
  pathCode: 0x02,
  member: 0x04,
  memberCode: 0x08,
  requestId: 0x10,
  error: 0x20,
  meta: 0x40,
  extended: 0x80,
} as const;

/** Flags of an element of format 4 (02, section 4). */
export const ElementFlag = {
  name: 0x01,
  nameCode: 0x02,
  number: 0x04,
  typeName: 0x08,
  typeNameCode: 0x10,
  meta: 0x20,
  extended: 0x80,
} as const;

/** `RRAC`, the first four bytes of a message, as they are read. */
export const magic = 0x43415252;

/** What a reader takes; more is a {@link FormatError}. */
export interface CodecLimits {
  /** Elements in each other. */
  depth: number;
  /** Elements of a message, nested ones included. */
  elements: number;
}

export const defaultCodecLimits: CodecLimits = { depth: 64, elements: 500_000 };

export interface ReadOptions {
  /** Whether codes of the predefined table may come (02, section 6). */
  stringTable?: boolean;
  limits?: CodecLimits;
  /** For tools: an unknown code becomes the text `?code` instead of an error. */
  keepUnknownCodes?: boolean;
}
