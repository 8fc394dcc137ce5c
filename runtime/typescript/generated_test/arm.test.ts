// SPDX-License-Identifier: Apache-2.0
// Clients and services of generated code, with each other and with those in C++.
import assert from "node:assert/strict";
import { spawn, type ChildProcess } from "node:child_process";
import { once } from "node:events";
import { createInterface } from "node:readline";
import { test } from "node:test";
import { ErrorCode, RRNode, ServedObject, stubOf, type RRError } from "@robdef/runtime";
import { Arm } from "./arm.js";
import { eventually, useAll } from "./arm_use.js";
import { ArmSkeleton, ArmStub, JointStub, rr_module } from "./experimental.arm.js";

const everything = { format4: true, stringTable: true, combinedConnect: true };
const offers = { 4: everything, 2: { format4: false, stringTable: false, combinedConnect: false } };
const programs = process.env["ROBDEF_TESTS_DIR"];

/** Gives a node that serves an arm, and closes it behind the test. */
async function withArm(use: (port: number, arm: Arm) => Promise<void>): Promise<void> {
  const node = new RRNode({ name: "test.arm" });
  try {
    const arm = new Arm();
    node.registerService("arm", new ArmSkeleton(arm));
    await use(await node.listen(), arm);
  } finally {
    await node.close();
  }
}

async function withClient(url: string, version: 2 | 4, use: (arm: ArmStub) => Promise<void>): Promise<void> {
  const node = new RRNode({ clientOffer: offers[version] });
  try {
    const client = await node.connect(url, ArmStub);
    await use(client.root);
  } finally {
    await node.close();
  }
}

/** Starts a program of the tests in C++, and ends it behind the use. */
async function withProgram(args: string[], use: (program: ChildProcess) => Promise<void>): Promise<void> {
  assert.ok(programs, "ROBDEF_TESTS_DIR says where the programs in C++ are");
  const [name = "", ...rest] = args;
  const program = spawn(`${programs}/${name}`, rest, { stdio: ["pipe", "pipe", "inherit"] });
  const exited = once(program, "exit");
  try {
    await use(program);
  } finally {
    program.stdin.end();
    const slow = setTimeout(() => program.kill("SIGKILL"), 60_000);
    await exited;
    clearTimeout(slow);
  }
}

for (const version of [4, 2] as const) {
  for (const scheme of ["rr+tcp", "rr+ws"]) {
    test(`a generated client uses a generated service by ${scheme} in format ${version}`, () =>
      withArm(async (port) => {
        await withClient(`${scheme}://127.0.0.1:${port}/?service=arm`, version, useAll);
      }));

    test(`a generated client uses a service in C++ by ${scheme} in format ${version}`, () =>
      withProgram(["csharp_arm_service"], async (program) => {
        assert.ok(program.stdout);
        const [url] = (await once(createInterface(program.stdout), "line")) as [string];
        await withClient(url.replace("rr+tcp", scheme), version, useAll);
      }));
  }

  test(`a client in C++ uses a generated service in format ${version}`, () =>
    withArm(async (port) => {
      await withProgram(["csharp_arm_client", `rr+tcp://127.0.0.1:${port}/?service=arm`, String(version)], async (program) => {
        assert.ok(program.stdout);
        const said: string[] = [];
        const lines = createInterface(program.stdout).on("line", (line) => said.push(line));
        await once(lines, "close");
        assert.deepEqual(said, []);
        await eventually(() => program.exitCode !== null);
        assert.equal(program.exitCode, 0);
      });
    }));
}

test("generators of a service hear how they end", () =>
  withArm(async (port, arm) => {
    await withClient(`rr+tcp://127.0.0.1:${port}/?service=arm`, 4, async (stub) => {
      for await (const value of stub.count(10)) if (value === 1) break;
      assert.deepEqual(arm.ends, ["closed"]);
      const aborted = await stub.count(10);
      await aborted.next();
      await aborted.abort();
      assert.deepEqual(arm.ends, ["closed", "aborted", "closed"]);
      const sink = await stub.collect();
      await sink.next(1);
      await sink.close();
      assert.deepEqual(arm.ends, ["closed", "aborted", "closed", "collected"]);
    });
  }));

test("the end of a session closes the generators of a service", () =>
  withArm(async (port, arm) => {
    await withClient(`rr+tcp://127.0.0.1:${port}/?service=arm`, 4, async (stub) => {
      await (await stub.count(10)).next();
      await (await stub.collect()).next(3);
    });
    await eventually(() => arm.ends.length === 2);
    assert.deepEqual([...arm.ends].sort(), ["closed", "collected"]);
  }));

test("a servant has one skeleton however often an objref gives it", () =>
  withArm(async (port) => {
    await withClient(`rr+tcp://127.0.0.1:${port}/?service=arm`, 4, async (stub) => {
      const [one, other] = await Promise.all([stub.getJoints(3), stub.getJoints(3)]);
      await one.setAngle(1.5);
      assert.equal(await other.getAngle(), 1.5);
      assert.equal(one.rr_object, other.rr_object);
    });
  }));

test("a stub of another type is refused", () =>
  withArm(async (port) => {
    await withClient(`rr+tcp://127.0.0.1:${port}/?service=arm`, 4, async (stub) => {
      const joint = await stub.getJoints(3);
      assert.equal(stubOf(joint, JointStub).rr_object, joint.rr_object);
      assert.throws(() => stubOf(joint, ArmStub), (error: RRError) => error.code === ErrorCode.ServiceError);
    });
  }));

test("a missing method is an error for the client", async () => {
  const node = new RRNode();
  try {
    node.registerService("arm", new ArmSkeleton({} as Arm));
    await withClient(`rr+tcp://127.0.0.1:${await node.listen()}/?service=arm`, 4, async (stub) => {
      await assert.rejects(stub.add(1, 2), (error: RRError) => error.code === ErrorCode.NotImplementedError && error.message === "add is not implemented");
    });
  } finally {
    await node.close();
  }
});

test("a generated client uses a service without generated code", async () => {
  const node = new RRNode();
  try {
    node.registerService("joint", new ServedObject(rr_module.definitions, "experimental.arm.Joint", { get: () => 4.5 }));
    const client = await node.connect(`rr+tcp://127.0.0.1:${await node.listen()}/?service=joint`, JointStub);
    assert.equal(await client.root.getAngle(), 4.5);
  } finally {
    await node.close();
  }
});
