// SPDX-License-Identifier: Apache-2.0
// Values of every type through generated code: properties of a service that keeps what it is given.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ErrorCode, MultiDimArray, enumName, RRError, RRNode, VarValue, type Skeleton, type Stub, type StubClass } from "@robdef/runtime";
import * as constants from "./experimental.constants.js";
import * as enums from "./experimental.enums.js";
import * as exceptions from "./experimental.exceptions.js";
import * as implementing from "./experimental.implements.js";
import * as named from "./experimental.namedarrays.js";
import * as pods from "./experimental.pods.js";
import * as properties from "./experimental.properties.js";
import * as words from "./experimental.typescript_words.js";

/** Keeps properties, and gives the first argument of a function back. */
function keeper(): object {
  const kept = new Map<string, unknown>();
  return new Proxy({}, {
    get: (_target, name) => {
      if (typeof name !== "string" || name.startsWith("rr_") || name === "then") return undefined;
      if (name.startsWith("get")) return () => kept.get(name.slice(3));
      if (name.startsWith("set")) return (value: unknown) => void kept.set(name.slice(3), value);
      return (first: unknown) => first;
    },
  });
}

async function withKeeper<T extends Stub>(skeleton: new (servant: never) => Skeleton, stub: StubClass<T>, use: (root: T) => Promise<void>): Promise<void> {
  const node = new RRNode();
  try {
    node.registerService("kept", new skeleton(keeper() as never));
    await use((await node.connect(`rr+tcp://127.0.0.1:${await node.listen()}/?service=kept`, stub)).root);
  } finally {
    await node.close();
  }
}

test("numbers, texts and arrays come as they were sent", () =>
  withKeeper(properties.BoardSkeleton, properties.BoardStub, async (board) => {
    await board.setEnabled(true);
    assert.equal(await board.getEnabled(), true);
    await board.setLabel("näme");
    assert.equal(await board.getLabel(), "näme");
    await board.setResponse({ re: 1, im: -2 });
    assert.deepEqual(await board.getResponse(), { re: 1, im: -2 });
    await board.setMode(properties.Mode.running);
    const mode: properties.Mode = await board.getMode();
    assert.equal(enumName(properties.Mode, mode), "running");
    await board.setSamples(Float64Array.of(0.5));
    assert.deepEqual(await board.getSamples(), Float64Array.of(0.5));
    await board.setAddress([127, 0, 0, 1]);
    assert.deepEqual(await board.getAddress(), Uint8Array.of(127, 0, 0, 1));
    await assert.rejects(board.setAddress([1]), (error: RRError) => error.code === ErrorCode.DataTypeError);
    await board.setSteps([1, -2]);
    assert.deepEqual(await board.getSteps(), Int16Array.of(1, -2));
    await board.setImage(new MultiDimArray([2, 1], Float32Array.of(1, 2)));
    assert.deepEqual(await board.getImage(), new MultiDimArray([2, 1], Float32Array.of(1, 2)));
    await board.setRotation(new MultiDimArray([3, 3], new Float64Array(9)));
    assert.deepEqual((await board.getRotation()).dims, [3, 3]);
  }));

test("containers and varvalues come as they were sent", () =>
  withKeeper(properties.BoardSkeleton, properties.BoardStub, async (board) => {
    await board.setNames(["a", "b"]);
    assert.deepEqual(await board.getNames(), ["a", "b"]);
    await board.setNames(null);
    assert.equal(await board.getNames(), null);
    await board.setByNumber(new Map([[-1, 0.5]]));
    assert.deepEqual(await board.getByNumber(), new Map([[-1, 0.5]]));
    await board.setByName(new Map([["x", [1, 2]]]));
    assert.deepEqual(await board.getByName(), new Map([["x", Int32Array.of(1, 2)]]));
    await board.setAnything(3.5);
    assert.deepEqual(await board.getAnything(), new VarValue("double[]", Float64Array.of(3.5)));
    await board.setSettings(new Map<string, unknown>([["on", true]]));
    assert.deepEqual(await board.getSettings(), new Map([["on", new VarValue("bool[]", [true])]]));
  }));

test("pods and namedarrays come as they were sent", async () => {
  await withKeeper(pods.RecorderSkeleton, pods.RecorderStub, async (recorder) => {
    const sample = pods.Sample.make({ sequence: 3, acceleration: Float32Array.of(1, 2, 3) });
    await recorder.setHistory([sample, pods.Sample.make()]);
    assert.deepEqual(await recorder.getHistory(), [sample, { sequence: 0, stamp: 0, acceleration: new Float32Array(3) }]);
    const burst = pods.Burst.make({ grid: new MultiDimArray([2, 3], Int16Array.of(1, 2, 3, 4, 5, 6)), rest: [sample] });
    await recorder.setBursts([burst, pods.Burst.make()]);
    assert.deepEqual(await recorder.getBursts(), [burst, pods.Burst.make()]);
    assert.equal(pods.Burst.make().samples.length, 4);
    await recorder.setMarked([sample]);
    assert.deepEqual(await recorder.getMarked(), [sample]);
  });
  await withKeeper(named.ArmSkeleton, named.ArmStub, async (arm) => {
    const pose = named.Pose.make({ position: { x: 1, y: 2, z: 3 } });
    await arm.setPath([pose]);
    assert.deepEqual(await arm.getPath(), [{ position: { x: 1, y: 2, z: 3 }, orientation: new Float64Array(4) }]);
    await arm.setPlaces(new Map([["home", pose]]));
    assert.deepEqual(await arm.getPlaces(), new Map([["home", pose]]));
    assert.deepEqual(await arm.cross({ x: 1, y: 0, z: 0 }, { x: 0, y: 1, z: 0 }), { x: 1, y: 0, z: 0 });
  });
});

test("namedarrays are rows of numbers, too", () => {
  assert.equal(named.Pose.count, 7);
  const numbers = Float64Array.from({ length: 14 }, (_, i) => i);
  const poses = named.Pose.fromNumbers(numbers);
  assert.deepEqual(poses[1]?.position, { x: 7, y: 8, z: 9 });
  assert.deepEqual(named.Pose.toNumbers(poses), numbers);
  assert.throws(() => named.Pose.fromNumbers(new Float64Array(8)), (error: RRError) => error.code === ErrorCode.DataTypeError);
  assert.deepEqual(named.Pixel.toNumbers([{ red: 1, green: 2, blue: 255 }]), Uint8Array.of(1, 2, 255));
});

test("constants and enums have the values of the definition", () => {
  assert.equal(constants.FAR_BELOW, -(2n ** 63n));
  assert.equal(constants.FAR_ABOVE, 2n ** 64n - 1n);
  assert.equal(constants.ALL_BITS, 0xffffffff);
  assert.deepEqual(constants.WEIGHTS, [0.25, -0.5, 1e-3]);
  assert.equal(constants.GREETING, 'Say "hello"\n\u00e9 \\ /');
  assert.deepEqual(constants.LIMITS, { trim: -100, bits: 0xffffffff, text: constants.GREETING });
  assert.equal(constants.MachineConstants.PORTS, 4);
  assert.deepEqual(enums.State, { idle: 0, running: 1, waiting: 0x10, failed: -1 });
  assert.equal(enums.Limits.lowest, -(2 ** 31));
});

test("exceptions are classes", () => {
  const error = new exceptions.ToolLost("why");
  assert.ok(error instanceof RRError);
  assert.equal(error.code, ErrorCode.RemoteError);
  assert.equal(error.errorName, "experimental.exceptions.ToolLost");
  assert.equal(error.name, "ToolLost");
});

test("an object is used as what it implements", () =>
  withKeeper(implementing.DriveSkeleton, implementing.DriveStub, async (drive) => {
    const powered: implementing.Powered = drive;
    await powered.setOn(true);
    assert.equal(await drive.getOn(), true);
  }));

test("reserved words are names", () =>
  withKeeper(words.FunctionsSkeleton, words.FunctionsStub, async (functions) => {
    await assert.rejects(functions.class(3), (error: RRError) => error.code === ErrorCode.DataTypeMismatch);
    await assert.rejects(functions.then_(3), (error: RRError) => error.code === ErrorCode.DataTypeMismatch);
    await assert.rejects(functions.constructor_(3), (error: RRError) => error.code === ErrorCode.DataTypeMismatch);
  }));
