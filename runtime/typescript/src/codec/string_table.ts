// SPDX-License-Identifier: Apache-2.0
// Codes for frequent strings (02, section 6).
import { FormatError } from "./format_error.js";
import { textLength } from "./text.js";
import { EntryFlag, ElementFlag, type Message, type MessageElement, type MessageEntry } from "./message.js";
import { elementFlags, entryFlags } from "./flags.js";
import { varUintSize } from "./byte_writer.js";
import { standardStrings } from "./standard_strings.js";

const codeOf = new Map<string, number>();
const textOf = new Map<number, string>();
for (const [code, text] of standardStrings) {
  textOf.set(code, text);
  // Two strings are there twice; the lower code is for writing.
  if (!codeOf.has(text)) codeOf.set(text, code);
}

const longestText = 128;
const largestTable = 1024;
const mostStrings = 256;

/** Resolves the codes of one message. */
export class CodeReader {
  private readonly local = new Map<number, string>();

  constructor(
    private readonly hasStandardTable: boolean,
    private readonly keepsUnknown: boolean,
  ) {}

  add(code: number, text: string): void {
    if (this.local.size >= mostStrings) throw new FormatError("a string table is too long");
    if (!this.local.has(code)) this.local.set(code, text);
  }

  text(code: number): string {
    let text: string | undefined;
    if (code % 2 === 1) {
      text = this.local.get(code);
    } else if (this.hasStandardTable) {
      text = textOf.get(code);
    }
    if (text === undefined) {
      if (this.keepsUnknown) return `?${code}`;
      throw new FormatError(`the string code ${code} is unknown`);
    }
    return text;
  }
}

/** Which codes a connection may use when it sends. */
export interface CodesInUse {
  standard: boolean;
  local: boolean;
}

/**
 * A message of format 4 with codes for strings, in the order that the protocol says. The given one stays as it
 * is: its elements may be on their way to others, too.
 */
export function useCodes(message: Message, codes: CodesInUse): Message {
  const table = new CodeWriter(codes);
  const entries = message.entries.map((entry) => codeEntry(entry, table));
  return table.strings.length > 0 ? { ...message, entries, strings: table.strings } : { ...message, entries };
}

/** Finds and gives codes for the strings of one message. */
class CodeWriter {
  readonly strings: [number, string][] = [];
  private readonly known = new Map<string, number>();
  private size = 0;

  constructor(private readonly codes: CodesInUse) {}

  /** Undefined for a string that stays as it is. */
  code(text: string): number | undefined {
    if (text.length > longestText) return undefined;
    const length = textLength(text);
    if (length > longestText) return undefined;
    const standard = this.codes.standard ? codeOf.get(text) : undefined;
    if (standard !== undefined || !this.codes.local) return standard;
    const has = this.known.get(text);
    if (has !== undefined) return has;
    const code = 2 * this.strings.length + 1;
    const added = varUintSize(code) + varUintSize(length) + length;
    if (this.size + added > largestTable || this.strings.length >= mostStrings) return undefined;
    this.size += added;
    this.known.set(text, code);
    this.strings.push([code, text]);
    return code;
  }
}

function codeEntry(entry: MessageEntry, table: CodeWriter): MessageEntry {
  const coded = { ...entry };
  let flags = entryFlags(entry);
  const member = table.code(entry.member);
  if (member !== undefined) {
    coded.memberCode = member;
    flags = (flags & ~EntryFlag.member) | EntryFlag.memberCode;
  }
  const path = table.code(entry.path);
  if (path !== undefined) {
    coded.pathCode = path;
    flags = (flags & ~EntryFlag.path) | EntryFlag.pathCode;
  }
  coded.flags = flags;
  coded.elements = entry.elements.map((element) => codeElement(element, table));
  return coded;
}

function codeElement(element: MessageElement, table: CodeWriter): MessageElement {
  const coded = { ...element };
  let flags = elementFlags(element);
  const name = flags & ElementFlag.name ? table.code(element.name ?? "") : undefined;
  if (name !== undefined) {
    coded.nameCode = name;
    flags = (flags & ~ElementFlag.name) | ElementFlag.nameCode;
  }
  const typeName = flags & ElementFlag.typeName ? table.code(element.typeName) : undefined;
  if (typeName !== undefined) {
    coded.typeNameCode = typeName;
    flags = (flags & ~ElementFlag.typeName) | ElementFlag.typeNameCode;
  }
  coded.flags = flags;
  if (element.elements) coded.elements = element.elements.map((nested) => codeElement(nested, table));
  return coded;
}
