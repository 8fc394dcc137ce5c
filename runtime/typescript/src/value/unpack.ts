// SPDX-License-Identifier: Apache-2.0
// Values from elements (03).
import { decodeText } from "../codec/text.js";
import { ElementType, isNested } from "../codec/element_type.js";
import type { MessageElement } from "../codec/message.js";
import type { Definitions } from "../definition/definitions.js";
import {
  itemType,
  makeType,
  numberNameOf,
  numberTypes,
  type ArrayForm,
  type Field,
  type NumberName,
  type RecordType,
  type ValueType,
} from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import { readNumber, readNumbers } from "./numbers.js";
import { checkCount, checkDims, checkType, elementNumber, findElement } from "./shapes.js";
import { MultiDimArray, VarValue } from "./values.js";

/** A struct, pod or namedarray: an object with its fields. */
export type RecordValue = Record<string, unknown>;

const noBytes = new Uint8Array(0);
const anyArray: ArrayForm = { kind: "array", isMaximum: false };
const anyDims: ArrayForm = { kind: "dims" };

/** The text of a string element. */
export function textOf(element: MessageElement): string {
  if (element.type !== ElementType.string) {
    const code = element.type === ElementType.void ? ErrorCode.DataTypeError : ErrorCode.DataTypeMismatch;
    throw makeError(code, `${nameOf(element)} is no string`);
  }
  return decodeText(element.data ?? noBytes);
}

function nameOf(element: MessageElement): string {
  return element.name ?? `#${element.number ?? 0}`;
}

/** Reads values of the types of some definitions. */
export class Unpacker {
  constructor(private readonly definitions: Definitions) {}

  /** Throws RRError with the codes that the protocol gives such mistakes (03, section 11). */
  value(type: ValueType, element: MessageElement): unknown {
    if (type.container !== "none") return this.container(type, element);
    const { base } = type;
    switch (base.kind) {
      case "void":
        return undefined;
      case "any":
        return this.any(element);
      case "string":
        return textOf(element);
      case "enum":
        return this.scalar("int32", element);
      case "number":
        return type.array.kind === "scalar" ? this.scalar(base.number, element) : this.numbers(base.number, type.array, element);
      case "record":
        return this.record(base.record, type.array, element);
    }
  }

  private scalar(number: NumberName, element: MessageElement): unknown {
    checkType(element, numberTypes[number], nameOf(element));
    if (element.count === 0) throw makeError(ErrorCode.OutOfRange, `${nameOf(element)} has no number`);
    return readNumber(number, element.data ?? noBytes);
  }

  private numbers(number: NumberName, array: ArrayForm, element: MessageElement): unknown {
    if (array.kind !== "dims") {
      checkType(element, numberTypes[number], nameOf(element));
      checkCount(array, element.count, nameOf(element));
      return readNumbers(number, element.data ?? noBytes);
    }
    checkType(element, ElementType.multiDimArray, nameOf(element));
    const { dims, items } = this.block(element);
    checkType(items, numberTypes[number], "array");
    checkDims(array, dims, items.count, nameOf(element));
    return new MultiDimArray(dims, readNumbers(number, items.data ?? noBytes));
  }

  private block(element: MessageElement): { dims: number[]; items: MessageElement } {
    const dims = findElement(element.elements, "dims");
    checkType(dims, ElementType.uint32, "dims");
    const items = findElement(element.elements, "array");
    return { dims: Array.from(readNumbers("uint32", dims.data ?? noBytes) as Uint32Array), items };
  }

  private record(record: RecordType, array: ArrayForm, element: MessageElement): unknown {
    if (record.kind === "struct") return this.struct(element);
    const isPod = record.kind === "pod";
    if (array.kind === "dims") {
      checkType(element, isPod ? ElementType.podMultiDimArray : ElementType.namedArrayMultiDimArray, nameOf(element));
      this.checkTypeName(element, record);
      const { dims, items } = this.block(element);
      const list = this.row(record, items);
      checkDims(array, dims, list.length, nameOf(element));
      return new MultiDimArray(dims, list);
    }
    const list = this.row(record, element);
    if (array.kind === "scalar") {
      if (list.length !== 1) throw makeError(ErrorCode.DataTypeError, `${nameOf(element)} has ${list.length} items instead of one`);
      return list[0];
    }
    checkCount(array, list.length, nameOf(element));
    return list;
  }

  private checkTypeName(element: MessageElement, record: RecordType): void {
    if (element.typeName !== record.name) {
      throw makeError(ErrorCode.DataTypeError, `${nameOf(element)} is of ${element.typeName.slice(0, 200)} instead of ${record.name}`);
    }
  }

  /** Pods or namedarrays in a row. */
  private row(record: RecordType, element: MessageElement): RecordValue[] {
    const isPod = record.kind === "pod";
    checkType(element, isPod ? ElementType.podArray : ElementType.namedArrayArray, nameOf(element));
    this.checkTypeName(element, record);
    if (isPod) {
      return (element.elements ?? []).map((item, i) => {
        checkType(item, ElementType.pod, nameOf(item));
        if (elementNumber(item) !== i) throw makeError(ErrorCode.DataTypeError, `a pod has another number than ${i}`);
        return this.fields(record, item, true);
      });
    }
    const items = findElement(element.elements, "array");
    const { number = "double", count = 1 } = record;
    checkType(items, numberTypes[number], "array");
    if (items.count % count !== 0) {
      throw makeError(ErrorCode.DataTypeError, `${items.count} numbers are no whole ${record.name}`);
    }
    const numbers = readNumbers(number, items.data ?? noBytes);
    return Array.from({ length: items.count / count }, (_, i) => namedArrayOf(record, numbers, i * count));
  }

  private struct(element: MessageElement): RecordValue | null {
    if (element.type === ElementType.void) return null;
    checkType(element, ElementType.structure, nameOf(element));
    return this.fields(this.definitions.record(element.typeName), element, false);
  }

  private fields(record: RecordType, element: MessageElement, isPod: boolean): RecordValue {
    const value: RecordValue = {};
    for (const field of record.fields) {
      const found = findElement(element.elements, field.name);
      value[field.name] = isPod ? this.podField(field, found) : this.value(field.type, found);
    }
    return value;
  }

  /** Blocks of fixed dimensions lie flat in pods. */
  private podField(field: Field, element: MessageElement): unknown {
    const { base, array } = field.type;
    if (array.kind !== "dims") return this.value(field.type, element);
    const flat = this.value(makeType(base, anyArray), element) as ArrayLike<unknown>;
    const dims = array.dims ?? [];
    checkDims(array, dims, flat.length, field.name);
    return new MultiDimArray(dims, flat);
  }

  private container(type: ValueType, element: MessageElement): unknown {
    if (element.type === ElementType.void) return null;
    const item = itemType(type);
    const what = nameOf(element);
    const elements = element.elements ?? [];
    const read = (one: MessageElement): unknown => {
      if (one.type === ElementType.void && canBeNullItem(item)) return null;
      return this.value(item, one);
    };
    if (type.container === "list") {
      checkType(element, ElementType.list, what);
      return elements.map((one, i) => {
        if (elementNumber(one) !== i) throw makeError(ErrorCode.DataTypeError, `${what} is not numbered from 0`);
        return read(one);
      });
    }
    if (type.container === "int32") {
      checkType(element, ElementType.intMap, what);
      const map = new Map<number, unknown>();
      for (const one of elements) {
        const key = elementNumber(one);
        if (key === undefined) throw makeError(ErrorCode.DataTypeError, `a key of ${what} is no int32`);
        if (!map.has(key)) map.set(key, read(one));
      }
      return map;
    }
    checkType(element, ElementType.stringMap, what);
    const map = new Map<string, unknown>();
    for (const one of elements) {
      if (one.name === undefined) throw makeError(ErrorCode.DataTypeError, `a key of ${what} is no text`);
      if (!map.has(one.name)) map.set(one.name, read(one));
    }
    return map;
  }

  /** What a varvalue holds, with its type; null for none. */
  any(element: MessageElement): VarValue | null {
    const { type } = element;
    if (type === ElementType.void) return null;
    const number = numberNameOf(type);
    if (number) return new VarValue(`${number}[]`, readNumbers(number, element.data ?? noBytes));
    if (type === ElementType.string) return new VarValue("string", textOf(element));
    if (type === ElementType.multiDimArray) {
      const inner = numberNameOf(findElement(element.elements, "array").type);
      if (!inner) throw makeError(ErrorCode.DataTypeMismatch, "an array of several dimensions has no numbers");
      return new VarValue(`${inner}[*]`, this.numbers(inner, anyDims, element));
    }
    if (!isNested(type) || type === ElementType.pod) {
      throw makeError(ErrorCode.DataTypeError, `${nameOf(element)} has element type ${type}, which is no value`);
    }
    if (type === ElementType.list) return this.anyContainer("list", element);
    if (type === ElementType.intMap) return this.anyContainer("int32", element);
    if (type === ElementType.stringMap) return this.anyContainer("string", element);
    return this.anyRecord(element);
  }

  private anyContainer(container: "list" | "int32" | "string", element: MessageElement): VarValue {
    const type = makeType({ kind: "any" }, { kind: "scalar" }, container);
    return new VarValue(type.text, this.container(type, element));
  }

  private anyRecord(element: MessageElement): VarValue {
    const record = this.definitions.record(element.typeName);
    const { type } = element;
    if (type === ElementType.structure) {
      checkKind(record, record.kind === "struct");
      return new VarValue(record.name, this.struct(element));
    }
    const isPod = type === ElementType.podArray || type === ElementType.podMultiDimArray;
    checkKind(record, record.kind === (isPod ? "pod" : "namedarray"));
    const hasDims = type === ElementType.podMultiDimArray || type === ElementType.namedArrayMultiDimArray;
    const array = hasDims ? anyDims : anyArray;
    return new VarValue(`${record.name}[${hasDims ? "*" : ""}]`, this.record(record, array, element));
  }
}

function checkKind(record: RecordType, isRight: boolean): void {
  if (!isRight) throw makeError(ErrorCode.DataTypeError, `${record.name} is a ${record.kind}`);
}

/** Items of a container may be null whatever their type, unless their length is limited (03, section 3). */
function canBeNullItem(type: ValueType): boolean {
  if (type.array.kind === "array") return type.array.length === undefined;
  return type.array.kind === "scalar" || type.array.dims === undefined;
}

/** One namedarray from its numbers. */
export function namedArrayOf(record: RecordType, numbers: ArrayLike<unknown>, start: number): RecordValue {
  const value: RecordValue = {};
  let at = start;
  for (const { name, type } of record.fields) {
    const times = type.array.kind === "array" ? (type.array.length ?? 0) : undefined;
    const inner = type.base.kind === "record" ? type.base.record : undefined;
    const count = inner?.count ?? 1;
    if (inner) {
      const one = (i: number): RecordValue => namedArrayOf(inner, numbers, at + i * count);
      value[name] = times === undefined ? one(0) : Array.from({ length: times }, (_, i) => one(i));
    } else {
      value[name] = times === undefined ? numbers[at] : slice(numbers, at, at + times);
    }
    at += count * (times ?? 1);
  }
  return value;
}

function slice(numbers: ArrayLike<unknown>, from: number, to: number): unknown {
  return (numbers as Float64Array).slice(from, to);
}
