// SPDX-License-Identifier: Apache-2.0
import { makeError, MultiDimMemory, type MultiDimArray, type RemoteObject } from "../../../runtime/typescript/src/index.node.js";
import { list, number, text, type Json, type JsonObject } from "../../../runtime/typescript/test/notation/json.js";
import { jsonOfValue, valueOfJson } from "../../../runtime/typescript/test/notation/values.js";

const invalidOperation = 17;

/** A step of a plan that is about a memory. */
export async function playMemory(operation: string, target: RemoteObject, step: JsonObject): Promise<Json> {
  const { definitions } = target.session;
  const { name, type } = target.member(text(step["member"]), "memory");
  const memory = target.memory(name);
  const numbers = (json: Json | undefined): number[] => list(json).map(number);
  if (memory instanceof MultiDimMemory) {
    if (operation === "mem_dims") return (await memory.dims()).map(String);
    if (operation === "mem_dimcount") return String(await memory.dimCount());
    if (operation === "mem_read") return jsonOfValue(definitions, type, await memory.read(numbers(step["pos"]), numbers(step["count"])));
    if (operation === "mem_write") {
      await memory.write(numbers(step["pos"]), valueOfJson(definitions, type, step["value"] ?? null) as MultiDimArray);
      return null;
    }
    throw makeError(invalidOperation, "It has dimensions");
  }
  if (operation === "mem_length") return String(await memory.length());
  if (operation === "mem_read") return jsonOfValue(definitions, type, await memory.read(number(step["pos"]), number(step["count"])));
  if (operation !== "mem_write") throw makeError(invalidOperation, "It has no dimensions");
  // Of more items than are to be written the first ones are meant.
  const items = list(step["value"]).slice(0, number(step["count"]));
  await memory.write(number(step["pos"]), valueOfJson(definitions, type, items) as ArrayLike<unknown>);
  return null;
}
