// SPDX-License-Identifier: Apache-2.0
// Values to elements (03).
import { encodeText } from "../codec/text.js";
import { ElementType } from "../codec/element_type.js";
import type { MessageElement } from "../codec/message.js";
import type { Definitions } from "../definition/definitions.js";
import {
  itemType,
  makeType,
  numberTypes,
  product,
  type ArrayForm,
  type Field,
  type NumberName,
  type RecordType,
  type ValueType,
} from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import { numberOfArray, packNumber, packNumbers } from "./numbers.js";
import { checkCount, checkDims } from "./shapes.js";
import { MultiDimArray, VarValue } from "./values.js";

/** The name of an element, or its number. */
export type ElementKey = string | number;

const deepestValue = 63;

/** An element without content. */
export function makeElement(key: ElementKey, type: number, typeName = ""): MessageElement {
  const element: MessageElement = { type, typeName, count: 0 };
  if (typeof key === "number") element.number = key;
  else element.name = key;
  return element;
}

function nested(key: ElementKey, type: number, typeName: string, elements: MessageElement[]): MessageElement {
  return { ...makeElement(key, type, typeName), count: elements.length, elements };
}

function packed(key: ElementKey, number: NumberName, data: Uint8Array, count: number): MessageElement {
  return { ...makeElement(key, numberTypes[number]), count, data };
}

/** One number. */
export function numberElement(key: ElementKey, number: NumberName, value: unknown): MessageElement {
  return packed(key, number, packNumber(number, value), 1);
}

/** Several numbers. */
export function numbersElement(key: ElementKey, number: NumberName, values: ArrayLike<unknown>): MessageElement {
  return packed(key, number, packNumbers(number, values), values.length);
}

export function textElement(key: ElementKey, text: string): MessageElement {
  const data = encodeText(text);
  return { ...makeElement(key, ElementType.string), count: data.length, data };
}

function describe(value: unknown): string {
  if (value === null) return "null";
  return typeof value === "object" ? "an object" : `"${String(value).slice(0, 40)}"`;
}

function mismatch(key: ElementKey, type: ValueType, value: unknown): never {
  if (value === null || value === undefined) throw makeError(ErrorCode.NullValue, `${key} is null, and no ${type.text} may be`);
  throw makeError(ErrorCode.DataTypeMismatch, `${key}: ${describe(value)} is no ${type.text}`);
}

function isArrayLike(value: unknown): value is ArrayLike<unknown> {
  return Array.isArray(value) || numberOfArray(value) !== undefined;
}

/** A map of either kind, or an object whose own properties are the items. */
function* itemsOf(value: unknown): Iterable<[unknown, unknown]> {
  if (value instanceof Map) yield* value as Map<unknown, unknown>;
  else yield* Object.entries(value as object);
}

function hasDims(value: unknown): value is MultiDimArray {
  return typeof value === "object" && value !== null && "dims" in value && "array" in value;
}

/** Writes values of the types of some definitions. */
export class Packer {
  private depth = 0;

  constructor(private readonly definitions: Definitions) {}

  /** Throws RRError (NullValue, DataTypeMismatch, DataTypeError, OutOfRange) for a value that is not of the type. */
  value(type: ValueType, value: unknown, key: ElementKey): MessageElement {
    if (this.depth >= deepestValue) throw makeError(ErrorCode.ProtocolError, "a value is nested too deeply");
    ++this.depth;
    try {
      if (type.container !== "none") return this.container(type, value, key);
      const { base, array } = type;
      switch (base.kind) {
        case "void":
          return makeElement(key, ElementType.void);
        case "any":
          return this.any(value, key);
        case "string":
          if (typeof value !== "string") mismatch(key, type, value);
          return textElement(key, value);
        case "enum":
          if (typeof value !== "number") mismatch(key, type, value);
          return numberElement(key, "int32", value);
        case "number":
          return this.number(base.number, type, value, key);
        case "record":
          return this.record(base.record, array, type, value, key);
      }
    } finally {
      --this.depth;
    }
  }

  private number(number: NumberName, type: ValueType, value: unknown, key: ElementKey): MessageElement {
    const { array } = type;
    if (array.kind === "scalar") {
      if (value === null || value === undefined) mismatch(key, type, value);
      return numberElement(key, number, value);
    }
    if (array.kind === "array") {
      if (!isArrayLike(value)) mismatch(key, type, value);
      checkCount(array, value.length, String(key));
      return numbersElement(key, number, value);
    }
    if (!hasDims(value)) mismatch(key, type, value);
    checkDims(array, value.dims, value.array.length, String(key));
    const items = numbersElement("array", number, value.array);
    return nested(key, ElementType.multiDimArray, "", [numbersElement("dims", "uint32", value.dims), items]);
  }

  private record(record: RecordType, array: ArrayForm, type: ValueType, value: unknown, key: ElementKey): MessageElement {
    if (record.kind === "struct") {
      if (value === null || value === undefined) return makeElement(key, ElementType.void);
      return nested(key, ElementType.structure, record.name, this.fields(record, value, key));
    }
    const isPod = record.kind === "pod";
    if (array.kind === "dims") {
      if (!hasDims(value)) mismatch(key, type, value);
      checkDims(array, value.dims, value.array.length, String(key));
      const parts = [numbersElement("dims", "uint32", value.dims), this.row(record, value.array, "array")];
      return nested(key, isPod ? ElementType.podMultiDimArray : ElementType.namedArrayMultiDimArray, record.name, parts);
    }
    if (array.kind === "scalar") {
      if (value === null || value === undefined) mismatch(key, type, value);
      return this.row(record, [value], key);
    }
    if (!isArrayLike(value)) mismatch(key, type, value);
    checkCount(array, value.length, String(key));
    return this.row(record, value, key);
  }

  private row(record: RecordType, values: ArrayLike<unknown>, key: ElementKey): MessageElement {
    if (record.kind === "pod") {
      const items = Array.from(values, (value, i) => nested(i, ElementType.pod, "", this.fields(record, value, key)));
      return nested(key, ElementType.podArray, record.name, items);
    }
    const numbers: unknown[] = [];
    for (let i = 0; i < values.length; ++i) flatten(record, values[i], key, numbers);
    const items = numbersElement("array", record.number ?? "double", numbers);
    return nested(key, ElementType.namedArrayArray, record.name, [items]);
  }

  private fields(record: RecordType, value: unknown, key: ElementKey): MessageElement[] {
    return record.fields.map((field) => {
      const part = fieldOf(record, field, value, key);
      return record.kind === "pod" ? this.podField(field, part) : this.value(field.type, part, field.name);
    });
  }

  /** Blocks of fixed dimensions lie flat in pods. */
  private podField(field: Field, value: unknown): MessageElement {
    const { base, array } = field.type;
    if (array.kind !== "dims") return this.value(field.type, value, field.name);
    if (!hasDims(value)) mismatch(field.name, field.type, value);
    checkDims(array, value.dims, value.array.length, field.name);
    return this.value(makeType(base, { kind: "array", length: product(value.dims), isMaximum: false }), value.array, field.name);
  }

  private container(type: ValueType, value: unknown, key: ElementKey): MessageElement {
    if (value === null || value === undefined) return makeElement(key, ElementType.void);
    if (typeof value !== "object") mismatch(key, type, value);
    const item = itemType(type);
    if (type.container === "list") {
      if (!isArrayLike(value)) mismatch(key, type, value);
      return nested(key, ElementType.list, "", Array.from(value, (one, i) => this.item(item, one, i)));
    }
    if (isArrayLike(value)) mismatch(key, type, value);
    if (type.container === "int32") {
      const items = Array.from(itemsOf(value), ([name, one]): [number, unknown] => {
        const number = Number(name);
        if (number !== (number | 0)) throw makeError(ErrorCode.DataTypeError, `the key ${describe(name)} is no int32`);
        return [number, one];
      });
      items.sort(([a], [b]) => a - b);
      return nested(key, ElementType.intMap, "", items.map(([number, one]) => this.item(item, one, number)));
    }
    const items = Array.from(itemsOf(value), ([name, one]) => {
      if (typeof name !== "string") throw makeError(ErrorCode.DataTypeError, `the key ${describe(name)} is no text`);
      return { name, bytes: encodeText(name), one };
    });
    items.sort((a, b) => compareBytes(a.bytes, b.bytes));
    return nested(key, ElementType.stringMap, "", items.map(({ name, one }) => this.item(item, one, name)));
  }

  private item(type: ValueType, value: unknown, key: ElementKey): MessageElement {
    // Items may be null whatever their type, unless their length is limited (03, section 3).
    if (value === null && type.array.kind !== "scalar" && !hasLimit(type.array)) return makeElement(key, ElementType.void);
    return this.value(type, value, key);
  }

  /** A varvalue: a VarValue, or what tells its type by itself. */
  private any(value: unknown, key: ElementKey): MessageElement {
    if (value === null || value === undefined) return makeElement(key, ElementType.void);
    if (value instanceof VarValue) {
      if (value.value === null || value.value === undefined) return makeElement(key, ElementType.void);
      return this.value(this.definitions.type(value.type), value.value, key);
    }
    const type = naturalType(value);
    if (type === undefined) {
      throw makeError(ErrorCode.DataTypeError, `${key}: ${describe(value)} does not tell its type; give a VarValue`);
    }
    return this.value(this.definitions.type(type), value, key);
  }
}

function hasLimit(array: ArrayForm): boolean {
  return array.kind === "array" ? array.length !== undefined : array.kind === "dims" && array.dims !== undefined;
}

/** The type that a value has as it is; undefined when it could be of several. */
export function naturalType(value: unknown): string | undefined {
  if (typeof value === "string") return "string";
  if (typeof value === "boolean") return "bool";
  if (typeof value === "number") return "double";
  if (typeof value === "bigint") return value > 0x7fffffffffffffffn ? "uint64" : "int64";
  const number = numberOfArray(value);
  if (number) return `${number}[]`;
  if (value instanceof MultiDimArray) {
    const inner = numberOfArray(value.array);
    return inner ? `${inner}[*]` : undefined;
  }
  if (value instanceof Map) {
    for (const key of value.keys()) return typeof key === "number" ? "varvalue{int32}" : "varvalue{string}";
    return undefined;
  }
  if (Array.isArray(value)) {
    if (value.length > 0 && value.every((one) => typeof one === "number")) return "double[]";
    if (value.length > 0 && value.every((one) => typeof one === "boolean")) return "bool[]";
    return "varvalue{list}";
  }
  return undefined;
}

function fieldOf(record: RecordType, field: Field, value: unknown, key: ElementKey): unknown {
  if (typeof value !== "object" || value === null) {
    throw makeError(value === null || value === undefined ? ErrorCode.NullValue : ErrorCode.DataTypeMismatch, `${key}: ${describe(value)} is no ${record.name}`);
  }
  if (!Object.hasOwn(value, field.name) && !(field.name in value)) {
    throw makeError(ErrorCode.DataTypeError, `${key}: a ${record.name} needs the field ${field.name}`);
  }
  return (value as Record<string, unknown>)[field.name];
}

/** Adds the numbers of a namedarray. */
export function flatten(record: RecordType, value: unknown, key: ElementKey, numbers: unknown[]): void {
  for (const field of record.fields) {
    const part = fieldOf(record, field, value, key);
    const { base, array } = field.type;
    const parts: ArrayLike<unknown> = array.kind === "array" ? needRow(field, part) : [part];
    for (let i = 0; i < parts.length; ++i) {
      if (base.kind === "record") flatten(base.record, parts[i], field.name, numbers);
      else numbers.push(parts[i]);
    }
  }
}

function needRow(field: Field, value: unknown): ArrayLike<unknown> {
  if (!isArrayLike(value)) mismatch(field.name, field.type, value);
  checkCount(field.type.array, value.length, field.name);
  return value;
}

function compareBytes(a: Uint8Array, b: Uint8Array): number {
  const length = Math.min(a.length, b.length);
  for (let i = 0; i < length; ++i) {
    const difference = (a[i] ?? 0) - (b[i] ?? 0);
    if (difference !== 0) return difference;
  }
  return a.length - b.length;
}
