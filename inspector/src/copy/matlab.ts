// SPDX-License-Identifier: Apache-2.0
import type { Operation } from "../model/history.js";
import { comment, print, type Printer } from "./printer.js";

/** A char row; what is not printable ASCII as codes, so that nothing in it ends the text or the line. */
function chars(text: string): string {
  if (text === "") return "''";
  const parts = (text.match(/[\x20-\x7e]+|[^\x20-\x7e]+/g) ?? []).map((part) => {
    if (/^[\x20-\x7e]/.test(part)) return `'${part.replaceAll("'", "''")}'`;
    // The interpreter's texts are UTF-8.
    return `char([${[...new TextEncoder().encode(part)].join(" ")}])`;
  });
  return parts.length === 1 ? (parts[0] ?? "''") : `[${parts.join(" ")}]`;
}

const special: Readonly<Record<string, string>> = { NaN: "NaN", Infinity: "Inf", "-Infinity": "-Inf" };

function real(value: number): string {
  return special[String(value)] ?? (Object.is(value, -0) ? "-0" : String(value));
}

const printer: Printer = {
  nothing: "[]",
  number: (value, number) => {
    if (typeof value === "boolean") return String(value);
    // Doubles hold 53 bits.
    if (typeof value === "bigint") return value >= -(2n ** 53n) && value <= 2n ** 53n ? String(value) : number === "uint64" ? wide(value, "uint64") : wide(value, "int64");
    return real(value);
  },
  complex: ({ re, im }) => `complex(${real(re)}, ${real(im)})`,
  text: chars,
  enumValue: (value, name) => (name === undefined ? String(value) : chars(name)),
  numbers: (items) => `[${items.join(" ")}]`,
  block: (dims, items) => `reshape([${items.join(" ")}], [${(dims.length === 1 ? [...dims, 1] : dims).join(" ")}])`,
  record: (_record, fields) => `struct(${fields.map(([name, value]) => `'${name}', ${value.startsWith("{") ? `{${value}}` : value}`).join(", ")})`,
  records: (items) => `{${items.join(", ")}}`,
  list: (items) => `{${items.join(", ")}}`,
  map: (items, type) =>
    items.length === 0
      ? `containers.Map('KeyType', '${type.container === "int32" ? "int32" : "char"}', 'ValueType', 'any')`
      : `containers.Map({${items.map(([key]) => (typeof key === "number" ? `int32(${key})` : chars(key))).join(", ")}}, {${items.map(([, value]) => value).join(", ")}}, 'UniformValues', false)`,
  any: (value, type) => `RobotRaconteurVarValue(${value}, ${chars(type.text)})`,
};

/** Of two halves of 32 bits, since literals are doubles. */
function wide(value: bigint, kind: string): string {
  const high = value >> 32n;
  const low = value & 0xffffffffn;
  return `(${kind}(${high}) * ${kind}(4294967296) + ${kind}(${low}))`;
}

export function matlabCode(operation: Operation): string {
  const { kind, url, steps, member, args, definitions, detail } = operation;
  const name = member?.name ?? "";
  let values: string[];
  try {
    values = args.map(({ type, value }) => (definitions ? print(printer, definitions, type, value) : ""));
  } catch (error) {
    return `% ${comment(error instanceof Error ? error.message : String(error))}`;
  }
  const list = values.join(", ");
  const [start = "", count = ""] = (detail ?? "").split(" ");
  // Indices begin with 1 here.
  const from = start.split(",").map((one) => Number(one) + 1).join(" ");
  const lines: Readonly<Partial<Record<Operation["kind"], string>>> = {
    connect: "disp(c)",
    login: `RobotRaconteur.Authenticate(c, ${chars(detail ?? "")}, password);`,
    logout: "RobotRaconteur.Logout(c);",
    lock: `RobotRaconteur.RequestObjectLock(o, '${detail === "session" ? "Client" : "User"}');`,
    unlock: "RobotRaconteur.ReleaseObjectLock(o);",
    get: `disp(o.${name})`,
    set: `o.${name} = ${list};`,
    call: member?.type.base.kind === "void" ? `o.${name}(${list});` : `result = o.${name}(${list})`,
    generate: `g = o.${name}(${list});`,
    next: `[ok, x] = g.TryNext(${list})`,
    end: "g.Close();",
    abort: "g.Abort();",
    peek: `disp(o.${name}.PeekInValue())`,
    poke: `o.${name}.PokeOutValue(${list});`,
    send: `p = o.${name}.Connect(-1); p.SendPacket(${list});`,
    watch: member?.kind === "wire" ? `w = o.${name}.Connect(); w.WaitInValueValid(2); disp(w.InValue)` : member?.kind === "pipe" ? `p = o.${name}.Connect(-1); disp(p.ReceivePacketWait(2))` : member?.kind === "function" ? `result = o.${name}()` : `disp(o.${name})`,
    answer: `o.${name} = @(${(member?.parameters ?? []).map((one) => one.name).join(", ")}) ${values[0] ?? "[]"};`,
    read: `part = o.${name}.Read([${from}], [${count.replaceAll(",", " ")}])`,
    write: `o.${name}.Write([${from}], ${list});`,
  };
  const path = steps.map(({ objref, index }) => `.get_${objref}(${index === undefined ? "" : typeof index === "number" ? `int32(${index})` : chars(index)})`).join("");
  return [`c = RobotRaconteur.ConnectService(${chars(url)});`, ...(kind === "connect" || kind === "login" || kind === "logout" ? [] : [`o = c${path};`]), lines[kind] ?? `% ${kind}`].join("\n");
}
