// SPDX-License-Identifier: Apache-2.0
// Random values of types, for properties.
import fc from "fast-check";
import { MultiDimArray, VarValue, type BaseType, type Definitions, type NumberName, type ValueType } from "@robdef/runtime";
import { item, rowType } from "../src/model/types.js";
import { mayBeNull, rangeOf } from "../src/model/draft.js";

function numberOf(number: NumberName): fc.Arbitrary<unknown> {
  const range = rangeOf(number);
  if (range) return number.includes("64") ? fc.bigInt(range[0], range[1]) : fc.integer({ min: Number(range[0]), max: Number(range[1]) });
  switch (number) {
    case "bool":
      return fc.boolean();
    case "single":
      return fc.float();
    case "cdouble":
      return fc.record({ re: fc.double(), im: fc.double() });
    case "csingle":
      return fc.record({ re: fc.float(), im: fc.float() });
    default:
      return fc.double();
  }
}

function single(definitions: Definitions, base: BaseType, depth: number): fc.Arbitrary<unknown> {
  switch (base.kind) {
    case "number":
      return numberOf(base.number);
    case "enum":
      return fc.constantFrom(...base.enum.values.map((one) => one.value));
    case "record":
      return fc.record(Object.fromEntries(base.record.fields.map((field) => [field.name, valueOf(definitions, field.type, depth + 1)])));
    default:
      return fc.string({ unit: "grapheme", maxLength: 12 });
  }
}

/** Values of a type that the protocol can carry. */
export function valueOf(definitions: Definitions, type: ValueType, depth = 0): fc.Arbitrary<unknown> {
  const { base, array } = type;
  const inner = item(type);
  let made: fc.Arbitrary<unknown>;
  if (type.container === "list") made = fc.array(valueOf(definitions, inner, depth + 1), { maxLength: 3 });
  else if (type.container === "string") made = fc.array(fc.tuple(fc.string({ maxLength: 6 }), valueOf(definitions, inner, depth + 1)), { maxLength: 3 }).map((items) => new Map(items));
  else if (type.container === "int32") made = fc.array(fc.tuple(fc.integer(), valueOf(definitions, inner, depth + 1)), { maxLength: 3 }).map((items) => new Map(items));
  else if (base.kind === "any") {
    const inside = fc.constantFrom(...(depth > 2 ? ["double[]", "string"] : ["double[]", "string", "int64[]", "bool[]", "double[*]", "varvalue{list}", "varvalue{string}"]));
    made = inside.chain((text) => valueOf(definitions, definitions.type(text), depth + 1).map((value) => new VarValue(text, value)));
  } else if (array.kind === "dims") {
    const dims = array.dims ? fc.constant([...array.dims]) : fc.array(fc.integer({ min: 0, max: 3 }), { minLength: 1, maxLength: 3 });
    made = dims.chain((shape) => {
      const count = shape.reduce((all, dim) => all * dim, 1);
      return fc.array(single(definitions, base, depth), { minLength: count, maxLength: count }).map((items) => new MultiDimArray(shape, base.kind === "number" ? rowType(base.number, items) : items));
    });
  } else if (array.kind === "array") {
    const count = array.length === undefined ? { maxLength: 4 } : array.isMaximum ? { maxLength: Math.min(4, array.length) } : { minLength: array.length, maxLength: array.length };
    made = fc.array(single(definitions, base, depth), count).map((items) => (base.kind === "number" ? rowType(base.number, items) : items));
  } else made = single(definitions, base, depth);
  return mayBeNull(type) ? fc.option(made, { freq: 5, nil: null }) : made;
}
