// SPDX-License-Identifier: Apache-2.0
import type { Operation } from "../model/history.js";
import { comment, floating, pascal, print, quoted, type Printer } from "./printer.js";

const special: Readonly<Record<string, string>> = { NaN: "double.NaN", Infinity: "double.PositiveInfinity", "-Infinity": "double.NegativeInfinity" };
const suffixes: Readonly<Record<string, string>> = { uint64: "UL", int64: "L", uint32: "u" };

/** The name of a class of generated code: namespaces are services in PascalCase. */
function className(name: string): string {
  return name.split(".").map(pascal).join(".");
}

function real(value: number): string {
  return special[String(value)] ?? floating(value);
}

const printer: Printer = {
  nothing: "null",
  number: (value, number) => {
    if (typeof value === "boolean") return String(value);
    if (typeof value === "bigint") return `${value}${suffixes[number] ?? ""}`;
    return special[String(value)] ?? (number === "double" || number === "single" ? `${floating(value)}${number === "single" ? "f" : ""}` : `${value}${suffixes[number] ?? ""}`);
  },
  complex: ({ re, im }) => `new(${real(re)}, ${real(im)})`,
  text: quoted,
  enumValue: (value, name, type) => (name === undefined ? `(${className(type)})${value < 0 ? `(${value})` : value}` : `${className(type)}.${pascal(name)}`),
  numbers: (items) => `[${items.join(", ")}]`,
  block: (dims, items) => `new([${dims.join(", ")}], [${items.join(", ")}])`,
  record: (record, fields) => `new ${className(record.name)} { ${fields.map(([name, value]) => `${pascal(name)} = ${value}`).join(", ")} }`,
  records: (items) => `[${items.join(", ")}]`,
  list: (items) => `[${items.join(", ")}]`,
  map: (items) => `new() { ${items.map(([key, value]) => `[${typeof key === "number" ? key : quoted(key)}] = ${value}`).join(", ")} }`,
  any: (value, type) => `new VarValue(${quoted(type.text)}, ${value})`,
};

export function csharpCode(operation: Operation): string {
  const { kind, url, steps, member, args, definitions, detail, objectType } = operation;
  const name = pascal(member?.name ?? "");
  let values: string[];
  try {
    values = args.map(({ type, value }) => (definitions ? print(printer, definitions, type, value) : ""));
  } catch (error) {
    return `// ${comment(error instanceof Error ? error.message : String(error))}`;
  }
  const list = values.join(", ");
  const [start = "", count = ""] = (detail ?? "").split(" ");
  const isVoid = member?.type.base.kind === "void";
  const call = `await target.${name}Async(${list})`;
  const lines: Readonly<Partial<Record<Operation["kind"], string>>> = {
    connect: "Console.WriteLine(client.Root);",
    login: `client.Authenticate(${quoted(detail ?? "")}, password);`,
    logout: "client.Logout();",
    lock: `target.RrLock(sessionOnly: ${detail === "session"});`,
    unlock: "target.RrUnlock();",
    get: `Console.WriteLine(await target.Get${name}Async());`,
    set: `await target.Set${name}Async(${list});`,
    call: isVoid ? `${call};` : `Console.WriteLine(${call});`,
    generate: `using var generator = target.${name}(${list});`,
    next: member?.generator?.gives ? `if (generator.TryNext(${list === "" ? "" : `${list}, `}out var value)) Console.WriteLine(value);` : `generator.TryNext(${list});`,
    end: "generator.Close();",
    abort: "generator.Abort();",
    peek: `Console.WriteLine(target.${name}.PeekInValue().Value);`,
    poke: `target.${name}.PokeOutValue(${list});`,
    send: `target.${name}.Connect().Send(${list});`,
    watch: member?.kind === "wire" || member?.kind === "pipe" ? `using var connection = target.${name}.Connect();` : `Console.WriteLine(await target.${member?.kind === "function" ? "" : "Get"}${name}Async());`,
    answer: `target.Set${name}((${(member?.parameters ?? []).map((one) => one.name).join(", ")}) => ${values[0] ?? "{ }"});`,
    read: member?.type.array.kind === "dims" ? `target.${name}.Read([${start}], [${count}], items);` : `target.${name}.Read(${start}, items);  // of ${count} items`,
    write: `target.${name}.Write(${member?.type.array.kind === "dims" ? `[${start}]` : start}, ${list});`,
  };
  const path = steps.map(({ objref, index }) => `.Get${pascal(objref)}(${index === undefined ? "" : typeof index === "number" ? index : quoted(index)})`).join("");
  const root = rootType(operation);
  return [
    "// with code that robdef generate --lang csharp made",
    "using Robdef.Runtime;",
    "using var node = new Node();",
    `using var client = node.Connect<${root}Stub>(${quoted(url)});`,
    ...(kind === "connect" || kind === "login" || kind === "logout" ? [] : [`var target = client.Root${path};${objectType === "" ? "" : `  // ${className(objectType)}`}`]),
    lines[kind] ?? `// ${kind}`,
  ].join("\n");
}

function rootType({ rootType: root, objectType, steps }: Operation): string {
  return className(root ?? (steps.length === 0 ? objectType : "")) || "Root";
}
