// SPDX-License-Identifier: Apache-2.0
// Reads the text of a service definition. Reports the first mistake with its line; rules that need other
// definitions are checked when names are resolved.
import { definitionError } from "./definition_error.js";
import { logicalLines, type Line } from "./lines.js";
import { parseConstant, parseEnumValues } from "./parse_constant.js";
import { memberKinds, parseMember } from "./parse_member.js";
import { Scanner } from "./scanner.js";
import type { WrittenBlock, WrittenDefinition, WrittenEnum, WrittenMember } from "./syntax.js";

/** Texts above this are refused, in UTF-16 units. */
export const longestDefinition = 4 * 1024 * 1024;

/** Throws ServiceDefinitionError for a text that is none. */
export function parseDefinition(text: string): WrittenDefinition {
  if (text.length > longestDefinition) throw definitionError(1, "the definition is too long");
  return new Parser(text).parse();
}

type Block = { readonly block: WrittenBlock } | { readonly enum: WrittenEnum; last: number | undefined };

class Parser {
  private readonly definition: WrittenDefinition;
  private readonly lines: Line[];
  private open: Block | undefined;
  private openLine = 0;

  constructor(text: string) {
    this.lines = logicalLines(text.startsWith("\uFEFF") ? text.slice(1) : text);
    this.definition = {
      name: "",
      text,
      version: [],
      doc: this.lines[0]?.doc ?? "",
      imports: [],
      aliases: new Map(),
      exceptions: [],
      constants: [],
      enums: [],
      blocks: [],
    };
  }

  parse(): WrittenDefinition {
    for (const line of this.lines) {
      const scanner = new Scanner(line.text, line.number);
      if (this.open) this.inside(this.open, line, scanner);
      else this.outside(line, scanner);
    }
    if (this.open) throw definitionError(this.openLine, "a block has no end");
    if (this.definition.name === "") throw definitionError(1, "a definition begins with its service line");
    return this.definition;
  }

  private outside(line: Line, scanner: Scanner): void {
    const { definition } = this;
    const keyword = scanner.word();
    if ((definition.name === "") !== (keyword === "service")) {
      scanner.fail("the service line is the first one, and there is one only");
    }
    switch (keyword) {
      case "service":
        scanner.needBlanks();
        definition.name = scanner.dotted("a service");
        scanner.end();
        return;
      case "stdver":
        scanner.needBlanks();
        definition.version = versionOf(scanner.rest(), line.number);
        return;
      case "option":
        this.option(scanner);
        return;
      case "import":
        scanner.needBlanks();
        definition.imports.push(scanner.dotted("a definition"));
        scanner.end();
        return;
      case "using":
        this.using(scanner);
        return;
      case "exception":
        scanner.needBlanks();
        definition.exceptions.push({ name: scanner.name("an exception"), doc: line.doc });
        scanner.end();
        return;
      case "constant":
        definition.constants.push(parseConstant(scanner, line.doc));
        return;
      case "enum":
      case "struct":
      case "pod":
      case "namedarray":
      case "object":
        this.begin(keyword, line, scanner);
        return;
      default:
        scanner.fail(`"${keyword || line.text.slice(0, 20)}" begins no statement`);
    }
  }

  private begin(keyword: "enum" | WrittenBlock["kind"], line: Line, scanner: Scanner): void {
    scanner.needBlanks();
    const name = scanner.name(`${keyword === "enum" || keyword === "object" ? "an" : "a"} ${keyword}`);
    scanner.end();
    this.openLine = line.number;
    const { doc } = line;
    if (keyword === "enum") {
      const made: WrittenEnum = { name, values: [], doc };
      this.definition.enums.push(made);
      this.open = { enum: made, last: undefined };
      return;
    }
    const block: WrittenBlock = {
      kind: keyword,
      name,
      implements: [],
      members: [],
      constants: [],
      unreliablePipes: new Set(),
      doc,
      line: line.number,
    };
    this.definition.blocks.push(block);
    this.open = { block };
  }

  private inside(open: Block, line: Line, scanner: Scanner): void {
    const keyword = scanner.word();
    if (keyword === "end") {
      this.end(open, scanner);
      return;
    }
    if ("enum" in open) {
      open.last = parseEnumValues(line, open.last, open.enum.values);
      return;
    }
    const { block } = open;
    if (keyword === "option") {
      this.blockOption(block, scanner);
    } else if (keyword === "constant") {
      block.constants.push(parseConstant(scanner, line.doc));
    } else if (keyword === "implements" && block.kind === "object") {
      scanner.needBlanks();
      block.implements.push(scanner.dotted("an object"));
      scanner.end();
    } else if (block.kind === "object" ? memberKinds.has(keyword) : keyword === "field") {
      block.members.push(parseMember(scanner, keyword as WrittenMember["kind"], line.doc));
    } else {
      scanner.fail(`"${keyword || line.text.slice(0, 20)}" begins no statement of ${block.kind === "object" ? "an" : "a"} ${block.kind}`);
    }
  }

  private end(open: Block, scanner: Scanner): void {
    scanner.blanks();
    const kind = "enum" in open ? "enum" : open.block.kind;
    const word = scanner.word();
    if (word !== "" && word !== kind) scanner.fail(`"end ${word}" ends no ${kind}`);
    scanner.end();
    this.open = undefined;
  }

  private using(scanner: Scanner): void {
    scanner.needBlanks();
    const name = scanner.dotted("a type");
    if (!name.includes(".")) scanner.fail(`"${name}" is not qualified`);
    let alias = name.slice(name.lastIndexOf(".") + 1);
    if (scanner.blanks() && !scanner.atEnd) {
      if (scanner.word() !== "as") scanner.fail('expected "as"');
      scanner.needBlanks();
      alias = scanner.name("a type");
    }
    scanner.end();
    this.definition.aliases.set(alias, name);
  }

  /** Old statements: only a version and constants have a meaning. */
  private option(scanner: Scanner): void {
    scanner.needBlanks();
    const word = scanner.word();
    if (word === "version") this.definition.version = versionOf(scanner.rest(), scanner.line);
    if (word === "constant") this.definition.constants.push(parseConstant(scanner, ""));
  }

  private blockOption(block: WrittenBlock, scanner: Scanner): void {
    scanner.needBlanks();
    const word = scanner.word();
    if (word === "constant") block.constants.push(parseConstant(scanner, ""));
    if (word !== "pipe") return;
    scanner.blanks();
    const name = scanner.word();
    scanner.blanks();
    if (scanner.word() === "unreliable") block.unreliablePipes.add(name);
  }
}

/** Two to four numbers. */
function versionOf(text: string, line: number): number[] {
  if (!/^\d{1,9}(?:\.\d{1,9}){1,3}$/.test(text.trim())) throw definitionError(line, `"${text.trim().slice(0, 20)}" is no version`);
  return text.trim().split(".").map(Number);
}
