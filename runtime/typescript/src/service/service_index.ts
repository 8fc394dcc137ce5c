// SPDX-License-Identifier: Apache-2.0
// The service that tells which services a node has (05).
import { Definitions } from "../definition/definitions.js";
import { ErrorCode, makeError } from "../errors.js";
import type { NodeId } from "../node_id.js";
import { ServedObject } from "./served_object.js";
import type { Service } from "./service.js";

export const indexName = "RobotRaconteurServiceIndex";

const text = [
  "service RobotRaconteurServiceIndex",
  "struct NodeInfo",
  "field string NodeName",
  "field uint8[16] NodeID",
  "field string{int32} ServiceIndexConnectionURL",
  "end struct",
  "struct ServiceInfo",
  "field string Name",
  "field string RootObjectType",
  "field string{int32} RootObjectImplements",
  "field string{int32} ConnectionURL",
  "field varvalue{string} Attributes",
  "end struct",
  "object ServiceIndex",
  "function ServiceInfo{int32} GetLocalNodeServices()",
  "function NodeInfo{int32} GetRoutedNodes()",
  "function NodeInfo{int32} GetDetectedNodes()",
  "event LocalNodeServicesChanged()",
  "end object",
  "",
].join("\n");

/** What the index needs of its node. */
export interface IndexedNode {
  readonly id: NodeId;
  services(): Iterable<Service>;
  /** `scheme://host:port` as the client of a session reaches the node; undefined when that is not known. */
  addressFor(client: number): string | undefined;
}

function numbered(values: readonly string[]): Map<number, string> {
  return new Map(values.map((value, i) => [i, value]));
}

export function makeIndex(node: IndexedNode): ServedObject {
  const infos = (client: number): Map<number, unknown> => {
    const address = node.addressFor(client);
    if (address === undefined) throw makeError(ErrorCode.InvalidOperation, "the address of the node is not known");
    const list = [...node.services()].map((service) => ({
      Name: service.name,
      RootObjectType: service.root.type.name,
      RootObjectImplements: numbered(service.root.type.implements),
      ConnectionURL: new Map([[1, `${address}/?nodeid=${node.id.toString()}&service=${service.name}`]]),
      Attributes: service.attributes,
    }));
    return new Map(list.map((info, i) => [i, info]));
  };
  return new ServedObject(new Definitions([text]), `${indexName}.ServiceIndex`, {
    call: (name, _args, { client }) => (name === "GetLocalNodeServices" ? infos(client) : new Map()),
  });
}
