// SPDX-License-Identifier: Apache-2.0
// Properties that hold for random messages and values, not for recorded ones only.
import assert from "node:assert/strict";
import { test } from "node:test";
import fc from "fast-check";
import { ByteReader } from "../src/codec/byte_reader.js";
import { ByteWriter, join, varIntSize, varTextSize, varUintSize } from "../src/codec/byte_writer.js";
import { ElementType, itemSize } from "../src/codec/element_type.js";
import { FormatError } from "../src/codec/format_error.js";
import type { Message, MessageElement, MessageEntry } from "../src/codec/message.js";
import { readElement, readMessage } from "../src/codec/read_message.js";
import { useCodes } from "../src/codec/string_table.js";
import { textLength } from "../src/codec/text.js";
import { writeElement, writeMessage } from "../src/codec/write_message.js";
import { packNumbers, readNumbers } from "../src/value/numbers.js";

const text = fc.string({ unit: "binary", maxLength: 40 });
const packedType = fc.constantFrom(...Array.from({ length: 15 }, (_, i) => i));
const nestedType = fc.constantFrom(ElementType.structure, ElementType.intMap, ElementType.stringMap, ElementType.list, ElementType.pod);

const packedElement: fc.Arbitrary<MessageElement> = fc
  .record({ name: text, type: packedType, count: fc.nat(20), typeName: fc.constantFrom("", "a.b.C"), metadata: fc.constantFrom("", "note\n") })
  .map(({ count, type, ...rest }) => {
    const items = type === ElementType.void ? 0 : count;
    return { ...rest, type, count: items, data: Uint8Array.from({ length: items * (itemSize(type) ?? 0) }, (_, i) => i & 0xff) };
  });

const { element } = fc.letrec<{ element: MessageElement }>((tie) => ({
  element: fc.oneof(
    { depthSize: "small", withCrossShrink: true },
    packedElement,
    fc
      .record({ name: text, type: nestedType, typeName: fc.constant("x.y"), metadata: fc.constant(""), elements: fc.array(tie("element"), { maxLength: 5 }) })
      .map((one) => ({ ...one, count: one.elements.length })),
  ),
}));

const entry: fc.Arbitrary<MessageEntry> = fc.record({
  type: fc.integer({ min: 0, max: 0xffff }),
  path: text,
  member: fc.oneof(text, fc.constantFrom("value", "return", "AuthenticateUser", "packettime")),
  requestId: fc.integer({ min: 0, max: 0xffffffff }),
  error: fc.integer({ min: 0, max: 0xffff }),
  metadata: fc.constantFrom("", "unreliable\n"),
  elements: fc.array(element, { maxLength: 4 }),
});

const message: fc.Arbitrary<Message> = fc.record({
  version: fc.constantFrom<2 | 4>(2, 4),
  senderNode: fc.uint8Array({ minLength: 16, maxLength: 16 }),
  receiverNode: fc.uint8Array({ minLength: 16, maxLength: 16 }),
  senderName: text,
  receiverName: text,
  senderEndpoint: fc.integer({ min: 0, max: 0xffffffff }),
  receiverEndpoint: fc.integer({ min: 0, max: 0xffffffff }),
  metadata: fc.constantFrom("", "unreliable\n"),
  messageId: fc.integer({ min: 0, max: 0xffff }),
  entries: fc.array(entry, { minLength: 1, maxLength: 4 }),
});

/** What a message means, whatever flags and codes it was written with. */
function meaning(one: MessageElement | MessageEntry): unknown {
  const { flags: _flags, extended: _extended, metadata, elements, ...rest } = one;
  const { nameCode: _n, typeNameCode: _t, pathCode: _p, memberCode: _m, data, ...kept } = rest as MessageElement & MessageEntry;
  return { ...kept, metadata: metadata ?? "", data: Array.from(data ?? []), elements: elements?.map(meaning) };
}

// A lone surrogate has no UTF-8: it is sent as U+FFFD. The texts above have none.
test("what is written is read again", () => {
  fc.assert(
    fc.property(message, (one) => {
      const again = readMessage(join(writeMessage(one)));
      assert.deepEqual(again.entries.map(meaning), one.entries.map(meaning));
      assert.equal(again.senderEndpoint, one.senderEndpoint);
      assert.equal(again.receiverName, one.receiverName);
      assert.equal(again.messageId ?? 0, one.messageId);
    }),
    { numRuns: 300 },
  );
});

test("codes for strings change no meaning", () => {
  fc.assert(
    fc.property(message, fc.boolean(), fc.boolean(), (one, standard, local) => {
      const wanted = one.entries.map(meaning);
      const coded = useCodes({ ...one, version: 4 }, { standard, local });
      assert.deepEqual(one.entries.map(meaning), wanted);
      const again = readMessage(join(writeMessage(coded)), { stringTable: standard });
      assert.deepEqual(again.entries.map(meaning), wanted);
    }),
    { numRuns: 300 },
  );
});

test("random bytes are a message or a FormatError, and take no time", () => {
  fc.assert(
    fc.property(fc.uint8Array({ maxLength: 300 }), fc.constantFrom<2 | 4>(2, 4), (bytes, version) => {
      try {
        readElement(bytes, version);
      } catch (error) {
        assert.ok(error instanceof FormatError, String(error));
      }
    }),
    { numRuns: 5000 },
  );
});

test("numbers of variable length have the size that is said, and are read again", () => {
  fc.assert(
    fc.property(fc.integer({ min: 0, max: 0xffffffff }), fc.integer(), (unsigned, signed) => {
      const writer = new ByteWriter(1);
      writer.varUint(unsigned);
      writer.varInt(signed);
      const bytes = join(writer.finish());
      assert.equal(bytes.length, varUintSize(unsigned) + varIntSize(signed));
      const reader = new ByteReader(bytes);
      assert.equal(reader.varUint(), unsigned);
      assert.equal(reader.varInt(), signed);
    }),
  );
});

test("texts have the length that is said, lone surrogates included", () => {
  fc.assert(
    fc.property(fc.array(fc.integer({ min: 0, max: 0xffff })), (units) => {
      const odd = String.fromCharCode(...units);
      assert.equal(textLength(odd), Buffer.byteLength(odd, "utf8"));
      const writer = new ByteWriter();
      writer.varText(odd);
      assert.equal(join(writer.finish()).length, varTextSize(odd));
    }),
  );
});

test("a large payload travels as a view of the array that it comes from, and is read as a view", () => {
  const numbers = new Float64Array(100_000).map((_, i) => i / 3);
  const data = packNumbers("double", numbers);
  assert.equal(data.buffer, numbers.buffer);
  const pieces = writeElement({ name: "value", type: ElementType.double, typeName: "", count: numbers.length, data }, 4);
  assert.ok(pieces.some((piece) => piece.buffer === numbers.buffer));
  const whole = join(pieces);
  const aligned = new Uint8Array(whole.length + 8);
  const offset = (8 - ((whole.length - data.length) % 8)) % 8;
  aligned.set(whole, offset);
  const read = readElement(aligned.subarray(offset, offset + whole.length), 4);
  const values = readNumbers("double", read.data ?? new Uint8Array()) as Float64Array;
  assert.equal(values.buffer, aligned.buffer);
  assert.equal(values[99_999], 33333);
});

test("elements are not nested deeper, nor more, than the limits say", () => {
  let inner: MessageElement = { name: "x", type: ElementType.list, typeName: "", count: 0, elements: [] };
  for (let i = 0; i < 70; ++i) inner = { name: "x", type: ElementType.list, typeName: "", count: 1, elements: [inner] };
  assert.throws(() => readElement(join(writeElement(inner, 4)), 4), /nested too deeply/);
  const many: MessageElement = {
    name: "x",
    type: ElementType.list,
    typeName: "",
    count: 1001,
    elements: Array.from({ length: 1001 }, (_, number) => ({ number, type: ElementType.void, typeName: "", count: 0 })),
  };
  const bytes = join(writeElement(many, 4));
  assert.equal(readElement(bytes, 4).count, 1001);
  assert.throws(() => readElement(bytes, 4, { limits: { depth: 64, elements: 1000 } }), /too many elements/);
});

test("a count that the bytes cannot hold is refused before anything is made for it", () => {
  for (const type of [ElementType.double, ElementType.list, ElementType.string]) {
    const writer = new ByteWriter();
    writer.u32(20);
    writer.text16("");
    writer.u16(type);
    writer.text16("");
    writer.text16("");
    writer.u32(0xffffffff);
    writer.u32(0);
    assert.throws(() => readElement(join(writer.finish()), 2), FormatError);
  }
});
