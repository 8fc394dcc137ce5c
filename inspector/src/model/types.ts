// SPDX-License-Identifier: Apache-2.0
// Types of members, as forms and texts need them.
import type { ArrayForm, BaseType, NumberName, ValueType } from "@robdef/runtime";

/** A struct, pod or namedarray as it is declared. */
export type RecordDeclaration = Extract<BaseType, { kind: "record" }>["record"];

const scalar: ArrayForm = { kind: "scalar" };

/** The type of an item of a container, or of a row. */
export function item(type: ValueType): ValueType {
  if (type.container !== "none") return { base: type.base, array: type.array, container: "none", text: type.text.replace(/\{[a-z0-9]+\}$/, "") };
  return { base: type.base, array: scalar, container: "none", text: type.text.replace(/\[[^\]]*\]$/, "") };
}

/** Whether a row has a length that counts. */
export function isBounded(array: ArrayForm): boolean {
  return array.kind === "array" && array.length !== undefined;
}

const makers: Readonly<Partial<Record<NumberName, (items: readonly unknown[]) => ArrayLike<unknown>>>> = {
  double: (items) => Float64Array.from(items as number[]),
  single: (items) => Float32Array.from(items as number[]),
  int8: (items) => Int8Array.from(items as number[]),
  uint8: (items) => Uint8Array.from(items as number[]),
  int16: (items) => Int16Array.from(items as number[]),
  uint16: (items) => Uint16Array.from(items as number[]),
  int32: (items) => Int32Array.from(items as number[]),
  uint32: (items) => Uint32Array.from(items as number[]),
  int64: (items) => BigInt64Array.from(items as bigint[]),
  uint64: (items) => BigUint64Array.from(items as bigint[]),
};

/** Numbers in the array that values of this kind have; as they are when one is missing. */
export function rowType(number: NumberName, items: readonly unknown[], isKnown = true): ArrayLike<unknown> {
  const make = makers[number];
  return !isKnown || !make || items.includes(undefined) ? items : make(items);
}

/** A type as people read it: names without their definition. */
export function shortType(type: ValueType): string {
  return shortName(type.text);
}

/** What a qualified name ends in, with brackets and braces. */
export function shortName(name: string): string {
  return name.replace(/^(?:[A-Za-z0-9_]+\.)+/, "");
}

/** Whether values are numbers, alone or in rows, records and namedarrays, that a plot can show. */
export function isPlottable(type: ValueType, depth = 0): boolean {
  if (type.container !== "none" || depth > 8) return false;
  const { base } = type;
  if (base.kind === "number" || base.kind === "enum") return true;
  return base.kind === "record" && base.record.fields.some((field) => isPlottable(field.type, depth + 1));
}
