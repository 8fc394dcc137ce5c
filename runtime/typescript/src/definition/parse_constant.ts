// SPDX-License-Identifier: Apache-2.0
// Constants and the values of enums (06, section 8).
import { definitionError } from "./definition_error.js";
import type { Line } from "./lines.js";
import { isBlank, Scanner } from "./scanner.js";
import type { Constant } from "./types.js";

const integer = /^[+-]?(?:0x[0-9a-fA-F]{1,16}|\d{1,20})$/;
const float = /^[+-]?(?:\d{1,400}(?:\.\d{0,400})?|\.\d{1,400})(?:[eE][+-]?\d{1,6})?$/;
const big = new Set(["int64", "uint64"]);
const whole = new Set(["int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"]);

function integerOf(text: string, line: number): bigint {
  if (!integer.test(text)) throw definitionError(line, `"${text.slice(0, 40)}" is no integer`);
  const isNegative = text.startsWith("-");
  const value = BigInt(text.replace(/^[+-]/, ""));
  return isNegative ? -value : value;
}

function numberOf(type: string, text: string, line: number): number | bigint {
  if (big.has(type)) return integerOf(text, line);
  if (whole.has(type)) return Number(integerOf(text, line));
  if (!float.test(text)) throw definitionError(line, `"${text.slice(0, 40)}" is no number`);
  const value = Number(text);
  if (!Number.isFinite(value)) throw definitionError(line, `${text.slice(0, 40)} is too large`);
  return value;
}

/** Behind the word `constant`. */
export function parseConstant(scanner: Scanner, doc: string): Constant {
  scanner.needBlanks();
  const type = scanner.while((character) => !isBlank(character));
  scanner.needBlanks();
  const name = scanner.name("a constant");
  scanner.needBlanks();
  const text = scanner.rest().trim();
  const { line } = scanner;
  const base = type.replace(/[[{].*$/, "");
  if (base === "string") return { name, type, value: stringOf(text, line), doc };
  if (!whole.has(base) && base !== "double" && base !== "single") {
    return { name, type, value: structOf(text, line), doc };
  }
  if (!type.includes("[")) return { name, type, value: numberOf(base, text, line), doc };
  return { name, type, value: items(text, line).map((item) => numberOf(base, item, line)), doc };
}

function items(text: string, line: number): string[] {
  if (!text.startsWith("{") || !text.endsWith("}")) throw definitionError(line, "expected values in braces");
  const inner = text.slice(1, -1).trim();
  return inner === "" ? [] : inner.split(",").map((item) => item.trim());
}

function structOf(text: string, line: number): Record<string, string> {
  const fields: [string, string][] = items(text, line).map((item) => {
    const [name = "", constant = "", ...more] = item.split(":").map((one) => one.trim());
    if (name === "" || constant === "" || more.length > 0) throw definitionError(line, `"${item.slice(0, 40)}" names no constant`);
    return [name, constant];
  });
  return Object.fromEntries(fields);
}

function stringOf(text: string, line: number): string {
  try {
    // The grammar is JSON's, but for a tab as it is.
    const value: unknown = JSON.parse(text.replaceAll("\t", "\\t"));
    if (typeof value === "string") return value;
  } catch {
    // Told below.
  }
  throw definitionError(line, "a string constant is not well-formed");
}

/** The values on one line of an enum; `previous` is the last value before them. */
export function parseEnumValues(
  line: Line,
  previous: number | undefined,
  values: { name: string; value: number; doc: string }[],
): number | undefined {
  let last = previous;
  let doc = line.doc;
  for (const item of line.text.split(",")) {
    const text = item.trim();
    if (text === "") continue;
    const [name = "", value, ...more] = text.split("=").map((one) => one.trim());
    const scanner = new Scanner(name, line.number);
    scanner.name("an enum value");
    scanner.end();
    if (more.length > 0) throw definitionError(line.number, `"${text.slice(0, 40)}" is no enum value`);
    if (value === undefined && last === undefined) {
      throw definitionError(line.number, "the first value of an enum must be given");
    }
    const number = value === undefined ? ((last ?? 0) + 1) | 0 : Number(integerOf(value, line.number));
    if (number !== (number | 0)) throw definitionError(line.number, `${number} is no int32`);
    values.push({ name, value: number, doc });
    last = number;
    doc = "";
  }
  return last;
}
