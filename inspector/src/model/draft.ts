// SPDX-License-Identifier: Apache-2.0
// What forms edit: the texts and choices of a value before it is known to be one.
import { MultiDimArray, VarValue, type BaseType, type Complex, type Definitions, type NumberName, type ValueType } from "@robdef/runtime";
import { isBounded, item, rowType, type RecordDeclaration } from "./types.js";

/** A value under edit. Its shape follows the type that it is for. */
export type Draft =
  | { readonly kind: "null" }
  /** A number, a string, or numbers in a row. */
  | { readonly kind: "text"; readonly text: string }
  | { readonly kind: "bool"; readonly on: boolean }
  | { readonly kind: "record"; readonly fields: Readonly<Record<string, Draft>> }
  | { readonly kind: "items"; readonly items: readonly Draft[] }
  | { readonly kind: "map"; readonly items: readonly { readonly key: string; readonly value: Draft }[] }
  /** Several dimensions: numbers as lines of a matrix, or in a row for another number of dimensions. */
  | { readonly kind: "block"; readonly dims: string; readonly text: string }
  | { readonly kind: "any"; readonly type: string; readonly value: Draft };

/** Why a part of a draft is no value. */
export interface Problem {
  /** As `pose.position.x` or `items[2]`; empty for the whole. */
  readonly where: string;
  readonly text: string;
}

/** Numbers whose size is known, and what they hold. */
const ranges: Readonly<Partial<Record<NumberName, readonly [bigint, bigint]>>> = {
  int8: [-128n, 127n],
  uint8: [0n, 255n],
  int16: [-32768n, 32767n],
  uint16: [0n, 65535n],
  int32: [-2147483648n, 2147483647n],
  uint32: [0n, 4294967295n],
  int64: [-(2n ** 63n), 2n ** 63n - 1n],
  uint64: [0n, 2n ** 64n - 1n],
};

/** What a whole number of this kind may be, for hints; undefined for others. */
export function rangeOf(number: NumberName): readonly [bigint, bigint] | undefined {
  return ranges[number];
}

/** Whether null may stand in the place of a value. */
export function mayBeNull(type: ValueType): boolean {
  return type.container !== "none" || type.base.kind === "any" || (type.base.kind === "record" && type.base.record.kind === "struct");
}

/** A draft for a value that is to be made up. Structs are filled in to a depth, and null below it. */
export function emptyDraft(type: ValueType, depth = 0): Draft {
  if (type.container === "list") return { kind: "items", items: [] };
  if (type.container !== "none") return { kind: "map", items: [] };
  const { base, array } = type;
  if (base.kind === "any") return { kind: "null" };
  if (array.kind === "dims") {
    const dims = array.dims ?? [0, 0];
    return { kind: "block", dims: dims.join(" x "), text: base.kind === "number" ? zeros(dims, base.number) : emptyItems(type, dims) };
  }
  if (array.kind === "array") {
    const count = array.isMaximum ? 0 : (array.length ?? 0);
    if (base.kind === "number") return { kind: "text", text: new Array<string>(count).fill(zeroText(base.number)).join(", ") };
    return { kind: "items", items: Array.from({ length: count }, () => emptyDraft(item(type), depth + 1)) };
  }
  switch (base.kind) {
    case "number":
      return base.number === "bool" ? { kind: "bool", on: false } : { kind: "text", text: zeroText(base.number) };
    case "enum":
      return { kind: "text", text: String(base.enum.values[0]?.value ?? 0) };
    case "record":
      if (base.record.kind === "struct" && depth > 4) return { kind: "null" };
      return { kind: "record", fields: Object.fromEntries(base.record.fields.map((field) => [field.name, emptyDraft(field.type, depth + 1)])) };
    default:
      return { kind: "text", text: "" };
  }
}

/** Pods and namedarrays of fixed dimensions, as the JSON that they are edited as. */
function emptyItems(type: ValueType, dims: readonly number[]): string {
  const one = emptyDraft(item(type));
  const count = dims.length === 0 ? 0 : dims.reduce((all, dim) => all * dim, 1);
  return `[${new Array<string>(count).fill(JSON.stringify(plainDraft(one, item(type)))).join(",\n")}]`;
}

function plainDraft(draft: Draft, type: ValueType): unknown {
  if (draft.kind === "record" && type.base.kind === "record") {
    return Object.fromEntries(type.base.record.fields.map((field) => [field.name, plainDraft(draft.fields[field.name] ?? { kind: "null" }, field.type)]));
  }
  if (draft.kind === "items") return draft.items.map((one) => plainDraft(one, item(type)));
  if (draft.kind === "block") return draft.text.startsWith("[") ? JSON.parse(draft.text) : splitNumbers(draft.text).map(Number);
  if (draft.kind !== "text") return draft.kind === "bool" ? draft.on : null;
  return type.array.kind === "array" ? splitNumbers(draft.text).map(Number) : Number(draft.text);
}

function zeroText(number: NumberName): string {
  return number === "bool" ? "false" : "0";
}

function zeros(dims: readonly number[], number: NumberName): string {
  const one = zeroText(number);
  if (dims.length !== 2) return new Array<string>(dims.reduce((all, dim) => all * dim, dims.length === 0 ? 0 : 1)).fill(one).join(", ");
  return Array.from({ length: dims[0] ?? 0 }, () => new Array<string>(dims[1] ?? 0).fill(one).join(", ")).join("\n");
}

/** A number as forms and texts show it; {@link parseNumber} gives the same again. */
export function numberText(value: unknown): string {
  if (typeof value === "object" && value !== null && "re" in value) {
    const { re, im } = value as Complex;
    return `${plain(re)}${Object.is(im, -0) || im < 0 ? "-" : "+"}${plain(Math.abs(im))}i`;
  }
  return typeof value === "number" ? plain(value) : String(value);
}

function plain(value: number): string {
  return Object.is(value, -0) ? "-0" : String(value);
}

const decimal = /^[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?$/;
const complex = /^([+-]?(?:Infinity|NaN|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?))([+-](?:Infinity|NaN|(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?))[ij]$/;
const special: Readonly<Record<string, number>> = { nan: NaN, infinity: Infinity, "+infinity": Infinity, inf: Infinity, "+inf": Infinity, "-infinity": -Infinity, "-inf": -Infinity };

/** A number of this kind, or the words that say why the text is none. */
export function parseNumber(number: NumberName, written: string): { readonly value: number | bigint | boolean | Complex } | { readonly why: string } {
  const text = written.trim();
  if (text === "") return { why: "a number is missing" };
  if (number === "bool") {
    if (/^(?:true|1)$/i.test(text)) return { value: true };
    return /^(?:false|0)$/i.test(text) ? { value: false } : { why: `"${short(text)}" is neither true nor false` };
  }
  if (number === "cdouble" || number === "csingle") {
    const match = complex.exec(text.replaceAll(" ", ""));
    if (match) return { value: { re: real(match[1] ?? ""), im: real(match[2] ?? "") } };
    const one = realOf(text);
    return one === undefined ? { why: `"${short(text)}" is no complex number such as 1.5-2i` } : { value: { re: one, im: 0 } };
  }
  const range = ranges[number];
  if (!range) {
    const one = realOf(text);
    return one === undefined ? { why: `"${short(text)}" is no number` } : { value: one };
  }
  const whole = wholeOf(text);
  if (whole === undefined) return { why: `"${short(text)}" is no whole number` };
  const [low, high] = range;
  if (whole < low || whole > high) return { why: `${short(text)} is not from ${low} to ${high}, as ${number} is` };
  return { value: number === "int64" || number === "uint64" ? whole : Number(whole) };
}

function real(text: string): number {
  return special[text.toLowerCase()] ?? Number(text);
}

function realOf(text: string): number | undefined {
  if (decimal.test(text)) return Number(text);
  const found = special[text.toLowerCase()];
  if (found !== undefined) return found;
  return /^0[xX][0-9a-fA-F]+$/.test(text) ? Number(text) : undefined;
}

function wholeOf(text: string): bigint | undefined {
  if (/^[+-]?\d{1,40}$/.test(text)) return BigInt(text.replace("+", ""));
  if (/^0[xX][0-9a-fA-F]{1,32}$/.test(text)) return BigInt(text);
  const value = decimal.test(text) ? Number(text) : NaN;
  return Number.isSafeInteger(value) ? BigInt(value) : undefined;
}

function short(text: string): string {
  return text.length > 40 ? `${text.slice(0, 40)}…` : text;
}

/** The texts of numbers in a row: separated by commas, semicolons or blanks; brackets are left out. */
export function splitNumbers(text: string): string[] {
  return text
    .replace(/[[\]{}()]/g, " ")
    .split(/[\s,;]+/)
    .filter((one) => one !== "");
}

/** A value as a draft. Numbers are written so that nothing is lost. */
export function draftOf(type: ValueType, value: unknown): Draft {
  if (value === null || value === undefined) return mayBeNull(type) ? { kind: "null" } : emptyDraft(type);
  if (type.container === "list") return { kind: "items", items: Array.from(value as ArrayLike<unknown>, (one) => draftOf(item(type), one)) };
  if (type.container !== "none") {
    const map = value as ReadonlyMap<string | number, unknown>;
    return { kind: "map", items: Array.from(map, ([key, one]) => ({ key: String(key), value: draftOf(item(type), one) })) };
  }
  const { base, array } = type;
  if (base.kind === "any") {
    return { kind: "any", type: (value as VarValue).type, value: { kind: "text", text: "" } };
  }
  if (array.kind === "dims") {
    const { dims, array: items } = value as MultiDimArray;
    return { kind: "block", dims: dims.join(" x "), text: blockText(base, dims, items) };
  }
  if (array.kind === "array") {
    const row = value as ArrayLike<unknown>;
    if (base.kind === "number") return { kind: "text", text: Array.from(row, numberText).join(", ") };
    return { kind: "items", items: Array.from(row, (one) => draftOf(item(type), one)) };
  }
  switch (base.kind) {
    case "number":
      return base.number === "bool" ? { kind: "bool", on: value === true } : { kind: "text", text: numberText(value) };
    case "record": {
      const fields = value as Readonly<Record<string, unknown>>;
      return { kind: "record", fields: Object.fromEntries(base.record.fields.map((field) => [field.name, draftOf(field.type, fields[field.name])])) };
    }
    default:
      return { kind: "text", text: String(value) };
  }
}

/** The same, with the contents of varvalues, whose types the definitions name. */
export function fullDraft(definitions: Definitions, type: ValueType, value: unknown): Draft {
  const draft = draftOf(type, value);
  return completed(definitions, type, value, draft);
}

function completed(definitions: Definitions, type: ValueType, value: unknown, draft: Draft): Draft {
  if (draft.kind === "any") {
    const any = value as VarValue;
    try {
      return { ...draft, value: fullDraft(definitions, definitions.type(any.type), any.value) };
    } catch {
      return { kind: "null" };
    }
  }
  if (draft.kind === "items") {
    const row = value as ArrayLike<unknown>;
    return { kind: "items", items: draft.items.map((one, i) => completed(definitions, item(type), row[i], one)) };
  }
  if (draft.kind === "map") {
    const values = [...(value as ReadonlyMap<unknown, unknown>).values()];
    return { kind: "map", items: draft.items.map((one, i) => ({ key: one.key, value: completed(definitions, item(type), values[i], one.value) })) };
  }
  if (draft.kind === "record" && type.base.kind === "record") {
    const fields = value as Readonly<Record<string, unknown>>;
    const made = type.base.record.fields.map((field) => [field.name, completed(definitions, field.type, fields[field.name], draft.fields[field.name] ?? { kind: "null" })] as const);
    return { kind: "record", fields: Object.fromEntries(made) };
  }
  return draft;
}

function blockText(base: BaseType, dims: readonly number[], items: ArrayLike<unknown>): string {
  const texts = base.kind === "number" ? Array.from(items, numberText) : Array.from(items, (one) => JSON.stringify(plainOf(base, one)));
  if (base.kind !== "number") return `[${texts.join(",\n")}]`;
  if (dims.length !== 2) return texts.join(", ");
  const [rows = 0, columns = 0] = dims;
  return Array.from({ length: rows }, (_, r) => Array.from({ length: columns }, (_, c) => texts[r + c * rows] ?? "").join(", ")).join("\n");
}

/** Pods and namedarrays of blocks are edited as JSON: numbers as texts where JSON has none for them. */
function plainOf(base: BaseType, value: unknown): unknown {
  if (base.kind !== "record") return typeof value === "bigint" || (typeof value === "number" && (!Number.isFinite(value) || Object.is(value, -0))) ? numberText(value) : value;
  const fields = value as Readonly<Record<string, unknown>>;
  return Object.fromEntries(base.record.fields.map((field) => [field.name, plainField(field.type, fields[field.name])]));
}

function plainField(type: ValueType, value: unknown): unknown {
  if (type.array.kind === "scalar") return plainOf(type.base, value);
  const row = type.array.kind === "dims" ? (value as MultiDimArray).array : (value as ArrayLike<unknown>);
  return Array.from(row, (one) => plainOf(type.base, one));
}

/** Reads drafts as values of the types of some definitions. */
export class DraftReader {
  readonly problems: Problem[] = [];

  constructor(private readonly definitions: Definitions) {}

  /** The value; meaningless once there are problems. */
  value(type: ValueType, draft: Draft, where = ""): unknown {
    if (draft.kind === "null") {
      if (!mayBeNull(type)) this.fail(where, "a value is missing");
      return null;
    }
    if (type.container !== "none") return this.container(type, draft, where);
    const { base, array } = type;
    if (base.kind === "any") return this.any(draft, where);
    if (array.kind === "dims") return this.block(type, draft, where);
    if (array.kind === "array") return this.row(type, draft, where);
    switch (base.kind) {
      case "number":
        return this.number(base.number, draft, where);
      case "enum":
        return this.enumValue(base, draft, where);
      case "record":
        return this.record(base.record, draft, where);
      default:
        return draft.kind === "text" ? draft.text : this.fail(where, "a text is missing");
    }
  }

  private fail(where: string, text: string): unknown {
    this.problems.push({ where, text });
    return undefined;
  }

  private number(number: NumberName, draft: Draft, where: string): unknown {
    if (draft.kind === "bool") return draft.on;
    return draft.kind === "text" ? this.parsed(number, draft.text, where) : this.fail(where, "a number is missing");
  }

  private parsed(number: NumberName, text: string, where: string): unknown {
    const read = parseNumber(number, text);
    return "why" in read ? this.fail(where, read.why) : read.value;
  }

  private enumValue(base: BaseType & { kind: "enum" }, draft: Draft, where: string): unknown {
    if (draft.kind !== "text") return this.fail(where, "a choice is missing");
    const named = base.enum.values.find((one) => one.name === draft.text);
    return named ? named.value : this.parsed("int32", draft.text, where);
  }

  private record(record: RecordDeclaration, draft: Draft, where: string): unknown {
    if (draft.kind !== "record") return this.fail(where, `the fields of ${record.name} are missing`);
    const value: Record<string, unknown> = {};
    for (const field of record.fields) {
      value[field.name] = this.value(field.type, draft.fields[field.name] ?? emptyDraft(field.type), where === "" ? field.name : `${where}.${field.name}`);
    }
    return value;
  }

  private row(type: ValueType, draft: Draft, where: string): unknown {
    const { base, array } = type;
    if (base.kind !== "number") {
      if (draft.kind !== "items") return this.fail(where, "items are missing");
      this.count(type, draft.items.length, where);
      return draft.items.map((one, i) => this.value(item(type), one, `${where}[${i}]`));
    }
    if (draft.kind !== "text") return this.fail(where, "numbers are missing");
    // Complex numbers may have blanks inside.
    const texts = base.number.startsWith("c") ? draft.text.split(/[,;\n]/).filter((one) => one.trim() !== "") : splitNumbers(draft.text);
    if (array.kind === "array") this.count(type, texts.length, where);
    return rowType(base.number, texts.map((text, i) => this.parsed(base.number, text, texts.length === 1 ? where : `${where}[${i}]`)));
  }

  private count(type: ValueType, count: number, where: string): void {
    const { array } = type;
    if (array.kind !== "array" || array.length === undefined) return;
    if (array.isMaximum ? count > array.length : count !== array.length) {
      this.fail(where, `${count} items, where ${array.isMaximum ? "at most " : ""}${array.length} are wanted`);
    }
  }

  private block(type: ValueType, draft: Draft, where: string): unknown {
    if (draft.kind !== "block") return this.fail(where, "a block is missing");
    const { base, array } = type;
    const wanted = array.kind === "dims" ? array.dims : undefined;
    if (base.kind !== "number") return this.jsonBlock(base, draft, wanted, where);
    const rows = draft.text
      .split(/[\n;]/)
      .map(splitNumbers)
      .filter((row) => row.length > 0);
    const flat = rows.flat();
    const written = (draft.dims.match(/\d+/g) ?? []).map(Number);
    const isMatrix = wanted ? wanted.length === 2 : written.length === 2;
    // Without numbers there are no lines to be counted.
    const isEmpty = flat.length === 0 && written.includes(0);
    const dims = wanted ?? (isMatrix && !isEmpty ? [rows.length, rows[0]?.length ?? 0] : written);
    const count = dims.length === 0 ? 0 : dims.reduce((all, dim) => all * dim, 1);
    if (flat.length !== count) return this.fail(where, `${flat.length} numbers, where ${dims.join(" x ")} are ${count}`);
    if (isMatrix && count > 0 && (rows.length !== dims[0] || rows.some((row) => row.length !== dims[1]))) {
      return this.fail(where, `a matrix of ${dims.join(" x ")} has ${dims[0] ?? 0} lines of ${dims[1] ?? 0} numbers`);
    }
    const [height = 0, width = 0] = dims;
    const texts = isMatrix ? Array.from({ length: count }, (_, i) => rows[i % height]?.[Math.floor(i / height)] ?? "") : flat;
    const place = (i: number): string => `${where}[${isMatrix ? `${i % height}, ${Math.floor(i / height)}` : i}]`;
    const values = texts.map((text, i) => this.parsed(base.number, text, place(i)));
    return new MultiDimArray(dims, rowType(base.number, values, width > 0));
  }

  private jsonBlock(base: BaseType, draft: Draft & { kind: "block" }, wanted: readonly number[] | undefined, where: string): unknown {
    let items: unknown;
    try {
      items = JSON.parse(draft.text === "" ? "[]" : draft.text);
    } catch (error) {
      return this.fail(where, `no JSON: ${error instanceof Error ? error.message : ""}`);
    }
    const dims = wanted ?? (draft.dims.match(/\d+/g) ?? []).map(Number);
    const count = dims.length === 0 ? 0 : dims.reduce((all, dim) => all * dim, 1);
    if (!Array.isArray(items) || items.length !== count) return this.fail(where, `an array of ${count} items, ${dims.join(" x ")}, is wanted`);
    return new MultiDimArray(dims, items.map((one, i) => this.fromPlain(base, one, `${where}[${i}]`)));
  }

  private fromPlain(base: BaseType, value: unknown, where: string): unknown {
    if (base.kind === "number") return this.parsed(base.number, typeof value === "object" ? "" : String(value), where);
    if (base.kind !== "record" || typeof value !== "object" || value === null) return this.fail(where, "fields are missing");
    const given = value as Readonly<Record<string, unknown>>;
    const made: Record<string, unknown> = {};
    for (const field of base.record.fields) {
      const part = given[field.name];
      const { array } = field.type;
      if (array.kind === "scalar") made[field.name] = this.fromPlain(field.type.base, part, `${where}.${field.name}`);
      else if (!Array.isArray(part)) this.fail(`${where}.${field.name}`, "an array is missing");
      else {
        const row = part.map((one, i) => this.fromPlain(field.type.base, one, `${where}.${field.name}[${i}]`));
        const items = field.type.base.kind === "number" ? rowType(field.type.base.number, row) : row;
        made[field.name] = array.kind === "dims" && array.dims ? this.blockOf(array.dims, items, `${where}.${field.name}`) : items;
        if (array.kind === "array" && isBounded(array)) this.count(field.type, row.length, `${where}.${field.name}`);
      }
    }
    return made;
  }

  private blockOf(dims: readonly number[], items: ArrayLike<unknown>, where: string): unknown {
    try {
      return new MultiDimArray(dims, items);
    } catch (error) {
      return this.fail(where, error instanceof Error ? error.message : String(error));
    }
  }

  private container(type: ValueType, draft: Draft, where: string): unknown {
    if (type.container === "list") {
      if (draft.kind !== "items") return this.fail(where, "items are missing");
      return draft.items.map((one, i) => this.value(item(type), one, `${where}[${i}]`));
    }
    if (draft.kind !== "map") return this.fail(where, "items are missing");
    const map = new Map<string | number, unknown>();
    for (const [i, one] of draft.items.entries()) {
      const key = type.container === "string" ? one.key : this.parsed("int32", one.key, `${where}{${i}}`);
      if (typeof key !== "string" && typeof key !== "number") continue;
      if (map.has(key)) this.fail(`${where}{${i}}`, `the key ${key} is there twice`);
      map.set(key, this.value(item(type), one.value, `${where}[${key}]`));
    }
    return map;
  }

  private any(draft: Draft, where: string): unknown {
    if (draft.kind !== "any") return this.fail(where, "a type is missing");
    let type: ValueType;
    try {
      type = this.definitions.type(draft.type.trim());
    } catch (error) {
      return this.fail(where, error instanceof Error ? error.message : String(error));
    }
    if (type.base.kind === "void" || (type.base.kind === "any" && type.container === "none")) return this.fail(where, `${type.text} is no type for a value`);
    return new VarValue(type.text, this.value(type, draft.value, where));
  }
}
