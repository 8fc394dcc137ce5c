// SPDX-License-Identifier: Apache-2.0
// Values as expressions of a language: one walk through the types, and what each language makes of the parts.
import { type MultiDimArray, type BaseType, type Complex, type Definitions, type NumberName, type ValueType, type VarValue } from "@robdef/runtime";
import { item, type RecordDeclaration } from "../model/types.js";

/** How a language writes the parts of values. Parts come written already. */
export interface Printer {
  readonly nothing: string;
  number(value: number | bigint | boolean, number: NumberName): string;
  complex(value: Complex, number: NumberName): string;
  text(value: string): string;
  enumValue(value: number, name: string | undefined, type: string): string;
  numbers(items: readonly string[], number: NumberName): string;
  /** The first index fastest. */
  block(dims: readonly number[], items: readonly string[], base: BaseType): string;
  record(record: RecordDeclaration, fields: readonly (readonly [string, string])[]): string;
  /** Rows of pods and namedarrays. */
  records(items: readonly string[], record: RecordDeclaration): string;
  list(items: readonly string[], type: ValueType): string;
  map(items: readonly (readonly [string | number, string])[], type: ValueType): string;
  any(value: string, type: ValueType): string;
}

/** Bytes of values above this are not written: nobody reads them. */
const mostItems = 5000;

export class TooLarge extends Error {}

export function print(printer: Printer, definitions: Definitions, type: ValueType, value: unknown): string {
  let left = mostItems;
  const count = (items: number): void => {
    left -= items;
    if (left < 0) throw new TooLarge("the values are too large to be written as code");
  };
  const walk = (of: ValueType, one: unknown): string => {
    if (one === null || one === undefined) return printer.nothing;
    if (of.container === "list") {
      const list = one as readonly unknown[];
      count(list.length);
      return printer.list(Array.from(list, (each) => walk(item(of), each)), of);
    }
    if (of.container !== "none") {
      const map = one as ReadonlyMap<string | number, unknown>;
      count(map.size);
      return printer.map(Array.from(map, ([key, each]) => [key, walk(item(of), each)] as const), of);
    }
    const { base, array } = of;
    if (base.kind === "any") {
      const any = one as VarValue;
      const inner = definitions.type(any.type);
      return printer.any(walk(inner, any.value), inner);
    }
    if (array.kind === "scalar") return single(base, one);
    const row = array.kind === "dims" ? (one as MultiDimArray).array : (one as ArrayLike<unknown>);
    count(row.length);
    const items = Array.from(row, (each) => single(base, each));
    if (array.kind === "dims") return printer.block((one as MultiDimArray).dims, items, base);
    return base.kind === "record" ? printer.records(items, base.record) : printer.numbers(items, base.kind === "number" ? base.number : "double");
  };
  const single = (base: BaseType, one: unknown): string => {
    switch (base.kind) {
      case "number":
        return typeof one === "object" ? printer.complex(one as Complex, base.number) : printer.number(one as number, base.number);
      case "enum":
        return printer.enumValue(one as number, base.enum.values.find((each) => each.value === one)?.name, base.enum.name);
      case "record": {
        const fields = one as Readonly<Record<string, unknown>>;
        count(base.record.fields.length);
        return printer.record(base.record, base.record.fields.map((field) => [field.name, walk(field.type, fields[field.name])] as const));
      }
      default:
        return printer.text(one as string);
    }
  };
  return walk(type, value);
}

/** A number with a dot or an exponent, for languages in which whole numbers are of another type. */
export function floating(value: number): string {
  const text = Object.is(value, -0) ? "-0" : String(value);
  return /[.eINn]/.test(text) ? text : `${text}.0`;
}

/** A text between double quotes, for languages that read JSON's escapes. */
export function quoted(text: string): string {
  return JSON.stringify(text).replace(/[\u007f\u2028\u2029\u0085]/g, (one) => `\\u${one.charCodeAt(0).toString(16).padStart(4, "0")}`);
}

/** For comments: one line, and nothing that ends it. */
export function comment(text: string): string {
  return text.replace(/[^\x20-\x7e]+/g, " ");
}

/** `move_to` as `MoveTo`. */
export function pascal(name: string): string {
  return name
    .split("_")
    .map((part) => part.slice(0, 1).toUpperCase() + part.slice(1))
    .join("");
}
