// SPDX-License-Identifier: Apache-2.0
import type { Operation } from "../model/history.js";
import { comment, print, quoted, type Printer } from "./printer.js";

const rows: Readonly<Record<string, string>> = {
  double: "Float64Array", single: "Float32Array", int8: "Int8Array", uint8: "Uint8Array", int16: "Int16Array", uint16: "Uint16Array", int32: "Int32Array", uint32: "Uint32Array", int64: "BigInt64Array", uint64: "BigUint64Array",
};

function key(name: string): string {
  return /^[A-Za-z_][A-Za-z0-9_]*$/.test(name) && name !== "__proto__" ? name : `[${quoted(name)}]`;
}

function written(value: number | bigint | boolean): string {
  return typeof value === "bigint" ? `${value}n` : Object.is(value, -0) ? "-0" : String(value);
}

const printer: Printer = {
  nothing: "null",
  number: written,
  complex: ({ re, im }) => `{ re: ${written(re)}, im: ${written(im)} }`,
  text: quoted,
  enumValue: (value, name) => `${value}${name === undefined ? "" : ` /* ${name} */`}`,
  numbers: (items, number) => (rows[number] ? `${rows[number]}.of(${items.join(", ")})` : `[${items.join(", ")}]`),
  block: (dims, items, base) => `new MultiDimArray([${dims.join(", ")}], ${base.kind === "number" ? printer.numbers(items, base.number) : `[${items.join(", ")}]`})`,
  record: (_record, fields) => `{ ${fields.map(([name, value]) => `${key(name)}: ${value}`).join(", ")} }`,
  records: (items) => `[${items.join(", ")}]`,
  list: (items) => `[${items.join(", ")}]`,
  map: (items) => `new Map([${items.map(([name, value]) => `[${typeof name === "number" ? name : quoted(name)}, ${value}]`).join(", ")}])`,
  any: (value, type) => `new VarValue(${quoted(type.text)}, ${value})`,
};

export function typescriptCode(operation: Operation): string {
  const { kind, url, steps, member, args, definitions, detail } = operation;
  const name = quoted(member?.name ?? "");
  let values: string[];
  try {
    values = args.map(({ type, value }) => (definitions ? print(printer, definitions, type, value) : ""));
  } catch (error) {
    return `// ${comment(error instanceof Error ? error.message : String(error))}`;
  }
  const list = values.length === 0 ? "" : `, [${values.join(", ")}]`;
  const [start = "", count = ""] = (detail ?? "").split(" ");
  const isRow = member?.type.array.kind !== "dims";
  const part = (text: string): string => (isRow ? text : `[${text.replaceAll(",", ", ")}]`);
  const lines: Readonly<Partial<Record<Operation["kind"], string>>> = {
    connect: "console.log(client.root.type.name);",
    login: `await client.authenticate(${quoted(detail ?? "")}, { password });`,
    logout: "await client.logout();",
    lock: `await client.lock(object, ${quoted(detail ?? "user")});`,
    unlock: "await client.unlock(object);",
    get: `console.log(await object.get(${name}));`,
    set: `await object.set(${name}, ${values[0] ?? ""});`,
    call: `console.log(await object.call(${name}${list}));`,
    generate: `for await (const value of await object.generate(${name}${list})) console.log(value);`,
    next: `console.log(await generator.next(${values.join(", ")}));`,
    end: "await generator.close();",
    abort: "await generator.abort();",
    peek: `console.log((await object.wire(${name}).peekIn()).value);`,
    poke: `await object.wire(${name}).pokeOut(${values[0] ?? ""});`,
    send: `(await object.pipe(${name}).connect()).send(${values[0] ?? ""});`,
    watch: member?.kind === "wire" || member?.kind === "pipe" ? `for await (const value of await object.${member.kind}(${name}).connect()) console.log(value);` : `console.log(await object.${member?.kind === "function" ? "call" : "get"}(${name}));`,
    answer: `object.callback(${name}).set(() => ${values[0] ?? "undefined"});`,
    read: `console.log(await object.memory(${name}).read(${part(start)}, ${part(count)}));`,
    write: `await object.memory(${name}).write(${part(start)}, ${values[0] ?? ""});`,
  };
  const path = steps.map(({ objref, index }, i) => `const ${i === steps.length - 1 ? "object" : `object${i + 1}`} = await ${i === 0 ? "client.root" : `object${i}`}.object(${quoted(objref)}${index === undefined ? "" : `, ${typeof index === "number" ? index : quoted(index)}`});`);
  const body = lines[kind] ?? `// ${kind}`;
  const used = ["RRNode", ...(body.includes("new MultiDimArray") ? ["MultiDimArray"] : []), ...(body.includes("new VarValue") ? ["VarValue"] : [])].sort();
  return [
    `import { ${used.join(", ")} } from "@robdef/runtime";`,
    `const client = await new RRNode().connect(${quoted(url)});`,
    ...(path.length > 0 ? path : ["const object = client.root;"]),
    body,
  ].join("\n");
}
