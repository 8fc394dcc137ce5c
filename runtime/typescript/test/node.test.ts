// SPDX-License-Identifier: Apache-2.0
// Clients and services of this runtime together, over TCP and web sockets; and peers that mean no good.
import assert from "node:assert/strict";
import { connect, type Socket } from "node:net";
import { once } from "node:events";
import { test } from "node:test";
import {
  Definitions,
  ErrorCode,
  MultiDimMemory,
  OperationFailed,
  RRError,
  RRNode,
  ServedObject,
  type NodeOptions,
} from "../src/index.node.js";

const definition = `service experimental.bench
stdver 0.10
object Bench
    property double[] samples
    property varvalue{string} settings
    function int32 add(int32 a, int32 b)
    function int32{generator} count(int32 end)
    function void fail()
    event moved(double to)
    objref Bench{string} parts
    pipe int32 numbers
    wire double level
    callback int32 ask(int32 what)
    function int32 ask_client(int32 what)
    memory double[] row
    memory uint8[*] image
end
`;

async function* count(end: number): AsyncGenerator<number, void, unknown> {
  for (let i = 0; i < end; ++i) yield await Promise.resolve(i);
}

function makeBench(): ServedObject {
  let samples: unknown = new Float64Array(0);
  const bench: ServedObject = new ServedObject(new Definitions([definition]), "experimental.bench.Bench", {
    get: (name) => (name === "samples" ? samples : new Map([["name", "bench"]])),
    set: (_name, value) => {
      samples = value;
    },
    call: async (name, args, { client }) => {
      if (name === "add") return (args[0] as number) + (args[1] as number);
      if (name === "ask_client") return await bench.callback("ask").call(client, [args[0]]);
      throw new OperationFailed("as asked", { subname: "quite" });
    },
    generate: (_name, [end]) => count(end as number),
    object: (_objref, index) => (index === "none" ? null : makeBench()),
  });
  return bench;
}

async function served(options: NodeOptions = {}): Promise<{ node: RRNode; bench: ServedObject; port: number }> {
  const node = new RRNode({ name: "experimental.bench", ...options });
  const bench = makeBench();
  node.registerService("bench", bench);
  return { node, bench, port: await node.listen({ host: "127.0.0.1" }) };
}

function raises(code: number): (error: unknown) => boolean {
  return (error) => error instanceof RRError && error.code === code;
}

test("a monitor is waited for longer than for an answer", async () => {
  const node = new RRNode({ name: "experimental.bench" });
  const monitor = { enter: (timeout: number) => new Promise<boolean>((resolve) => { setTimeout(() => { resolve(timeout > 1000); }, Math.min(timeout, 700)); }), exit: () => undefined };
  node.registerService("bench", new ServedObject(new Definitions([definition]), "experimental.bench.Bench", { monitor }));
  const port = await node.listen({ host: "127.0.0.1" });
  const own = new RRNode();
  try {
    const client = await own.connect(`rr+tcp://127.0.0.1:${port}/?service=bench`, { requestTimeout: 400 });
    await assert.rejects(client.enterMonitor(client.root, 600), raises(ErrorCode.OperationTimeout));
    await client.enterMonitor(client.root, 2000);
    await client.exitMonitor(client.root);
    await client.close();
  } finally {
    await own.close();
    await node.close();
  }
});

test("generators that are closed do not count, and the last of them are known", async () => {
  const { node, port } = await served({ limits: { generators: 2 } });
  const own = new RRNode();
  try {
    const client = await own.connect(`rr+tcp://127.0.0.1:${port}/?service=bench`);
    const { root } = client;
    const open = await root.generate("count", [2]);
    assert.deepEqual(await open.next(undefined), { done: false, value: 0 });
    const closed = [];
    for (let i = 0; i < 300; ++i) {
      const one = await root.generate("count", [10]);
      assert.deepEqual(await one.next(undefined), { done: false, value: 0 });
      await (i % 2 === 0 ? one.close() : one.abort());
      closed.push(one);
    }
    const last = await root.generate("count", [10]);
    await assert.rejects(root.generate("count", [10]), raises(ErrorCode.OutOfSystemResource));
    await last.close();
    assert.deepEqual(await last.next(undefined), { done: true, value: undefined });
    await assert.rejects(closed[299]!.next(undefined), raises(ErrorCode.OperationAborted));
    await assert.rejects(closed[0]!.next(undefined), raises(ErrorCode.InvalidOperation));
    assert.deepEqual(await open.next(undefined), { done: false, value: 1 });
    await client.close();
  } finally {
    await own.close();
    await node.close();
  }
});

for (const scheme of ["rr+tcp", "rr+ws"]) {
  test(`all members work over ${scheme}`, async () => {
    const { node, bench, port } = await served();
    const own = new RRNode();
    try {
      const client = await own.connect(`${scheme}://127.0.0.1:${port}/?service=bench`);
      const { root } = client;
      const samples = Float64Array.from({ length: 100_000 }, (_, i) => i / 7);
      await root.set("samples", samples);
      assert.deepEqual(await root.get("samples"), samples);
      assert.equal(await root.call("add", [20, 22]), 42);
      await assert.rejects(root.call("fail"), (error) => error instanceof OperationFailed && error.message === "as asked" && error.subname === "quite");
      await assert.rejects(root.call("add", ["x", 1]), raises(ErrorCode.DataTypeMismatch));
      const steps: unknown[] = [];
      for await (const step of await root.generate("count", [4])) steps.push(step);
      assert.deepEqual(steps, [0, 1, 2, 3]);
      root.callback("ask").set((what) => (what as number) * 2);
      assert.equal(await root.call("ask_client", [21]), 42);
      await assert.rejects(root.object("parts", "none"), raises(ErrorCode.ServiceError));
      const part = await root.object("parts", "a/b é");
      assert.equal(await part.call("add", [1, 2]), 3);

      const events = root.event("moved")[Symbol.asyncIterator]();
      const next = events.next();
      bench.event("moved").fire(2.5);
      assert.deepEqual((await next).value, [2.5]);

      const end = await root.pipe("numbers").connect();
      const [theirs] = bench.pipe("numbers").ends;
      for (let i = 0; i < 1000; ++i) end.send(i);
      assert.ok(theirs);
      for (let i = 0; i < 1000; ++i) assert.equal(await theirs.receive(), i);
      bench.pipe("numbers").broadcast(-1);
      assert.equal(await end.receive(), -1);

      bench.wire("level").send(1.5);
      const wire = await root.wire("level").connect();
      assert.equal((await wire.wait()).value, 1.5);
      wire.send(7);
      assert.equal((await root.wire("level").peekIn()).value, 1.5);
      assert.equal((await root.wire("level").peekOut()).value, 7);

      const content = Float64Array.from({ length: 50_000 }, (_, i) => i);
      bench.memory("row").store(content);
      const row = root.memory("row");
      assert.ok(!(row instanceof MultiDimMemory));
      assert.deepEqual(await row.read(10, 40_000), content.slice(10, 40_010));
      await row.write(5, new Float64Array([-1, -2]));
      assert.deepEqual(content.slice(4, 8), new Float64Array([4, -1, -2, 7]));
      await assert.rejects(row.read(49_999, 2), raises(ErrorCode.OutOfRange));
      await client.close();
      assert.equal(await end.receive(), undefined);
      await assert.rejects(root.call("add", [1, 1]), raises(ErrorCode.InvalidOperation));
    } finally {
      await own.close();
      await node.close();
    }
  });
}

test("a call ends by its signal and by its timeout", async () => {
  const { node, port } = await served();
  const own = new RRNode();
  try {
    const client = await own.connect(`rr+tcp://127.0.0.1:${port}/?service=bench`);
    client.root.callback("ask").set(() => new Promise(() => undefined));
    const aborting = new AbortController();
    const call = client.root.call("ask_client", [1], { signal: aborting.signal });
    aborting.abort(new Error("enough"));
    await assert.rejects(call, /enough/);
    await assert.rejects(client.root.call("ask_client", [1], { timeout: 30 }), raises(ErrorCode.RequestTimeout));
    // The session goes on.
    assert.equal(await client.root.call("add", [1, 1]), 2);
  } finally {
    await own.close();
    await node.close();
  }
});

test("when the service goes, everything that waits ends", async () => {
  const { node, port } = await served();
  const own = new RRNode();
  const client = await own.connect(`rr+ws://127.0.0.1:${port}/?service=bench`);
  const closed = new Promise<RRError>((resolve) => client.onClosed(resolve));
  const end = await client.root.pipe("numbers").connect();
  const packet = end.receive();
  await node.close();
  assert.equal((await closed).code, ErrorCode.ServiceNotFound);
  assert.equal(await packet, undefined);
  await own.close();
});

async function send(port: number, bytes: Uint8Array | string): Promise<{ socket: Socket; answer: Buffer }> {
  const socket = connect(port, "127.0.0.1");
  const parts: Buffer[] = [];
  socket.on("data", (data) => parts.push(data));
  socket.on("error", () => undefined);
  await once(socket, "connect");
  socket.write(bytes);
  await Promise.race([once(socket, "close"), new Promise((resolve) => setTimeout(resolve, 3000))]);
  return { socket, answer: Buffer.concat(parts) };
}

test("who sends no message, too large ones or nothing is closed, and others are served", async () => {
  const { node, port } = await served({ firstMessageTimeout: 300, messageTimeout: 300 });
  const own = new RRNode();
  try {
    const huge = Buffer.from("5252414300000002020040000000000000000000", "hex");
    const begun = Buffer.from("52524143a0000000020040", "hex");
    for (const bytes of ["", "RR", huge, begun, "RRACxxxxxxxxxxxxxxxxxxxxxxxx", "POST / HTTP/1.1\r\n\r\n"]) {
      const { socket } = await send(port, bytes);
      assert.ok(socket.destroyed || socket.readableEnded, `still open: ${bytes.toString()}`);
      socket.destroy();
    }
    const client = await own.connect(`rr+tcp://127.0.0.1:${port}/?service=bench`);
    assert.equal(await client.root.call("add", [1, 1]), 2);
  } finally {
    await own.close();
    await node.close();
  }
});

test("pages of other origins may not connect", async () => {
  const { node, port } = await served();
  const page = (origin: string): string =>
    `GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\nOrigin: ${origin}\r\n\r\n`;
  try {
    for (const origin of ["https://example.com", "null", "http://robotraconteur.com.example.com", "file://"]) {
      const { answer, socket } = await send(port, page(origin));
      assert.match(answer.toString(), /^HTTP\/1\.1 403 /, origin);
      socket.destroy();
    }
  } finally {
    await node.close();
  }
});

test("a subscription connects again, and its wires and pipes with it", async () => {
  const first = await served();
  const own = new RRNode();
  const subscription = own.subscribe(`rr+tcp://127.0.0.1:${first.port}/?service=bench`, { retryDelay: 50 });
  try {
    const values: number[] = [];
    const packets: number[] = [];
    subscription.onWireValue<number>("level", ({ value }) => values.push(value));
    subscription.onPacket<number>("numbers", (packet) => packets.push(packet));
    const client = await subscription.wait();
    assert.equal(await client.root.call("add", [1, 2]), 3);
    first.bench.wire("level").send(1);
    const lost = new Promise((resolve) => subscription.onLost(resolve));
    await first.node.close();
    await lost;
    assert.equal(subscription.client, undefined);

    const second = new RRNode({ name: "experimental.bench" });
    try {
      const bench = makeBench();
      second.registerService("bench", bench);
      await second.listen({ port: first.port });
      bench.wire("level").send(2);
      const again = await subscription.wait(AbortSignal.timeout(5000));
      assert.notEqual(again, client);
      while (bench.pipe("numbers").ends.length === 0 || !values.includes(2)) await new Promise((resolve) => setTimeout(resolve, 10));
      bench.pipe("numbers").broadcast(7);
      while (packets.length === 0) await new Promise((resolve) => setTimeout(resolve, 10));
      assert.deepEqual(packets, [7]);
      assert.equal(values.at(-1), 2);
      await subscription.close();
      await assert.rejects(subscription.wait(), raises(ErrorCode.InvalidOperation));
    } finally {
      await second.close();
    }
  } finally {
    await subscription.close();
    await own.close();
  }
});
