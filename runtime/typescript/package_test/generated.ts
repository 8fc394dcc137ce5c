// SPDX-License-Identifier: Apache-2.0
import { RRNode } from "@robdef/runtime";
import { CounterSkeleton, CounterStub, type CounterService } from "./experimental.counter.js";

class Counter implements CounterService {
  private count = 0;

  getCount(): number {
    return this.count;
  }

  setCount(value: number): void {
    this.count = value;
  }

  add(by: number): number {
    return (this.count += by);
  }

  *down(): Generator<number> {
    while (this.count > 0) yield --this.count;
  }
}

const service = new RRNode({ name: "package.service" });
service.registerService("counter", new CounterSkeleton(new Counter()));
const port = await service.listen();
const node = new RRNode();
for (const scheme of ["rr+tcp", "rr+ws"]) {
  const { root: counter } = await node.connect(`${scheme}://127.0.0.1:${port}/?service=counter`, CounterStub);
  await counter.setCount(1);
  const sum = await counter.add(2);
  const down: number[] = [];
  for await (const value of counter.down()) down.push(value);
  if (sum !== 3 || down.join() !== "2,1,0" || (await counter.getCount()) !== 0) throw new Error(`${sum} and ${down.join()} came`);
}
await node.close();
await service.close();
console.log("generated code works with the package");
