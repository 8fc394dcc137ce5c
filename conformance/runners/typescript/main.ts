// SPDX-License-Identifier: Apache-2.0
// The runner of the TypeScript runtime: main.js DEFINITIONS decode|encode|serve|call
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { Definitions } from "../../../runtime/typescript/src/index.node.js";
import { CallingNode } from "./calling_node.js";
import { decode, encode } from "./codec_verbs.js";
import { answerLines } from "./lines.js";
import { ServedNode } from "./served_node.js";

const [folder, verb] = process.argv.slice(2);
if (folder === undefined) throw new Error("usage: main.js DEFINITIONS decode|encode|serve|call");
const definitions = new Definitions(
  readdirSync(folder)
    .filter((name) => name.endsWith(".robdef"))
    .map((name) => readFileSync(join(folder, name), "utf8")),
);

switch (verb) {
  case "decode":
    await answerLines((request) => decode(definitions, request));
    break;
  case "encode":
    await answerLines((request) => encode(definitions, request));
    break;
  case "call": {
    const node = new CallingNode();
    await answerLines((request) => node.answer(request));
    await node.answer({ do: "stop_node" });
    break;
  }
  case "serve": {
    const node = new ServedNode(definitions);
    await answerLines((request) => node.answer(request));
    await node.stop();
    break;
  }
  default:
    throw new Error(`unknown verb ${String(verb)}`);
}
