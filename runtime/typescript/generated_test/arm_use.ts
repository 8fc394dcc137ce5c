// SPDX-License-Identifier: Apache-2.0
// Uses every member of the arm; services in TypeScript and in C++ have to do alike.
import assert from "node:assert/strict";
import { ErrorCode, MultiDimArray, RRError, stubOf, VarValue } from "@robdef/runtime";
import { JointStub, Pose, Sample, Stuck, Vector3, type ArmStub } from "./experimental.arm.js";

/** Waits until it holds. */
export async function eventually(condition: () => boolean | Promise<boolean>): Promise<void> {
  const end = Date.now() + 60_000;
  while (!(await condition())) {
    if (Date.now() > end) throw new Error("it never holds");
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
}

export async function useProperties(arm: ArmStub): Promise<void> {
  await arm.setSpeed(2.5);
  assert.equal(await arm.getSpeed(), 2.5);
  await arm.setNote("mine");
  assert.equal(await arm.getNote(), "mine");
  await arm.setTrace([1, 2.5]);
  assert.deepEqual(await arm.getTrace(), Float64Array.of(1, 2.5));
}

export async function useFunctions(arm: ArmStub): Promise<void> {
  const calls = await arm.getCalls();
  assert.equal(await arm.add(3, 4), 7);
  assert.equal(await arm.getCalls(), calls + 1);
  const many = Float64Array.from({ length: 100_000 }, (_, i) => i);
  assert.deepEqual(await arm.numbers(many), many);
  assert.deepEqual(await arm.echo("text"), new VarValue("string", "text"));
  assert.equal(await arm.echo(null), null);
  assert.deepEqual(await arm.echo(Pose.varValue({ x: 1, label: "p" })), new VarValue("experimental.arm.Pose", { x: 1, label: "p" }));
  const points = Vector3.varValues([{ x: 1, y: 2, z: 3 }]);
  assert.deepEqual(await arm.echo(points), points);
}

export async function useErrors(arm: ArmStub): Promise<void> {
  const stuck: unknown = await arm.fail("rusty").catch((error: unknown) => error);
  assert.ok(stuck instanceof Stuck);
  assert.equal(stuck.name, "Stuck");
  assert.equal(stuck.message, "rusty");
  assert.equal(stuck.subname, "by.test");
  assert.deepEqual(stuck.parameter, new VarValue("double[]", Float64Array.of(5.5)));
  await assert.rejects(arm.getJoints(4), RRError);
  await assert.rejects(arm.add("3" as unknown as number, 4), (error: RRError) => error.code === ErrorCode.DataTypeMismatch);
  await assert.rejects(arm.waitLong({ signal: AbortSignal.abort(new Error("not now")) }), /not now/);
}

export async function useObjects(arm: ArmStub): Promise<void> {
  const moved = new Promise<[number, string]>((resolve) => {
    const stop = arm.moved.on((x, label) => {
      stop();
      resolve([x, label]);
    });
  });
  assert.deepEqual(await arm.move({ x: 4, label: "home" }), { x: 5, label: "home" });
  assert.deepEqual(await moved, [4, "home"]);
  const joint = await arm.getJoints(3);
  await joint.setAngle(0.25);
  assert.equal(await joint.getAngle(), 0.25);
}

/** The varobject is the joint. */
export async function useAnything(arm: ArmStub): Promise<void> {
  await (await arm.getJoints(3)).setAngle(0.75);
  assert.equal(await stubOf(await arm.getAnything(), JointStub).getAngle(), 0.75);
}

export async function useStreams(arm: ArmStub): Promise<void> {
  const end = await arm.samples.connect();
  for (const packet of [1, 2, 3]) end.send(packet);
  for (const packet of [2, 4, 6]) assert.equal(await end.receive(), packet);
  await arm.broadcast(100);
  assert.equal(await end.receive(), 100);
  await end.close();
  const wire = await arm.force.connect();
  wire.send({ x: 1, y: 2, z: 3 });
  assert.deepEqual((await wire.wait()).value, { x: 2, y: 2, z: 3 });
  assert.deepEqual((await arm.force.peekIn()).value, { x: 2, y: 2, z: 3 });
  await wire.close();
  await arm.force.pokeOut({ x: 9, y: 0, z: 0 });
  assert.deepEqual((await arm.force.peekOut()).value, { x: 9, y: 0, z: 0 });
}

export async function useCallbacks(arm: ArmStub): Promise<void> {
  arm.ask.set((question) => question * 10);
  assert.equal(await arm.askBack(7), 71);
  arm.ask.set(() => {
    throw new Stuck("no answer");
  });
  await assert.rejects(arm.askBack(7), (error) => error instanceof Stuck && error.message === "no answer");
  arm.ask.set(null);
  await assert.rejects(arm.askBack(7), RRError);
}

export async function useMemories(arm: ArmStub): Promise<void> {
  assert.equal(await arm.buffer.length(), 1000);
  await arm.buffer.write(10, [1, 2, 3]);
  assert.deepEqual(await arm.buffer.read(9, 5), Float64Array.of(0, 1, 2, 3, 0));
  assert.deepEqual(await arm.grid.dims(), [20, 30]);
  await arm.grid.write([2, 3], new MultiDimArray([2, 2], Float64Array.of(1, 2, 3, 4)));
  assert.deepEqual((await arm.grid.read([3, 3], [1, 2])).array, Float64Array.of(2, 4));
  await arm.records.write(4, [Sample.make({ seq: 7, at: Float64Array.of(1, 2, 3) })]);
  assert.deepEqual(await arm.records.read(3, 2), [Sample.make(), { seq: 7, at: Float64Array.of(1, 2, 3) }]);
}

export async function useGenerators(arm: ArmStub): Promise<void> {
  const counted: number[] = [];
  for await (const value of arm.count(4)) counted.push(value);
  assert.deepEqual(counted, [0, 1, 2, 3]);
  const opened = await arm.count(4);
  assert.deepEqual(await opened.next(), { done: false, value: 0 });
  await opened.abort();
  await assert.rejects(opened.next(), (error: RRError) => error.code === ErrorCode.OperationAborted);
  const before = (await arm.getCollected()).length;
  const sink = await arm.collect();
  await sink.next(5);
  await sink.next(6);
  await sink.close();
  await eventually(async () => (await arm.getCollected()).length === before + 2);
  assert.deepEqual((await arm.getCollected()).slice(before), Int32Array.of(5, 6));
  const refused = await arm.collect();
  await assert.rejects(async () => {
    // One that runs by itself tells it with the step after.
    await refused.next(-2);
    await refused.next(0);
  }, (error) => error instanceof Stuck && error.message === "-2 is not collected");
  const ended = await arm.collect();
  assert.equal((await ended.next(-1)).done || (await ended.next(-1)).done, true);
  const twice = await arm.twice();
  assert.deepEqual(await twice.next(21), { done: false, value: 42 });
  assert.deepEqual(await twice.next(4), { done: false, value: 8 });
  await twice.close();
}

export async function useAll(arm: ArmStub): Promise<void> {
  await useProperties(arm);
  await useFunctions(arm);
  await useErrors(arm);
  await useObjects(arm);
  await useAnything(arm);
  await useStreams(arm);
  await useCallbacks(arm);
  await useMemories(arm);
  await useGenerators(arm);
}
