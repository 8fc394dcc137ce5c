// SPDX-License-Identifier: Apache-2.0
// Member lines and what they consist of: types, parameters, modifiers (06, section 3).
import { isDigit, isWordCharacter, Scanner } from "./scanner.js";
import type { WrittenMember, WrittenType } from "./syntax.js";
import { product, scalarForm, type ArrayForm, type MemberKind } from "./types.js";

const containers = new Set(["list", "int32", "string", "generator"]);
const largestDimension = 0x7fffffff;

export const memberKinds: ReadonlySet<string> = new Set<MemberKind>([
  "property",
  "function",
  "event",
  "objref",
  "pipe",
  "callback",
  "wire",
  "memory",
]);

export function parseType(scanner: Scanner): WrittenType {
  const base = scanner.while((character) => isWordCharacter(character) || character === ".");
  if (base === "") scanner.fail(`expected a type at "${scanner.rest().slice(0, 20)}"`);
  const array = scanner.take("[") ? parseArray(scanner) : scalarForm;
  let container: WrittenType["container"] = "none";
  if (scanner.take("{")) {
    const word = scanner.word();
    if (!containers.has(word)) scanner.fail(`"${word}" is no container`);
    container = word as WrittenType["container"];
    scanner.need("}");
  }
  return { base, array, container };
}

/** Behind the bracket that opens. */
function parseArray(scanner: Scanner): ArrayForm {
  if (scanner.take("]")) return { kind: "array", isMaximum: false };
  if (scanner.take("*")) {
    scanner.need("]");
    return { kind: "dims" };
  }
  const dims = [dimension(scanner)];
  if (scanner.take("-")) {
    scanner.need("]");
    // A length of 0 is no limit.
    return dims[0] ? { kind: "array", length: dims[0], isMaximum: true } : { kind: "array", isMaximum: false };
  }
  if (scanner.take("]")) {
    return dims[0] ? { kind: "array", length: dims[0], isMaximum: false } : { kind: "array", isMaximum: false };
  }
  scanner.need(",");
  if (!scanner.take("]")) {
    do {
      dims.push(dimension(scanner));
    } while (scanner.take(","));
    scanner.need("]");
  }
  if (!Number.isSafeInteger(product(dims))) scanner.fail("an array is too large");
  return { kind: "dims", dims };
}

function dimension(scanner: Scanner): number {
  const digits = scanner.while(isDigit);
  const value = Number(digits);
  if (digits === "" || value > largestDimension) scanner.fail(`"${digits}" is no dimension`);
  return value;
}

/** A line of an object, or a field; the keyword is behind the scanner. */
export function parseMember(scanner: Scanner, kind: WrittenMember["kind"], doc: string): WrittenMember {
  const isCall = kind === "function" || kind === "callback" || kind === "event";
  scanner.needBlanks();
  let type: WrittenType = { base: "void", array: scalarForm, container: "none" };
  if (kind !== "event") {
    type = parseType(scanner);
    scanner.needBlanks();
  }
  const name = scanner.name("a member");
  let hadBlanks = scanner.blanks();
  let parameters: WrittenMember["parameters"] = [];
  if (isCall) {
    parameters = parseParameters(scanner);
    hadBlanks = scanner.blanks();
  }
  let modifiers: string[] = [];
  if (!scanner.atEnd) {
    if (!hadBlanks) scanner.fail("expected a blank before the modifiers");
    modifiers = parseModifiers(scanner);
  }
  scanner.end();
  return { kind, name, type, parameters, modifiers, doc, line: scanner.line };
}

function parseParameters(scanner: Scanner): { name: string; type: WrittenType }[] {
  scanner.need("(");
  scanner.blanks();
  const parameters: { name: string; type: WrittenType }[] = [];
  if (scanner.take(")")) return parameters;
  for (;;) {
    const type = parseType(scanner);
    scanner.needBlanks();
    const name = scanner.word();
    if (name === "") scanner.fail("expected the name of a parameter");
    parameters.push({ name, type });
    scanner.blanks();
    if (scanner.take(")")) return parameters;
    scanner.need(",");
    scanner.blanks();
  }
}

/** Names only: no modifier with arguments has a meaning. */
function parseModifiers(scanner: Scanner): string[] {
  const modifiers: string[] = [];
  scanner.need("[");
  for (;;) {
    const name = scanner.name("a modifier");
    if (scanner.take("(")) {
      scanner.while((character) => character !== ")");
      scanner.need(")");
    } else {
      modifiers.push(name);
    }
    scanner.blanks();
    if (scanner.take("]")) return modifiers;
    scanner.need(",");
    scanner.blanks();
    // A comma at the end is let through by existing implementations.
    if (scanner.take("]")) return modifiers;
  }
}
