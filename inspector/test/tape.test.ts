// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import fc from "fast-check";
import { RRNode, type StreamOpener } from "@robdef/runtime/node";
import { checksum, readTape, RecordKind, tapeHeader, tapeRecord, joined, type TapeRecord } from "../src/tape/file.js";
import { MessageCutter } from "../src/tape/messages.js";
import { Recorder } from "../src/tape/recorder.js";
import { Tape } from "../src/tape/tape.js";
import { startWorkshop, workshopPassword } from "./workshop.js";
import { openNodeWebSocket } from "./web_socket.js";

describe("A file of a recording", () => {
  const record: TapeRecord = { kind: 1, direction: "client", connection: 3, time: 12_345n, body: Uint8Array.of(1, 2, 3) };
  const file = joined([tapeHeader(1_700_000_000_000_000_000n), tapeRecord(record), tapeRecord({ ...record, kind: 0, direction: undefined, connection: 0, body: new Uint8Array(0) })]);

  it("has the checksum of its description", () => {
    // CRC-32 of "123456789" is known.
    assert.equal(checksum(new TextEncoder().encode("123456789")), 0xcbf43926);
    assert.equal(checksum(new TextEncoder().encode("1234"), new TextEncoder().encode("56789")), 0xcbf43926);
  });

  it("is read as it was written", () => {
    const tape = readTape(file);
    assert.equal(tape.began, 1_700_000_000_000_000_000n);
    assert.equal(tape.ending, "closed");
    assert.deepEqual(tape.records, [record]);
  });

  it("that ends anywhere, or has any other byte, is read up to there or refused", () => {
    for (let size = 0; size < file.length; ++size) {
      try {
        const tape = readTape(file.subarray(0, size));
        assert.ok(tape.records.length <= 1 && tape.ending !== "closed");
      } catch (error) {
        assert.match((error as Error).message, /recording/);
        assert.ok(size < 32);
      }
    }
    fc.assert(
      fc.property(fc.integer({ min: 32, max: file.length - 1 }), fc.integer({ min: 1, max: 255 }), (at, change) => {
        const damaged = file.slice();
        damaged[at] = (damaged[at] ?? 0) ^ change;
        const tape = readTape(damaged);
        assert.ok(tape.records.length === 0 || tape.ending !== "closed");
      }),
    );
  });
});

describe("Messages", () => {
  it("are cut from a stream wherever its pieces end", () => {
    const message = (size: number): Uint8Array => {
      const bytes = Uint8Array.from({ length: size }, (_, i) => i);
      const view = new DataView(bytes.buffer);
      view.setUint32(0, 0x43415252, true);
      view.setUint32(4, size, true);
      return bytes;
    };
    fc.assert(
      fc.property(fc.array(fc.integer({ min: 8, max: 60 }), { maxLength: 8 }), fc.array(fc.integer({ min: 0, max: 30 }), { minLength: 1, maxLength: 40 }), (sizes, pieces) => {
        const whole = joined(sizes.map(message));
        const found: Uint8Array[] = [];
        const cutter = new MessageCutter((one) => found.push(one.slice()));
        let at = 0;
        for (let i = 0; at < whole.length; ++i) {
          const size = Math.max(1, pieces[i % pieces.length] ?? 1);
          cutter.push(whole.slice(at, at + size));
          at += size;
        }
        assert.deepEqual(found, sizes.map(message));
      }),
    );
  });
});

async function recorded(isFromTheStart: boolean): Promise<{ tape: Tape; bytes: Uint8Array<ArrayBuffer> }> {
  const workshop = await startWorkshop();
  const recorder = new Recorder();
  const open: StreamOpener = recorder.around(openNodeWebSocket);
  const node = new RRNode({ openers: { "rr+ws": open } });
  try {
    if (isFromTheStart) recorder.start([]);
    const client = await node.connect(workshop.url("bench"));
    if (!isFromTheStart) {
      recorder.start(client.definitions.values());
      await client.findObjectType("bench");
    }
    const { root } = client;
    await root.set("speed", 0.5);
    assert.equal(await root.get("speed"), 0.5);
    await assert.rejects(async () => root.set("speed", 11));
    assert.equal(await root.call("add", [2, 3]), 5);
    await client.authenticate("alice", { password: workshopPassword });
    const moved = new Promise((resolve) => root.event("moved").on(resolve));
    await root.set("speed", 0.75);
    await moved;
    const wire = await root.wire("position").connect();
    const pipe = await root.pipe("waves").connect();
    for (let i = 0; i < 6; ++i) {
      await wire.wait();
      await pipe.receive();
    }
    await pipe.close();
    await wire.close();
    const tool = await root.object("tools", 1);
    assert.equal(await tool.get("name"), "tool 1");
    recorder.define(client.definitions.values());
    await client.close();
    await new Promise((resolve) => setTimeout(resolve, 50));
    const bytes = recorder.stop();
    assert.ok(bytes);
    return { tape: await Tape.open("test.rrtape", bytes), bytes };
  } finally {
    await node.close();
    await workshop.close();
  }
}

describe("A recording of the page", () => {
  for (const isFromTheStart of [true, false]) {
    it(`that begins ${isFromTheStart ? "before" : "after"} connecting shows every member at its times`, async () => {
      const { tape, bytes } = await recorded(isFromTheStart);
      assert.deepEqual([...tape.problems], []);
      assert.equal(tape.ending, "closed");
      const track = (member: string, what: string): (typeof tape.tracks)[number] => {
        const found = tape.tracks.find((one) => one.member === member && one.what === what);
        assert.ok(found, `${what} ${member}`);
        return found;
      };
      const speed = track("speed", "property");
      // A set that was refused is a request all the same.
      assert.deepEqual(speed.events.map((event) => tape.value(speed, event)), [0.5, 0.5, 11, 0.75]);
      const wire = track("position", "wire");
      assert.ok(wire.events.length >= 5, `${wire.events.length} values of the wire`);
      for (const event of wire.events) {
        assert.equal(typeof tape.value(wire, event), "number");
        assert.ok(Math.abs(tape.timeOf(wire, event) * 1000 - Date.now()) < 60_000);
      }
      const waves = track("waves", "pipe");
      assert.ok(waves.events.length >= 5);
      assert.equal((tape.value(waves, waves.events[0]!) as Float64Array).length, 1000);
      const moved = track("moved", "event");
      assert.deepEqual(moved.events.map((event) => tape.value(moved, event)), [[0.5, "speed"], [0.75, "speed"]].slice(-moved.events.length));
      assert.equal(tape.value(track("add", "result"), track("add", "result").events[0]!), 5);
      const name = track("name", "property");
      assert.equal(name.path, "bench.tools[1]");
      assert.equal(tape.value(name, name.events[0]!), "tool 1");
      assert.ok(tape.events.some((event) => event.error.includes("faster than 10 m/s")));
      // What was before the first event is unknown, and after it the newest counts.
      assert.equal(tape.at(speed, -1), undefined);
      assert.equal(tape.at(speed, tape.duration), speed.events.at(-1));
      const url = [...tape.connections.values()][0]?.url ?? "";
      assert.match(url, /service=bench/);
      // The password is in no byte of it.
      assert.ok(Buffer.from(bytes).includes("alice"));
      assert.ok(!Buffer.from(bytes).includes(workshopPassword));
    });
  }

  it("has no more than it may keep, and tells what was left out", () => {
    const recorder = new Recorder();
    recorder.start(["a"]);
    recorder.start(["b"]);
    const bytes = recorder.stop();
    assert.ok(bytes);
    assert.deepEqual(readTape(bytes).records.map((one) => one.kind), [RecordKind.definition]);
    assert.equal(recorder.stop(), undefined);
  });
});
