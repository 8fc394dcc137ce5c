// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import fc from "fast-check";
import { Definitions } from "@robdef/runtime";
import { Packer } from "@robdef/runtime/messages";
import { DraftReader, emptyDraft, fullDraft, type Draft } from "../src/model/draft.js";
import { valueOf } from "./values.js";
import { workshopText } from "./workshop.js";

const definitions = new Definitions([workshopText]);

function read(typeText: string, draft: Draft): { value: unknown; problems: readonly string[] } {
  const reader = new DraftReader(definitions);
  const value = reader.value(definitions.type(typeText), draft, "v");
  return { value, problems: reader.problems.map(({ where, text }) => `${where}: ${text}`) };
}

const text = (words: string): Draft => ({ kind: "text", text: words });

describe("A draft", () => {
  const types = [
    "double", "single", "int8", "uint16", "int64", "uint64", "bool", "cdouble", "csingle", "string", "double[]", "bool[]", "uint8[4]", "int32[3-]", "cdouble[]", "double[*]", "int32[2,3]", "string{list}", "double[]{int32}", "varvalue", "varvalue{string}",
    "experimental.workshop.Mode", "experimental.workshop.Vec", "experimental.workshop.Vec[]", "experimental.workshop.Sample[2]", "experimental.workshop.Vec[*]", "experimental.workshop.Sample[2,2]", "experimental.workshop.Settings", "experimental.workshop.Settings{list}",
  ];
  for (const name of types) {
    it(`of a ${name} gives the value again`, () => {
      const type = definitions.type(name);
      fc.assert(
        fc.property(valueOf(definitions, type), (value) => {
          const reader = new DraftReader(definitions);
          const again = reader.value(type, fullDraft(definitions, type, value), "v");
          assert.deepEqual(reader.problems, []);
          const packer = new Packer(definitions);
          assert.deepEqual(packer.value(type, again, "v"), packer.value(type, value, "v"));
        }),
        { numRuns: 60 },
      );
    });

    it(`for a new ${name} is a value that can be sent`, () => {
      const type = definitions.type(name);
      const reader = new DraftReader(definitions);
      const value = reader.value(type, emptyDraft(type), "v");
      assert.deepEqual(reader.problems, []);
      new Packer(definitions).value(type, value, "v");
    });
  }

  it("says what is wrong with a number", () => {
    for (const [type, words, problem] of [
      ["uint8", "256", "v: 256 is not from 0 to 255, as uint8 is"],
      ["int32", "1.5", 'v: "1.5" is no whole number'],
      ["double", "fast", 'v: "fast" is no number'],
      ["double", "", "v: a number is missing"],
      ["double", "1 2", 'v: "1 2" is no number'],
      ["uint64", "18446744073709551616", "v: 18446744073709551616 is not from 0 to 18446744073709551615, as uint64 is"],
      ["cdouble", "1+", 'v: "1+" is no complex number such as 1.5-2i'],
      ["double[3]", "1 2", "v: 2 items, where 3 are wanted"],
      ["double[2-]", "1 2 3", "v: 3 items, where at most 2 are wanted"],
      ["uint8[]", "1, 300, 2", "v[1]: 300 is not from 0 to 255, as uint8 is"],
    ] as const) {
      assert.deepEqual(read(type, text(words)).problems, [problem], `${type} "${words}"`);
    }
  });

  it("takes numbers as people write them", () => {
    assert.equal(read("double", text(" -1.5e-3 ")).value, -0.0015);
    assert.equal(read("double", text("-inf")).value, -Infinity);
    assert.equal(read("uint8", text("0xff")).value, 255);
    assert.equal(read("int32", text("1e3")).value, 1000);
    assert.equal(read("int64", text("9007199254740993")).value, 9007199254740993n);
    assert.deepEqual(read("double[]", text("[1; 2,3\n4]")).value, Float64Array.of(1, 2, 3, 4));
    assert.deepEqual(read("cdouble", text("1.5 - 2i")).value, { re: 1.5, im: -2 });
  });

  it("of a matrix has a line for each row", () => {
    const block = { kind: "block", dims: "2 x 3", text: "1 2 3\n4 5 6" } as const;
    assert.deepEqual((read("double[2,3]", block).value as { array: unknown }).array, Float64Array.of(1, 4, 2, 5, 3, 6));
    assert.match(read("double[2,3]", { ...block, text: "1 2\n3 4\n5 6" }).problems[0] ?? "", /2 lines of 3 numbers/);
    assert.match(read("double[2,3]", { ...block, text: "1 2 3" }).problems[0] ?? "", /3 numbers, where 2 x 3 are 6/);
    assert.match(read("double[2,3]", { ...block, text: "1 2 x\n4 5 6" }).problems[0] ?? "", /v\[0, 2\]: "x" is no number/);
  });

  it("of a map refuses a key that is there twice", () => {
    const one = { key: "1", value: text("1") };
    assert.match(read("double{int32}", { kind: "map", items: [one, one] }).problems.join(), /the key 1 is there twice/);
    assert.match(read("double{int32}", { kind: "map", items: [{ key: "a", value: text("1") }] }).problems.join(), /no whole number/);
  });

  it("of an enum takes names and numbers", () => {
    assert.equal(read("experimental.workshop.Mode", text("automatic")).value, 10);
    assert.equal(read("experimental.workshop.Mode", text("77")).value, 77);
  });

  it("names the field that is wrong", () => {
    const type = definitions.type("experimental.workshop.Settings");
    const draft = emptyDraft(type) as Draft & { kind: "record" };
    const reader = new DraftReader(definitions);
    reader.value(type, { ...draft, fields: { ...draft.fields, place: { kind: "record", fields: { x: text("a"), y: text("1"), z: text("1") } } } }, "settings");
    assert.deepEqual(reader.problems.map((one) => one.where), ["settings.place.x"]);
  });
});
