// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { GatheredSends } from "../src/channel/gathered_sends.js";
import type { ByteStream } from "../src/channel/stream.js";

/** Keeps what is sent: the bytes of each call. */
function recorder(): { readonly stream: ByteStream; readonly sent: number[][] } {
  const sent: number[][] = [];
  const stream: ByteStream = {
    remoteAddress: "",
    get waiting() {
      return 100;
    },
    start: () => undefined,
    send: (pieces) => {
      sent.push(pieces.flatMap((piece) => [...piece]));
    },
    pause: () => undefined,
    resume: () => undefined,
    close: () => undefined,
    destroy: () => undefined,
  };
  return { stream, sent };
}

const bytes = (...numbers: number[]): Uint8Array => Uint8Array.from(numbers);

describe("Gathered sends", () => {
  it("leave together at the end of the turn, in order", async () => {
    const { stream, sent } = recorder();
    const sends = new GatheredSends(stream);
    sends.send([bytes(1, 2)], 2);
    sends.send([bytes(3)], 1);
    assert.deepEqual(sent, []);
    assert.equal(sends.waiting, 103);
    await Promise.resolve();
    assert.deepEqual(sent, [[1, 2, 3]]);
    assert.equal(sends.waiting, 100);
    sends.send([bytes(4)], 1);
    await Promise.resolve();
    assert.deepEqual(sent, [[1, 2, 3], [4]]);
  });

  it("leave before a large message, which is sent at once", async () => {
    const { stream, sent } = recorder();
    const sends = new GatheredSends(stream);
    sends.send([bytes(1)], 1);
    sends.send([bytes(2), bytes(3)], 2);
    const large = new Uint8Array(5000).fill(4);
    sends.send([large], large.length);
    assert.deepEqual(sent, [[1], [2, 3], [...large]]);
    await Promise.resolve();
    assert.equal(sent.length, 3);
  });

  it("do not wait when they are many", () => {
    const { stream, sent } = recorder();
    const sends = new GatheredSends(stream);
    for (let i = 0; i < 40; ++i) sends.send([new Uint8Array(1024).fill(i)], 1024);
    assert.deepEqual(sent.map(({ length }) => length), [32 * 1024]);
    sends.flush();
    sends.flush();
    assert.deepEqual(sent.map(({ length }) => length), [32 * 1024, 8 * 1024]);
    assert.deepEqual(new Set(sent[1]), new Set([32, 33, 34, 35, 36, 37, 38, 39]));
  });
});
