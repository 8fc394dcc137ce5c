// SPDX-License-Identifier: Apache-2.0
// Values of the records of generated code.
import { product, type ArrayForm, type BaseType, type Field, type RecordType as Declared, type ValueType } from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import type { ServiceModule } from "../module.js";
import { readNumber, sizeOfNumber } from "./numbers.js";
import { flatten } from "./pack.js";
import { emptyRow } from "./rows.js";
import { namedArrayOf } from "./unpack.js";
import { MultiDimArray, VarValue } from "./values.js";

/** Makes values of one struct, pod or namedarray. */
export class RecordType<T extends object> {
  constructor(
    /** The definition that declares the type. */
    protected readonly module: ServiceModule,
    /** Qualified. */
    readonly name: string,
  ) {}

  /** What the definition says of it. */
  protected get declared(): Declared {
    return this.module.definitions.record(this.name);
  }

  /** A value. Fields that are left out are zero or empty; structs, containers and varvalues are null. */
  make(fields: Partial<T> = {}): T {
    return { ...recordOf(this.declared), ...fields } as T;
  }

  /** What carries it where anything may be. */
  varValue(value: T): VarValue<T | T[]> {
    return this.declared.kind === "struct" ? new VarValue(this.name, value) : this.varValues([value]);
  }

  /** Several pods or namedarrays, where anything may be. Throws DataTypeError for structs, which have no arrays. */
  varValues(values: T[]): VarValue<T[]> {
    if (this.declared.kind === "struct") throw makeError(ErrorCode.DataTypeError, `there is no array of ${this.name}`);
    return new VarValue(`${this.name}[]`, values);
  }
}

/** The same, of one whose fields are all numbers of one kind, which `A` holds. */
export class NamedArrayType<T extends object, A extends ArrayLike<unknown>> extends RecordType<T> {
  /** How many numbers one value consists of. */
  get count(): number {
    return this.declared.count ?? 0;
  }

  /** The numbers of several values, one value behind the other. */
  toNumbers(values: readonly T[]): A {
    const { declared } = this;
    const numbers: unknown[] = [];
    for (const value of values) flatten(declared, value, this.name, numbers);
    const row = emptyRow({ kind: "number", number: declared.number ?? "double" }, numbers.length) as unknown[];
    numbers.forEach((number, i) => {
      row[i] = number;
    });
    return row as unknown as A;
  }

  /** The values that these numbers are. Throws DataTypeError when they are no whole ones. */
  fromNumbers(numbers: A): T[] {
    const { declared, count } = this;
    if (numbers.length % count !== 0) throw makeError(ErrorCode.DataTypeError, `${numbers.length} numbers are no whole ${this.name}`);
    return Array.from({ length: numbers.length / count }, (_, i) => namedArrayOf(declared, numbers, i * count) as T);
  }
}

function recordOf(record: Declared): Record<string, unknown> {
  const value: Record<string, unknown> = {};
  for (const { name, type } of record.fields as readonly Field[]) value[name] = firstValue(type);
  return value;
}

/** What a field is when nothing is said. */
function firstValue({ base, array, container }: ValueType): unknown {
  if (container !== "none" || base.kind === "any" || (base.kind === "record" && base.record.kind === "struct")) return null;
  if (array.kind === "scalar") return firstItem(base);
  const dims = array.kind === "dims" ? (array.dims ?? []) : undefined;
  const row = rowOf(base, dims ? (dims.length === 0 ? 0 : product(dims)) : countOf(array));
  return dims ? new MultiDimArray(dims, row) : row;
}

function countOf(array: ArrayForm): number {
  return array.kind === "array" && !array.isMaximum ? (array.length ?? 0) : 0;
}

function firstItem(base: BaseType): unknown {
  switch (base.kind) {
    case "number":
      return readNumber(base.number, new Uint8Array(sizeOfNumber(base.number)));
    case "enum":
      return base.enum.values[0]?.value ?? 0;
    case "string":
      return "";
    case "record":
      return recordOf(base.record);
    default:
      return null;
  }
}

function rowOf(base: BaseType, count: number): ArrayLike<unknown> {
  const row = emptyRow(base, count);
  return Array.isArray(row) ? Array.from({ length: count }, () => firstItem(base)) : row;
}

/** The name of a value of a generated enum; undefined when it has none. */
export function enumName(values: Readonly<Record<string, number>>, value: number): string | undefined {
  return Object.keys(values).find((name) => values[name] === value);
}
