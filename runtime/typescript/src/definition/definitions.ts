// SPDX-License-Identifier: Apache-2.0
// A set of definitions with their names resolved: what clients and services read and write values by.
import { ErrorCode, makeError } from "../errors.js";
import { definitionError } from "./definition_error.js";
import { parseDefinition } from "./parse.js";
import { parseType } from "./parse_member.js";
import { Scanner } from "./scanner.js";
import type { WrittenBlock, WrittenDefinition, WrittenMember, WrittenType } from "./syntax.js";
import {
  makeType,
  numberTypes,
  voidType,
  type BaseType,
  type EnumType,
  type Field,
  type Member,
  type NumberName,
  type ObjectType,
  type RecordType,
  type ValueType,
} from "./types.js";

const largestNamedArray = 0x1000000;
const deepestRecord = 256;

/** Definitions that are known together, by name. Added in any order; names are looked up at first use. */
export class Definitions {
  private readonly written = new Map<string, WrittenDefinition>();
  private readonly blocks = new Map<string, { definition: WrittenDefinition; block: WrittenBlock }>();
  private readonly records = new Map<string, RecordType>();
  private readonly objects = new Map<string, ObjectType>();
  private readonly enums = new Map<string, EnumType>();
  private readonly exceptions = new Set<string>();
  private readonly unfinished = new Set<string>();

  /** Parses each text; one whose name is known already changes nothing. Throws ServiceDefinitionError. */
  constructor(texts: Iterable<string> = []) {
    for (const text of texts) this.add(text);
  }

  /** Parses a text; one whose name is known already changes nothing. Throws ServiceDefinitionError. */
  add(text: string): WrittenDefinition {
    const definition = parseDefinition(text);
    const known = this.written.get(definition.name);
    if (known) return known;
    this.written.set(definition.name, definition);
    for (const block of definition.blocks) this.blocks.set(`${definition.name}.${block.name}`, { definition, block });
    for (const one of definition.enums) {
      const name = `${definition.name}.${one.name}`;
      this.enums.set(name, { name, values: one.values, doc: one.doc });
    }
    for (const one of definition.exceptions) this.exceptions.add(`${definition.name}.${one.name}`);
    return definition;
  }

  /** Undefined for a definition that is not known. */
  find(name: string): WrittenDefinition | undefined {
    return this.written.get(name);
  }

  /** Whether there is a definition of this name. */
  has(name: string): boolean {
    return this.written.has(name);
  }

  /** The names of all definitions. */
  names(): string[] {
    return [...this.written.keys()];
  }

  /** Whether an exception of this qualified name is declared. */
  hasException(name: string): boolean {
    return this.exceptions.has(name);
  }

  /** Imports, direct and further ones, that are not known. */
  missingImports(): string[] {
    const missing = new Set<string>();
    for (const definition of this.written.values()) {
      for (const name of definition.imports) if (!this.written.has(name)) missing.add(name);
    }
    return [...missing];
  }

  /** The definition and all it imports that are known, sorted by name. */
  withImports(name: string): WrittenDefinition[] {
    const found = new Map<string, WrittenDefinition>();
    const visit = (one: string): void => {
      const definition = this.written.get(one);
      if (!definition || found.has(one)) return;
      found.set(one, definition);
      definition.imports.forEach(visit);
    };
    visit(name);
    return [...found.values()].sort((a, b) => (a.name < b.name ? -1 : 1));
  }

  /** Throws ServiceError for an unknown definition or type, InvalidArgument for a name without a dot. */
  record(name: string): RecordType {
    const known = this.records.get(name);
    if (known) {
      // Only structs may contain themselves; others could not be measured.
      if (known.kind !== "struct" && this.unfinished.has(name)) {
        throw makeError(ErrorCode.ServiceDefinitionError, `${name} contains itself`);
      }
      return known;
    }
    const { definition, block } = this.block(name);
    if (block.kind === "object") throw makeError(ErrorCode.ServiceError, `${name} is an object`);
    const fields: Field[] = [];
    const record: RecordType = { kind: block.kind, name, fields, doc: block.doc };
    // Known before its fields are, which may be of the struct itself.
    this.records.set(name, record);
    try {
      this.unfinished.add(name);
      if (this.unfinished.size > deepestRecord) throw definitionError(block.line, "types are nested too deeply");
      for (const field of block.members) {
        fields.push({ name: field.name, type: this.resolve(field.type, definition, field.line), doc: field.doc });
      }
      if (block.kind === "namedarray") this.countNumbers(record, block);
    } catch (error) {
      this.records.delete(name);
      throw error;
    } finally {
      this.unfinished.delete(name);
    }
    return record;
  }

  /** Throws as {@link record} does. */
  object(name: string): ObjectType {
    const known = this.objects.get(name);
    if (known) return known;
    const { definition, block } = this.block(name);
    if (block.kind !== "object") throw makeError(ErrorCode.ServiceError, `${name} is no object`);
    const members = new Map<string, Member>();
    for (const member of block.members) {
      if (!members.has(member.name)) members.set(member.name, this.member(member, block, definition));
    }
    const written = block.implements.map((one) => definition.aliases.get(one) ?? one);
    const object: ObjectType = { name, doc: block.doc, implements: written, members };
    this.objects.set(name, object);
    return object;
  }

  /** Whether an object of this qualified name is declared. */
  hasObject(name: string): boolean {
    return this.blocks.get(name)?.block.kind === "object";
  }

  /** The type that a text names, as `double[*]`, `a.b.C{list}` or `varvalue`. Names are qualified. */
  type(text: string): ValueType {
    const scanner = new Scanner(text, 1);
    const written = parseType(scanner);
    scanner.end();
    return this.resolve(written, undefined, 1);
  }

  /** Whether an object type is another one or implements it, directly or through others. */
  isKindOf(name: string, wanted: string): boolean {
    const seen = new Set([name]);
    // A set gives what is added to it while it is walked through.
    for (const one of seen) {
      if (one === wanted) return true;
      const found = this.blocks.get(one);
      if (found?.block.kind !== "object") continue;
      for (const base of found.block.implements) seen.add(qualified(base, found.definition));
    }
    return false;
  }

  private block(name: string): { definition: WrittenDefinition; block: WrittenBlock } {
    const dot = name.lastIndexOf(".");
    if (dot < 0) throw makeError(ErrorCode.InvalidArgument, `"${name}" is no qualified name of a type`);
    const found = this.blocks.get(name);
    if (found) return found;
    throw makeError(
      ErrorCode.ServiceError,
      this.written.has(name.slice(0, dot)) ? `there is no type ${name}` : `the definition ${name.slice(0, dot)} is not known`,
    );
  }

  private base(name: string, definition: WrittenDefinition | undefined): BaseType {
    if (name === "void" || name === "string") return { kind: name };
    if (name === "varvalue") return { kind: "any" };
    if (Object.hasOwn(numberTypes, name)) return { kind: "number", number: name as NumberName };
    const whole = definition ? qualified(name, definition) : name;
    const found = this.enums.get(whole);
    if (found) return { kind: "enum", enum: found };
    return { kind: "record", record: this.record(whole) };
  }

  private resolve(written: WrittenType, definition: WrittenDefinition | undefined, line: number): ValueType {
    if (written.container === "generator") throw definitionError(line, "a generator is no value");
    return makeType(this.base(written.base, definition), written.array, written.container);
  }

  private member(written: WrittenMember, block: WrittenBlock, definition: WrittenDefinition): Member {
    const has = (modifier: string): boolean => written.modifiers.includes(modifier);
    const isReadonly = has("readonly");
    const kind = written.kind === "field" ? "property" : written.kind;
    const parameters = written.parameters.map(({ name, type }) => ({ name, type }));
    const last = parameters.at(-1);
    const takes = last?.type.container === "generator" ? last.type : undefined;
    if (takes) parameters.pop();
    const gives = written.type.container === "generator";
    const step = (type: WrittenType): ValueType => this.resolve({ ...type, container: "none" }, definition, written.line);
    const isObjref = kind === "objref";
    const isIndexed = written.type.array.kind !== "scalar" || written.type.container === "int32";
    return {
      kind,
      name: written.name,
      doc: written.doc,
      type: isObjref ? voidType : gives ? step(written.type) : this.resolve(written.type, definition, written.line),
      parameters: parameters.map(({ name, type }) => ({ name, type: this.resolve(type, definition, written.line) })),
      ...(gives || takes ? { generator: takes ? { gives, takes: step(takes) } : { gives } } : {}),
      objectType: isObjref && written.type.base !== "varobject" ? qualified(written.type.base, definition) : "",
      index: !isObjref ? "none" : written.type.container === "string" ? "string" : isIndexed ? "int32" : "none",
      isReadonly,
      isWriteonly: !isReadonly && has("writeonly"),
      isUnreliable: has("unreliable") || block.unreliablePipes.has(written.name),
      nolock: has("nolock"),
      nolockread: has("nolockread"),
    };
  }

  private countNumbers(record: RecordType, block: WrittenBlock): void {
    let count = 0;
    for (const { name, type } of record.fields) {
      const { base, array } = type;
      const times = array.kind === "scalar" ? 1 : array.kind === "array" && !array.isMaximum ? array.length : undefined;
      const one = base.kind === "number" ? { number: base.number, count: 1 } : base.kind === "record" ? base.record : undefined;
      if (times === undefined || one?.number === undefined || one.count === undefined || type.container !== "none") {
        throw definitionError(block.line, `the field ${name} of ${record.name} is of no type for a namedarray`);
      }
      if (record.number !== undefined && record.number !== one.number) {
        throw definitionError(block.line, `the fields of ${record.name} are of several types`);
      }
      record.number = one.number;
      count += times * one.count;
      if (count > largestNamedArray) throw definitionError(block.line, `${record.name} is too large`);
    }
    if (count === 0) throw definitionError(block.line, `${record.name} has no fields`);
    record.count = count;
  }
}

/** Aliases stand for names of other definitions; a name without a dot is one of the definition itself. */
export function qualified(name: string, definition: WrittenDefinition): string {
  const known = definition.aliases.get(name) ?? name;
  return known.includes(".") ? known : `${definition.name}.${known}`;
}
