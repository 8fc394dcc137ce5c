// SPDX-License-Identifier: Apache-2.0
// Every recorded value, both ways, and what the recorded library refuses.
import assert from "node:assert/strict";
import { test } from "node:test";
import type { MessageElement } from "../src/codec/message.js";
import { readElement } from "../src/codec/read_message.js";
import { writeElement } from "../src/codec/write_message.js";
import { Definitions } from "../src/definition/definitions.js";
import { RRError } from "../src/errors.js";
import { Packer } from "../src/value/pack.js";
import { Unpacker } from "../src/value/unpack.js";
import { Captures } from "./notation/captures.js";
import { bytesOf, hexOf } from "./notation/hex.js";
import { list, number, object, part, text, type Json, type JsonObject } from "./notation/json.js";
import { expanded, jsonOfValue, valueOfJson } from "./notation/values.js";

const captures = Captures.recorded();
const definitions = new Definitions(captures.definitions());

function keyOf(one: JsonObject): string | number {
  const numbered = part(one, "element_number");
  return typeof numbered === "number" ? numbered : text(expanded(part(one, "element_name") ?? ""));
}

/** Whole texts and items; the null of a varvalue is called void in the recordings. */
function typeAndValue(one: JsonObject): { type: string; value: Json } {
  const type = text(one["robdef_type"]);
  return { type: type === "void" ? "varvalue" : type, value: expanded(captures.whole(one["value"] ?? null, {})) };
}

/** How many the recordings have. */
const refused = { 2: 1, 4: 0 };

function additions({ metadata, extended }: MessageElement): Partial<MessageElement> {
  return { ...(metadata === undefined ? {} : { metadata }), ...(extended === undefined ? {} : { extended }) };
}

for (const version of [2, 4] as const) {
  const values = list(object(captures.read(`values-v${version}.json`))["values"]).map(object);

  test(`values of format ${version} are packed to the recorded bytes, and read back`, () => {
    let count = 0;
    for (const one of values) {
      const hex = part(one, "hex");
      if (hex === undefined) continue;
      const name = text(one["name"]);
      const { type, value } = typeAndValue(one);
      const known = definitions.type(type);
      const given = valueOfJson(definitions, known, value);
      const element = new Packer(definitions).value(known, given, keyOf(one));
      const metadata = part(one, "metadata");
      const extended = part(one, "extended");
      if (metadata !== undefined) element.metadata = text(metadata);
      if (extended !== undefined) element.extended = Uint8Array.from(list(extended).map(number));
      const whole = captures.hex(text(hex));
      assert.equal(hexOf(writeElement(element, version)), whole, name);
      const read = new Unpacker(definitions).value(known, readElement(bytesOf(whole), version));
      assert.equal(hexOf(writeElement({ ...new Packer(definitions).value(known, read, keyOf(one)), ...additions(element) }, version)), whole, name);
      // One number in a varvalue is read as an array of one.
      if (!JSON.stringify(value).includes('"type"')) {
        // The recordings write some singles with another last digit.
        assert.deepEqual(jsonOfValue(definitions, known, read), jsonOfValue(definitions, known, given), name);
      }
      ++count;
    }
    assert.ok(count > 250, `only ${count} values`);
  });

  test(`values of format ${version} that the recorded library refuses are refused`, () => {
    let count = 0;
    for (const one of values) {
      if (part(one, "refused") === undefined) continue;
      const { type, value } = typeAndValue(one);
      assert.throws(
        () => {
          const known = definitions.type(type);
          const element = new Packer(definitions).value(known, valueOfJson(definitions, known, value), keyOf(one));
          writeElement(element, version);
        },
        RRError,
        text(one["name"]),
      );
      ++count;
    }
    assert.equal(count, refused[version]);
  });
}
