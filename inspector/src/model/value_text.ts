// SPDX-License-Identifier: Apache-2.0
// Values as texts: short ones for people, JSON for the command line.
import { MultiDimArray, VarValue, type Complex, type Definitions, type ValueType } from "@robdef/runtime";
import { numberText } from "./draft.js";
import { item, type RecordDeclaration } from "./types.js";

/** A value in at most about so many characters. */
export function valueText(type: ValueType, value: unknown, most = 120): string {
  const text = new ShortText(most);
  text.value(type, value);
  return text.done();
}

class ShortText {
  private text = "";
  constructor(private readonly most: number) {}

  done(): string {
    return this.text.length > this.most ? `${this.text.slice(0, this.most - 1)}…` : this.text;
  }

  private get isFull(): boolean {
    return this.text.length > this.most;
  }

  value(type: ValueType, value: unknown): void {
    if (this.isFull) return;
    if (value === undefined) this.text += type.base.kind === "void" ? "done" : "—";
    else if (value === null) this.text += "null";
    else if (type.container === "list") this.row(value as ArrayLike<unknown>, item(type), "[", "]");
    else if (type.container !== "none") this.map(value as ReadonlyMap<unknown, unknown>, item(type));
    else if (type.base.kind === "any") this.any(value as VarValue);
    else if (type.array.kind === "dims") {
      const { dims, array } = value as MultiDimArray;
      this.text += `${dims.join("×")} `;
      this.row(array, item(type), "[", "]");
    } else if (type.array.kind === "array") this.row(value as ArrayLike<unknown>, item(type), "[", "]");
    else this.one(type, value);
  }

  private one({ base }: ValueType, value: unknown): void {
    if (base.kind === "record") this.record(base.record, value as Readonly<Record<string, unknown>>);
    else if (base.kind === "enum") this.text += base.enum.values.find((one) => one.value === value)?.name ?? String(value);
    else if (base.kind === "string") this.text += JSON.stringify(value);
    else this.text += typeof value === "number" ? rounded(value) : numberText(value);
  }

  private row(row: ArrayLike<unknown>, type: ValueType, open: string, close: string): void {
    this.text += open;
    for (let i = 0; i < row.length && !this.isFull; ++i) {
      if (i > 0) this.text += ", ";
      this.value(type, row[i]);
    }
    this.text += close;
    if (this.isFull) this.text = `${row.length} items ${this.text}`;
  }

  private map(map: ReadonlyMap<unknown, unknown>, type: ValueType): void {
    this.text += "{";
    let isFirst = true;
    for (const [key, one] of map) {
      if (this.isFull) break;
      this.text += `${isFirst ? "" : ", "}${String(key)}: `;
      isFirst = false;
      this.value(type, one);
    }
    this.text += "}";
  }

  private record(record: RecordDeclaration, fields: Readonly<Record<string, unknown>>): void {
    this.text += "{";
    record.fields.forEach((field, i) => {
      if (this.isFull) return;
      this.text += `${i > 0 ? ", " : ""}${field.name}: `;
      this.value(field.type, fields[field.name]);
    });
    this.text += "}";
  }

  private any(any: VarValue): void {
    const inner: unknown = any.value;
    if (inner === null) this.text += "null";
    else if (typeof inner === "string") this.text += JSON.stringify(inner);
    else if (inner instanceof Map) {
      this.text += `${any.type} with ${inner.size} items`;
    } else if (inner instanceof MultiDimArray) this.text += `${any.type} ${inner.dims.join("×")}`;
    else if (Array.isArray(inner) || ArrayBuffer.isView(inner)) {
      const row = inner as unknown as ArrayLike<unknown>;
      const texts = Array.from({ length: Math.min(row.length, 32) }, (_, i) => (typeof row[i] === "object" ? "{…}" : typeof row[i] === "number" ? rounded(row[i]) : String(row[i])));
      this.text += `[${texts.join(", ")}${row.length > 32 ? ", …" : ""}]`;
    } else this.text += any.type;
  }
}

/** Seven digits at most: enough for people. */
export function rounded(value: number): string {
  return Number.isInteger(value) || !Number.isFinite(value) ? numberText(value) : String(Number(value.toPrecision(7)));
}

/** JSON as `robdef get`, `set` and `call` read and write it; 64-bit numbers keep their digits. */
export function jsonText(definitions: Definitions, type: ValueType, value: unknown): string {
  if (value === null || value === undefined) return "null";
  const list = (row: ArrayLike<unknown>, of: ValueType): string => `[${Array.from(row, (one) => jsonText(definitions, of, one)).join(",")}]`;
  if (type.container === "list") return list(value as ArrayLike<unknown>, item(type));
  if (type.container !== "none") {
    const items = Array.from(value as ReadonlyMap<unknown, unknown>, ([key, one]) => `${JSON.stringify(String(key))}:${jsonText(definitions, item(type), one)}`);
    return `{${items.join(",")}}`;
  }
  const { base, array } = type;
  if (base.kind === "any") {
    const any = value as VarValue;
    return `{"type":${JSON.stringify(any.type)},"value":${jsonText(definitions, definitions.type(any.type), any.value)}}`;
  }
  if (array.kind === "dims") {
    const { dims, array: items } = value as MultiDimArray;
    return items.length === 0 ? `{"array":[],"dims":[${dims.join(",")}]}` : nested(definitions, dims, items, item(type));
  }
  if (array.kind === "array") return list(value as ArrayLike<unknown>, item(type));
  switch (base.kind) {
    case "record": {
      const fields = value as Readonly<Record<string, unknown>>;
      return `{${base.record.fields.map((field) => `${JSON.stringify(field.name)}:${jsonText(definitions, field.type, fields[field.name])}`).join(",")}}`;
    }
    case "enum":
      return JSON.stringify(base.enum.values.find((one) => one.value === value)?.name ?? value);
    case "string":
      return JSON.stringify(value);
    default:
      return jsonNumber(value);
  }
}

function jsonNumber(value: unknown): string {
  if (typeof value === "object" && value !== null && "re" in value) return `[${jsonNumber((value as Complex).re)},${jsonNumber((value as Complex).im)}]`;
  if (typeof value === "number" && !Number.isFinite(value)) return JSON.stringify(String(value));
  return typeof value === "number" ? numberText(value) : String(value);
}

/** The first index outermost; in memory it is the fastest. */
function nested(definitions: Definitions, dims: readonly number[], items: ArrayLike<unknown>, type: ValueType): string {
  const steps: number[] = [];
  let step = 1;
  for (const dim of dims) {
    steps.push(step);
    step *= dim;
  }
  const level = (depth: number, at: number): string => {
    if (depth === dims.length) return jsonText(definitions, type, items[at]);
    return `[${Array.from({ length: dims[depth] ?? 0 }, (_, i) => level(depth + 1, at + i * (steps[depth] ?? 0))).join(",")}]`;
  };
  return level(0, 0);
}
