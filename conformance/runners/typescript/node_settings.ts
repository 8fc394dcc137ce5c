// SPDX-License-Identifier: Apache-2.0
import { NodeId, type NodeOptions } from "../../../runtime/typescript/src/index.node.js";
import { list, number, object, part, text, type Json, type JsonObject } from "../../../runtime/typescript/test/notation/json.js";

const pageMask = 0xfff00000;
const page2 = 0x02000000;
const page4 = 0x04000000;
const pageStrings = 0x04100000;

/** The node that a request asks for. */
export function nodeOptions(request: JsonObject): NodeOptions {
  const node = object(request["node"]);
  const stringTable = request["string_table"] === true;
  const server = { format4: true, stringTable, combinedConnect: true };
  for (const withheld of list(part(request, "withheld_capabilities") ?? []).map(number)) {
    const page = (withheld & pageMask) >>> 0;
    if ((page === page2 || page === page4) && withheld & 0x2) server.combinedConnect = false;
    if (page === page4 && withheld & 0x1) server.format4 = false;
    if (page === pageStrings) server.stringTable = false;
  }
  const options: NodeOptions = {
    id: NodeId.parse(text(node["id"])),
    name: text(node["name"]),
    clientOffer: { format4: number(request["message_version"]) === 4, stringTable, combinedConnect: true },
    serverOffer: server,
    log: (level, message) => {
      process.stderr.write(`${level}: ${message}\n`);
    },
  };
  const heartbeat = part(request, "heartbeat_ms");
  if (heartbeat !== undefined) options.heartbeatPeriod = number(heartbeat);
  const transfer = part(part(request, "node_options"), "memory_max_transfer");
  if (transfer !== undefined) options.memoryTransferLimit = number(transfer);
  return options;
}

export function optional(json: Json | undefined, key: string): Json {
  return part(json, key) ?? null;
}
