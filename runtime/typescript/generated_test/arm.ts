// SPDX-License-Identifier: Apache-2.0
// The arm of the tests between languages, served by plain classes.
import { InvalidArgument, MultiDimArray, VarValue, type Caller } from "@robdef/runtime";
import { JointSkeleton, Sample, Stuck, type ArmService, type ArmSkeleton, type JointService, type Pose } from "./experimental.arm.js";

class Joint implements JointService {
  private angle = 0;

  getAngle(): number {
    return this.angle;
  }

  setAngle(value: number): void {
    this.angle = value;
  }
}

export class Arm implements ArmService {
  readonly joint = new Joint();
  private io!: ArmSkeleton;
  private readonly notes = new Map<number, string>();
  private readonly collected: number[] = [];
  private anything: JointSkeleton | undefined;
  private speed = 0;
  private calls = 0;
  private trace: Float64Array = new Float64Array();
  /** How generators ended: `closed`, `aborted`. */
  readonly ends: string[] = [];

  rr_bind(io: ArmSkeleton): void {
    this.io = io;
    io.buffer.store(new Float64Array(1000));
    io.grid.store(new MultiDimArray([20, 30], new Float64Array(600)));
    io.records.store(Array.from({ length: 10 }, () => Sample.make()));
    io.samples.onConnect((end) => {
      end.onPacket((packet) => end.send(packet * 2));
    });
    io.force.onValue((value) => {
      io.force.send({ ...value, x: value.x + 1 });
    });
  }

  getSpeed(): number {
    return this.speed;
  }
  setSpeed(value: number): void {
    this.speed = value;
  }
  getNote({ client }: Caller): string {
    return this.notes.get(client) ?? "";
  }
  setNote(value: string, { client }: Caller): void {
    this.notes.set(client, value);
  }
  getCalls(): number {
    return this.calls;
  }
  getCollected(): number[] {
    return this.collected;
  }
  getTrace(): Float64Array {
    return this.trace;
  }
  setTrace(value: Float64Array): void {
    this.trace = value;
  }
  add(a: number, b: number): number {
    ++this.calls;
    return a + b;
  }
  fail(why: string): void {
    throw new Stuck(why, { subname: "by.test", parameter: new VarValue("double[]", [5.5]) });
  }
  move(target: Pose | null): Pose | null {
    if (!target) return null;
    this.io.moved.fire(target.x, target.label);
    return { x: target.x + 1, label: target.label };
  }
  async waitLong(): Promise<void> {
    await new Promise((resolve) => setTimeout(resolve, 2000));
  }
  echo(value: VarValue | null): VarValue | null {
    return value;
  }
  numbers(values: Float64Array): Float64Array {
    return values;
  }
  getJoints(index: number): Joint {
    if (index !== 3) throw new InvalidArgument("there is no such joint");
    return this.joint;
  }
  getAnything(): JointSkeleton {
    return (this.anything ??= new JointSkeleton(this.joint));
  }
  broadcast(packet: number): void {
    this.io.samples.broadcast(packet);
  }
  async askBack(question: number, { client }: Caller): Promise<number> {
    return (await this.io.ask.call(client, [question])) + 1;
  }
  async *count(limit: number): AsyncGenerator<number> {
    try {
      for (let i = 0; i < limit; ++i) yield await Promise.resolve(i);
    } catch (error) {
      this.ends.push("aborted");
      throw error;
    } finally {
      this.ends.push("closed");
    }
  }
  async collect(values: AsyncIterable<number>): Promise<void> {
    for await (const value of values) {
      if (value === -2) throw new Stuck("-2 is not collected");
      if (value < 0) return;
      this.collected.push(value);
    }
    this.ends.push("collected");
  }
  async *twice(values: AsyncIterable<number>): AsyncGenerator<number> {
    for await (const value of values) yield 2 * value;
  }
}

