// SPDX-License-Identifier: Apache-2.0
// What a service definition declares, with all names resolved.
import { ElementType } from "../codec/element_type.js";

/** Numbers as definitions name them, bool and complex included. */
export type NumberName =
  | "double"
  | "single"
  | "int8"
  | "uint8"
  | "int16"
  | "uint16"
  | "int32"
  | "uint32"
  | "int64"
  | "uint64"
  | "cdouble"
  | "csingle"
  | "bool";

/** Element type numbers of numbers. */
export const numberTypes: Readonly<Record<NumberName, number>> = {
  double: ElementType.double,
  single: ElementType.single,
  int8: ElementType.int8,
  uint8: ElementType.uint8,
  int16: ElementType.int16,
  uint16: ElementType.uint16,
  int32: ElementType.int32,
  uint32: ElementType.uint32,
  int64: ElementType.int64,
  uint64: ElementType.uint64,
  cdouble: ElementType.cdouble,
  csingle: ElementType.csingle,
  bool: ElementType.bool,
};

const names = new Map<number, NumberName>(
  (Object.entries(numberTypes) as [NumberName, number][]).map(([name, type]) => [type, name]),
);

/** Undefined for an element type that is no number. */
export function numberNameOf(elementType: number): NumberName | undefined {
  return names.get(elementType);
}

/** A field of a struct, pod or namedarray. */
export interface Field {
  /** As in the definition. */
  readonly name: string;
  /** What it takes. */
  readonly type: ValueType;
  /** The comments before it. */
  readonly doc: string;
}

/** A struct, pod or namedarray; its name is qualified. */
export interface RecordType {
  readonly kind: "struct" | "pod" | "namedarray";
  readonly name: string;
  readonly fields: Field[];
  readonly doc: string;
  /** Of a namedarray: what all its numbers are, and how many there are. */
  number?: NumberName;
  count?: number;
}

/** An enum; its name is qualified. */
export interface EnumType {
  /** Qualified. */
  readonly name: string;
  /** In the order of the definition. */
  readonly values: readonly { readonly name: string; readonly value: number; readonly doc: string }[];
  /** The comments before it. */
  readonly doc: string;
}

/** What a value or an item of it is. */
export type BaseType =
  | { readonly kind: "void" }
  | { readonly kind: "number"; readonly number: NumberName }
  | { readonly kind: "string" }
  /** varvalue */
  | { readonly kind: "any" }
  | { readonly kind: "enum"; readonly enum: EnumType }
  | { readonly kind: "record"; readonly record: RecordType };

/** How many items: one, a row of them, or a block with several dimensions. */
export type ArrayForm =
  | { readonly kind: "scalar" }
  /** `length` undefined: any; `isMaximum`: up to so many. */
  | { readonly kind: "array"; readonly length?: number; readonly isMaximum: boolean }
  /** `dims` undefined: any. */
  | { readonly kind: "dims"; readonly dims?: readonly number[] };

/** What values are in: nothing, a list, a map with int32 keys, or one with string keys. */
export type ContainerForm = "none" | "list" | "int32" | "string";

/** The type of a value. */
export interface ValueType {
  /** What a value or an item of it is. */
  readonly base: BaseType;
  /** How many items. */
  readonly array: ArrayForm;
  /** What they are in. */
  readonly container: ContainerForm;
  /** As definitions spell it, with named types qualified. */
  readonly text: string;
}

/** Kinds of members. */
export type MemberKind = "property" | "function" | "event" | "objref" | "pipe" | "callback" | "wire" | "memory";

/** A parameter of a function, event or callback. */
export interface Parameter {
  /** As in the definition. */
  readonly name: string;
  /** What it takes. */
  readonly type: ValueType;
}

/** A member of an object. */
export interface Member {
  /** Which of the following count. */
  readonly kind: MemberKind;
  /** As in the definition. */
  readonly name: string;
  /** The comments before it. */
  readonly doc: string;
  /** Of the value, the result, packets or items; void for events and objrefs. */
  readonly type: ValueType;
  /** Without the last parameter of a generator that takes values. */
  readonly parameters: readonly Parameter[];
  /** Of a function: what is generated or taken step by step. */
  readonly generator?: { readonly gives: boolean; readonly takes?: ValueType };
  /** Of an objref: the qualified name of the object type, empty for varobject, and the kind of index. */
  readonly objectType: string;
  /** How the objects of an objref are told apart. */
  readonly index: "none" | "int32" | "string";
  /** Clients get or receive only. */
  readonly isReadonly: boolean;
  /** Clients set or send only. */
  readonly isWriteonly: boolean;
  /** Packets or values may be lost or overtake each other. */
  readonly isUnreliable: boolean;
  /** Whether locks leave it, or its reading, alone. */
  readonly nolock: boolean;
  /** Whether locks leave reading it alone. */
  readonly nolockread: boolean;
}

/** An object type; its name is qualified. */
export interface ObjectType {
  /** Qualified. */
  readonly name: string;
  /** The comments before it. */
  readonly doc: string;
  /** As the definition writes them: those of other definitions qualified. */
  readonly implements: readonly string[];
  /** By their names, those of what it implements included. */
  readonly members: ReadonlyMap<string, Member>;
}

/** A constant; `value` is a number, bigint, string, list of numbers or, of a struct constant, names. */
export interface Constant {
  /** As in the definition. */
  readonly name: string;
  /** As it is written. */
  readonly type: string;
  /** What it is. */
  readonly value: number | bigint | string | (number | bigint)[] | Record<string, string>;
  /** The comments before it. */
  readonly doc: string;
}

/** One value. */
export const scalarForm: ArrayForm = { kind: "scalar" };

/** Spells a type. */
export function typeText(base: BaseType, array: ArrayForm, container: ContainerForm): string {
  let text: string;
  switch (base.kind) {
    case "number":
      text = base.number;
      break;
    case "any":
      text = "varvalue";
      break;
    case "enum":
      text = base.enum.name;
      break;
    case "record":
      text = base.record.name;
      break;
    default:
      text = base.kind;
  }
  if (array.kind === "array") text += `[${array.length ?? ""}${array.isMaximum ? "-" : ""}]`;
  if (array.kind === "dims") text += array.dims ? `[${array.dims.join(",")}${array.dims.length === 1 ? "," : ""}]` : "[*]";
  return container === "none" ? text : `${text}{${container}}`;
}

/** A type from its parts. */
export function makeType(base: BaseType, array: ArrayForm = scalarForm, container: ContainerForm = "none"): ValueType {
  return { base, array, container, text: typeText(base, array, container) };
}

/** The type of an item of a container. */
export function itemType(type: ValueType): ValueType {
  return type.container === "none" ? type : makeType(type.base, type.array);
}

/** No value: what a function without a result returns. */
export const voidType = makeType({ kind: "void" });
/** `varvalue`: a value of any type. */
export const anyType = makeType({ kind: "any" });
/** `string`. */
export const stringType = makeType({ kind: "string" });

/** The type of a number, or of an array of numbers. */
export function numberType(number: NumberName, array: ArrayForm = scalarForm): ValueType {
  return makeType({ kind: "number", number }, array);
}

/** Items that fixed dimensions have. */
export function product(dims: readonly number[]): number {
  return dims.reduce((all, dim) => all * dim, 1);
}
