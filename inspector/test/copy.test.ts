// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { describe, it } from "node:test";
import { runInThisContext } from "node:vm";
import fc from "fast-check";
import { Definitions, MultiDimArray, VarValue, type ValueType } from "@robdef/runtime";
import { Packer } from "@robdef/runtime/messages";
import { codeOf, languages } from "../src/copy/code.js";
import type { Operation } from "../src/model/history.js";
import { jsonText, valueText } from "../src/model/value_text.js";
import { valueOf } from "./values.js";
import { hostileName, workshopText } from "./workshop.js";

const definitions = new Definitions([workshopText]);
const bench = definitions.object("experimental.workshop.Bench");
const url = "rr+ws://host:1/?service=bench";

function operation(kind: Operation["kind"], name: string, args: readonly { type: ValueType; value: unknown }[], more: Partial<Operation> = {}): Operation {
  const member = bench.members.get(name);
  return { kind, url, definitions, steps: [], objectType: bench.name, rootType: bench.name, ...(member ? { member } : {}), args: args.map((one, i) => ({ name: `a${i}`, ...one })), ...more };
}

/** What an expression of TypeScript is. */
function evaluated(expression: string): unknown {
  const make = runInThisContext(`(MultiDimArray, VarValue) => (${expression})`) as (...classes: unknown[]) => unknown;
  return make(MultiDimArray, VarValue);
}

const double = definitions.type("double");
const string = definitions.type("string");

describe("Code that was copied", () => {
  it("is what the languages' pages describe", () => {
    const set = operation("set", "speed", [{ type: double, value: 0.5 }], { steps: [{ objref: "tools", index: 2 }, { objref: "named_tools", index: "left one" }] });
    const ends = Object.fromEntries(languages.map(([language]) => [language, codeOf(language, set).split("\n").slice(-2)]));
    assert.deepEqual(ends, {
      shell: [`robdef set '${url}' 'tools[2].named_tools[left one].speed' 0.5`],
      typescript: ['const object = await object1.object("named_tools", "left one");', 'await object.set("speed", 0.5);'],
      cpp: ['auto object = root->object("tools", 2).object("named_tools", "left one");', 'object.set("speed", 0.5);'],
      csharp: ['var target = client.Root.GetTools(2).GetNamedTools("left one");  // Experimental.Workshop.Bench', "await target.SetSpeedAsync(0.5);"],
      matlab: ["o = c.get_tools(int32(2)).get_named_tools('left one');", "o.speed = 0.5;"],
    });
    const add = operation("call", "add", [{ type: double, value: 2 }, { type: double, value: -1.5 }]);
    assert.equal(codeOf("shell", add), `robdef call '${url}' add 2 -1.5`);
    assert.match(codeOf("cpp", add), /object\.call\("add", \{2\.0, -1\.5\}\)/);
    assert.match(codeOf("csharp", add), /await target\.AddAsync\(2\.0, -1\.5\)/);
    assert.match(codeOf("matlab", add), /o\.add\(2, -1\.5\)/);
  });

  it("exists for everything that can be done", () => {
    for (const kind of ["connect", "close", "login", "logout", "lock", "unlock", "get", "set", "call", "generate", "next", "end", "abort", "peek", "poke", "watch", "send", "answer", "read", "write"] as const) {
      for (const [language] of languages) assert.notEqual(codeOf(language, operation(kind, "table", [{ type: double, value: 1 }], { detail: "0 10" })), "");
    }
  });

  it("does not break out of its texts", () => {
    const evil = `'"\`$(touch /tmp/never)\\n\n\r\u2028%{x}? ${hostileName}`;
    const call = operation("call", "fail", [{ type: string, value: evil }], { steps: [{ objref: "named_tools", index: evil }] });
    // The shell itself tells what words there are.
    const words = execFileSync("sh", ["-c", `robdef() { printf '%s\\0' "$@"; }; ${codeOf("shell", call)}`]).toString().split("\0");
    assert.equal(words.length, 5);
    assert.equal(JSON.parse(words[3] ?? ""), evil);
    const literal = /call\("fail", \[(.*)\]\)\);$/.exec(codeOf("typescript", call))?.[1] ?? "";
    assert.equal(evaluated(literal), evil);
    for (const language of ["cpp", "csharp", "matlab"] as const) assert.ok(codeOf(language, call).split("\n").length <= 6, language);
    for (const line of codeOf("cpp", call).split("\n")) assert.match(line, /^[\x20-\x7e]*$/);
    for (const line of codeOf("matlab", call).split("\n")) assert.match(line, /^[\x20-\x7e]*$/);
  });

  it("of TypeScript gives the same values", () => {
    for (const name of ["experimental.workshop.Settings", "double[*]", "varvalue", "int64[]", "cdouble", "double[]{int32}"]) {
      const type = definitions.type(name);
      fc.assert(
        fc.property(valueOf(definitions, type), (value) => {
          const code = codeOf("typescript", operation("set", "speed", [{ type, value }]));
          const literal = /set\("speed", (.*)\);$/s.exec(code)?.[1] ?? "";
          const again = evaluated(literal);
          const packer = new Packer(definitions);
          assert.deepEqual(packer.value(type, again, "v"), packer.value(type, value, "v"));
        }),
        { numRuns: 40 },
      );
    }
  });

  it("says that values are too large to be written", () => {
    const type = definitions.type("double[]");
    assert.match(codeOf("cpp", operation("set", "speed", [{ type, value: new Float64Array(100_000) }])), /^\/\/ the values are too large/);
  });
});

describe("A value as a text", () => {
  it("of JSON is as the command line has it", () => {
    const json = (type: string, value: unknown): string => jsonText(definitions, definitions.type(type), value);
    assert.equal(json("int64", 9007199254740993n), "9007199254740993");
    assert.equal(json("double[]", Float64Array.of(1, NaN, -Infinity)), '[1,"NaN","-Infinity"]');
    assert.equal(json("cdouble", { re: 1, im: -2 }), "[1,-2]");
    assert.equal(json("experimental.workshop.Mode", 10), '"automatic"');
    assert.equal(json("experimental.workshop.Mode", 5), "5");
    assert.equal(json("double[*]", new MultiDimArray([2, 3], Float64Array.of(1, 4, 2, 5, 3, 6))), "[[1,2,3],[4,5,6]]");
    assert.equal(json("double[*]", new MultiDimArray([0, 3], new Float64Array(0))), '{"array":[],"dims":[0,3]}');
    assert.equal(json("double{int32}", new Map([[-3, 1]])), '{"-3":1}');
    assert.equal(json("varvalue", new VarValue("double[]", Float64Array.of(1))), '{"type":"double[]","value":[1]}');
    assert.equal(json("varvalue", null), "null");
  });

  it("that is short ends where it is full", () => {
    const long = valueText(definitions.type("double[]"), new Float64Array(1000), 40);
    assert.ok(long.length <= 40);
    assert.match(long, /^1000 items/);
    assert.equal(valueText(definitions.type("experimental.workshop.Vec"), { x: 1, y: 1 / 3, z: -2 }), "{x: 1, y: 0.3333333, z: -2}");
    fc.assert(
      fc.property(valueOf(definitions, definitions.type("experimental.workshop.Settings")), (value) => {
        assert.ok(valueText(definitions.type("experimental.workshop.Settings"), value, 100).length <= 100);
      }),
    );
  });
});
