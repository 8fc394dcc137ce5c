// SPDX-License-Identifier: Apache-2.0
// Values as the captures write them down; see conformance/captures/README.md, "Values".
import type { Definitions } from "../../src/definition/definitions.js";
import { itemType, numberTypes, type NumberName, type RecordType, type ValueType } from "../../src/definition/types.js";
import { readNumber, readNumbers } from "../../src/value/numbers.js";
import { namedArrayOf } from "../../src/value/unpack.js";
import { MultiDimArray, VarValue } from "../../src/value/values.js";
import { packNumber } from "../../src/value/numbers.js";
import { list, number, object, text, type Json, type JsonObject } from "./json.js";
import { jsonOfNumbers, numbersOfJson } from "./numbers.js";

/** Texts and items that are there many times, written out. */
export function expanded(json: Json): Json {
  if (Array.isArray(json)) return json.map(expanded);
  if (json === null || typeof json !== "object") return json;
  if (Object.keys(json).length === 2 && "repeat" in json && "count" in json) {
    const { repeat } = json;
    const count = number(json["count"]);
    if (typeof repeat === "string") return repeat.repeat(count);
    return Array.from({ length: count }, () => expanded(repeat ?? null));
  }
  return Object.fromEntries(Object.entries(json).map(([key, value]) => [key, expanded(value)]));
}

function numberOfJson(name: NumberName, json: Json): unknown {
  return readNumber(name, numbersOfJson(numberTypes[name], [json]));
}

function jsonOfNumber(name: NumberName, value: unknown): Json {
  return jsonOfNumbers(numberTypes[name], packNumber(name, value))?.[0] ?? null;
}

/** What one item is, without array and container. */
function itemOfJson(definitions: Definitions, type: ValueType, json: Json): unknown {
  const { base } = type;
  switch (base.kind) {
    case "void":
      return undefined;
    case "string":
      return text(json);
    case "any":
      return anyOfJson(definitions, json);
    case "enum":
      return number(json);
    case "number":
      return numberOfJson(base.number, json);
    case "record":
      return recordOfJson(definitions, base.record, json);
  }
}

function recordOfJson(definitions: Definitions, record: RecordType, json: Json): unknown {
  if (json === null) return null;
  if (record.kind === "namedarray") {
    const name = record.number ?? "double";
    const numbers = readNumbers(name, numbersOfJson(numberTypes[name], json)) as ArrayLike<unknown>;
    return namedArrayOf(record, numbers, 0);
  }
  const fields = object(json);
  return Object.fromEntries(record.fields.map((field) => [field.name, valueOfJson(definitions, field.type, fields[field.name] ?? null)]));
}

function anyOfJson(definitions: Definitions, json: Json): unknown {
  if (json === null) return null;
  const { type, value } = object(json);
  if (value === null || value === undefined) return null;
  const known = definitions.type(text(type));
  return new VarValue(known.text, valueOfJson(definitions, known, value));
}

function rowOfJson(definitions: Definitions, type: ValueType, json: Json): unknown {
  const { base } = type;
  if (base.kind === "number") return readNumbers(base.number, numbersOfJson(numberTypes[base.number], json));
  return list(json).map((item) => itemOfJson(definitions, type, item));
}

export function valueOfJson(definitions: Definitions, type: ValueType, json: Json): unknown {
  if (type.container === "none") {
    if (json === null && type.base.kind !== "any") return null;
    if (type.array.kind === "scalar") return itemOfJson(definitions, type, json);
    if (type.array.kind === "array") return rowOfJson(definitions, type, json);
    const { dims, array } = object(json);
    const items = rowOfJson(definitions, type, array ?? null) as ArrayLike<unknown>;
    const shape = list(dims).map(number);
    // The recorded library was given some shapes that do not fit.
    const block = { dims: shape, array: items };
    return shape.reduce((all, dim) => all * dim, shape.length === 0 ? 0 : 1) === items.length ? new MultiDimArray(shape, items) : block;
  }
  if (json === null) return null;
  const item = itemType(type);
  if (type.container === "list") return list(json).map((one) => valueOfJson(definitions, item, one));
  return new Map(list(json).map((one) => [list(one)[0], valueOfJson(definitions, item, list(one)[1] ?? null)]));
}

function flat(record: RecordType, value: Record<string, unknown>, into: Json[]): void {
  for (const { name, type } of record.fields) {
    const { base, array } = type;
    const parts = array.kind === "array" ? Array.from(value[name] as ArrayLike<unknown>) : [value[name]];
    for (const one of parts) {
      if (base.kind === "record") flat(base.record, one as Record<string, unknown>, into);
      else if (base.kind === "number") into.push(jsonOfNumber(base.number, one));
    }
  }
}

function jsonOfItem(definitions: Definitions, type: ValueType, value: unknown): Json {
  const { base } = type;
  if (value === null || value === undefined) return null;
  switch (base.kind) {
    case "void":
      return null;
    case "string":
      return value as string;
    case "any": {
      const any = value as VarValue;
      return { type: any.type, value: jsonOfValue(definitions, definitions.type(any.type), any.value) };
    }
    case "enum":
      return value as number;
    case "number":
      return jsonOfNumber(base.number, value);
    case "record": {
      if (base.record.kind === "namedarray") {
        const numbers: Json[] = [];
        flat(base.record, value as Record<string, unknown>, numbers);
        return numbers;
      }
      const fields = value as Record<string, unknown>;
      const json: JsonObject = {};
      for (const field of base.record.fields) json[field.name] = jsonOfValue(definitions, field.type, fields[field.name]);
      return json;
    }
  }
}

export function jsonOfValue(definitions: Definitions, type: ValueType, value: unknown): Json {
  if (value === null || value === undefined) return null;
  const row = (items: ArrayLike<unknown>): Json[] => Array.from(items, (item) => jsonOfItem(definitions, type, item));
  if (type.container === "none") {
    if (type.array.kind === "scalar") return jsonOfItem(definitions, type, value);
    if (type.array.kind === "array") return row(value as ArrayLike<unknown>);
    const block = value as MultiDimArray;
    return { dims: [...block.dims], array: row(block.array) };
  }
  const item = itemType(type);
  if (type.container === "list") return Array.from(value as unknown[], (one) => jsonOfValue(definitions, item, one));
  return Array.from(value as Map<number | string, unknown>, ([key, one]) => [key, jsonOfValue(definitions, item, one)]);
}
