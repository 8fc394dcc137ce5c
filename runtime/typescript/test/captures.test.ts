// SPDX-License-Identifier: Apache-2.0
// Every recorded message, both ways.
import assert from "node:assert/strict";
import { test } from "node:test";
import { join } from "../src/codec/byte_writer.js";
import { FormatError } from "../src/codec/format_error.js";
import { readMessage } from "../src/codec/read_message.js";
import { writeMessage } from "../src/codec/write_message.js";
import { Captures } from "./notation/captures.js";
import { jsonOfMessage, messageOfJson } from "./notation/decoded.js";
import { bytesOf, hexOf } from "./notation/hex.js";
import { object, part, text, type Json } from "./notation/json.js";

const captures = Captures.recorded();

interface Frame {
  place: string;
  hex: string;
  decoded: Json | undefined;
}

function* recordedFrames(): Generator<Frame> {
  for (const { name, scenario } of captures.scenarios()) {
    const nodes = object(scenario["nodes"]);
    for (const frame of captures.frames(scenario)) {
      const decoded = part(frame, "decoded");
      const hex = part(frame, "hex") ?? part(frame, "payload");
      if (hex === undefined) continue;
      yield {
        place: `${name} ${String(frame["n"])}`,
        hex: captures.hex(text(hex)),
        decoded: decoded === undefined ? undefined : captures.whole(decoded, nodes),
      };
    }
  }
}

const flips = [0x01, 0x80, 0xff, 0x7f];

/** 1 and 1.0 are one number, and -0 is compared by the bytes. */
function normal(json: Json): string {
  return JSON.stringify(json, (_, value: Json) =>
    value !== null && typeof value === "object" && !Array.isArray(value)
      ? Object.fromEntries(Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1)))
      : value,
  );
}

test("every recorded message is read as it was recorded, and written to the same bytes", () => {
  let count = 0;
  for (const { place, hex, decoded } of recordedFrames()) {
    const bytes = bytesOf(hex);
    const message = readMessage(bytes, { keepUnknownCodes: true });
    assert.equal(hexOf(writeMessage(message)), hex, place);
    ++count;
    if (decoded === undefined) continue;
    assert.equal(normal(jsonOfMessage(message)), normal(decoded), place);
    assert.equal(hexOf(writeMessage(messageOfJson(decoded))), hex, place);
  }
  assert.ok(count > 2500, `only ${count} messages`);
});

test("no prefix of a message is a message, and no changed byte does harm", () => {
  const seen = new Set<number>();
  for (const { place, hex } of recordedFrames()) {
    const bytes = bytesOf(hex);
    // One message of each length is enough: most differ in their numbers only.
    if (bytes.length > 700 || seen.has(bytes.length)) continue;
    seen.add(bytes.length);
    for (let length = 0; length < bytes.length; ++length) {
      assert.throws(() => readMessage(bytes.subarray(0, length)), FormatError, `${place}, ${length} bytes`);
    }
    for (let at = 0; at < bytes.length; ++at) {
      const damaged = bytes.slice();
      damaged[at] = (damaged[at] ?? 0) ^ (flips[at % flips.length] ?? 1);
      try {
        const message = readMessage(damaged);
        readMessage(join(writeMessage(message)));
      } catch (error) {
        assert.ok(error instanceof FormatError, `${place}, byte ${at}: ${String(error)}`);
      }
    }
  }
  assert.ok(seen.size > 200);
});
