// SPDX-License-Identifier: Apache-2.0
import type { Operation } from "../model/history.js";
import { comment, floating, print, type Printer } from "./printer.js";

/** A string literal: what is not printable ASCII as octal digits of UTF-8, which nothing that follows can lengthen. */
function literal(text: string): string {
  let inside = "";
  for (const byte of new TextEncoder().encode(text)) {
    const one = String.fromCharCode(byte);
    inside += one === '"' || one === "\\" || one === "?" ? `\\${one}` : byte >= 0x20 && byte < 0x7f ? one : `\\${byte.toString(8).padStart(3, "0")}`;
  }
  return `"${inside}"`;
}

const rows: Readonly<Record<string, string>> = {
  double: "double", single: "float", int8: "std::int8_t", uint8: "std::uint8_t", int16: "std::int16_t", uint16: "std::uint16_t", int32: "std::int32_t", uint32: "std::uint32_t", int64: "std::int64_t", uint64: "std::uint64_t",
};

const special: Readonly<Record<string, string>> = { NaN: "std::nan(\"\")", Infinity: "HUGE_VAL", "-Infinity": "-HUGE_VAL" };

function real(value: number): string {
  return special[String(value)] ?? floating(value);
}

const printer: Printer = {
  nothing: "rr::dynamic::Value()",
  number: (value, number) => {
    if (typeof value === "boolean") return String(value);
    if (typeof value === "bigint") return number === "uint64" ? `${value}ULL` : value === -(2n ** 63n) ? "INT64_MIN" : `${value}LL`;
    return special[String(value)] ?? (number === "double" || number === "single" ? floating(value) : String(value));
  },
  complex: ({ re, im }) => `rr::dynamic::StringMap{{"re", ${real(re)}}, {"im", ${real(im)}}}`,
  text: literal,
  enumValue: (value, name) => (name === undefined ? String(value) : literal(name)),
  numbers: (items, number) => (rows[number] ? `std::vector<${rows[number]}>{${items.join(", ")}}` : `rr::dynamic::List{${items.join(", ")}}`),
  block: (dims, items) => nested(dims, items),
  record: (_record, fields) => `rr::dynamic::Value::record({${fields.map(([name, value]) => `{${literal(name)}, ${value}}`).join(", ")}})`,
  records: (items) => `rr::dynamic::List{${items.join(", ")}}`,
  list: (items) => `rr::dynamic::List{${items.join(", ")}}`,
  map: (items, type) => `rr::dynamic::${type.container === "int32" ? "IntMap" : "StringMap"}{${items.map(([key, value]) => `{${typeof key === "number" ? key : literal(key)}, ${value}}`).join(", ")}}`,
  any: (value) => value,
};

/** Lists in each other, the first index outermost. */
export function nested(dims: readonly number[], items: readonly string[], open = "rr::dynamic::List{", close = "}"): string {
  const steps = dims.map((_, i) => dims.slice(0, i).reduce((all, dim) => all * dim, 1));
  const level = (depth: number, at: number): string =>
    depth === dims.length ? (items[at] ?? "") : `${open}${Array.from({ length: dims[depth] ?? 0 }, (_, i) => level(depth + 1, at + i * (steps[depth] ?? 0))).join(", ")}${close}`;
  return level(0, 0);
}

export function cppCode(operation: Operation): string {
  const { kind, url, steps, member, args, definitions, detail } = operation;
  const name = literal(member?.name ?? "");
  let values: string[];
  try {
    values = args.map(({ type, value }) => (definitions ? print(printer, definitions, type, value) : ""));
  } catch (error) {
    return `// ${comment(error instanceof Error ? error.message : String(error))}`;
  }
  // One argument that is a list would be taken for the arguments themselves.
  const list = values.length === 0 ? "" : `, {${values.map((one) => (values.length === 1 ? `rr::dynamic::Value(${one})` : one)).join(", ")}}`;
  const [start = "", count = ""] = (detail ?? "").split(" ");
  const print1 = (expression: string): string => `std::cout << ${expression}.to_json() << "\\n";`;
  const lines: Readonly<Partial<Record<Operation["kind"], string>>> = {
    connect: 'for (const auto& member : root->members()) std::cout << member.declaration << "\\n";',
    login: `// connect with rr::ConnectOptions{.username = ${literal(detail ?? "")}, ...}`,
    lock: `rr::lock(object.stub()${detail === "session" ? ", rr::LockOwner::session" : ""});`,
    unlock: "rr::unlock(object.stub());",
    get: print1(`object.get(${name})`),
    set: `object.set(${name}, ${values[0] ?? ""});`,
    call: member?.type.base.kind === "void" ? `object.call(${name}${list});` : print1(`object.call(${name}${list})`),
    generate: `auto generator = object.generate(${name}${list});`,
    next: `auto value = generator.next(${values.join(", ")});`,
    end: "generator.close();",
    abort: "generator.abort();",
    peek: print1(`object.wire(${name}).peek_in().value`),
    poke: `object.wire(${name}).poke_out(${values[0] ?? ""});`,
    send: `object.pipe(${name}).connect().send(${values[0] ?? ""});`,
    watch: member?.kind === "wire" || member?.kind === "pipe" ? `auto connection = object.${member.kind}(${name}).connect();` : print1(`object.${member?.kind === "function" ? "call" : "get"}(${name})`),
    answer: `object.callback(${name}).set([](const rr::dynamic::List&) { return rr::dynamic::Value(${values[0] ?? ""}); });`,
    read: print1(`object.memory(${name}).read({${start}}, {${count}})`),
    write: `object.memory(${name}).write({${start}}, ${values[0] ?? ""});`,
  };
  const path = steps.map(({ objref, index }) => `.object(${literal(objref)}${index === undefined ? "" : `, ${typeof index === "number" ? index : literal(index)}`})`).join("");
  return [
    '#include "rr/dynamic.hpp"',
    "rr::Node node;",
    `auto root = rr::dynamic::connect(node, ${literal(url)});`,
    ...(kind === "connect" || kind === "login" ? [] : [`auto object = ${path === "" ? "*root" : `root->${path.slice(1)}`};`]),
    lines[kind] ?? `// ${kind}`,
  ].join("\n");
}
