// SPDX-License-Identifier: Apache-2.0
import { Definitions, RRNode, ServedObject } from "@robdef/runtime";

const definition = `service experimental.counter
stdver 0.10
object Counter
    property int32 count
    function int32 add(int32 by)
end
`;

let count = 0;
const service = new RRNode({ name: "package.service" });
service.registerService(
  "counter",
  new ServedObject(new Definitions([definition]), "experimental.counter.Counter", {
    get: () => count,
    set: (_property, value) => {
      count = value as number;
    },
    call: (_name, [by]) => (count += by as number),
  }),
);
const port = await service.listen({ host: "127.0.0.1" });
const node = new RRNode();
for (const scheme of ["rr+tcp", "rr+ws"]) {
  const client = await node.connect(`${scheme}://127.0.0.1:${port}/?service=counter`);
  await client.root.set("count", 40);
  const sum = await client.root.call("add", [2]);
  if (sum !== 42 || (await client.root.get("count")) !== 42) throw new Error(`42 expected, ${String(sum)} came`);
  await client.close();
}
await node.close();
await service.close();
console.log("the package works");
