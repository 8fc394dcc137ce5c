// SPDX-License-Identifier: Apache-2.0
// What services a node has, and what other nodes it knows: from the service index of every node.
import type { RRNode } from "@robdef/runtime";
import { hostOf, serviceAt } from "./address.js";

export interface ListedService {
  readonly name: string;
  readonly rootType: string;
  readonly url: string;
}

export interface NodeServices {
  readonly host: string;
  readonly nodeName: string;
  readonly services: readonly ListedService[];
  /** URLs of other nodes that it has found. */
  readonly others: readonly { readonly name: string; readonly url: string }[];
}

type Fields = Readonly<Record<string, unknown>>;

function textOf(value: unknown): string {
  return typeof value === "string" ? value : "";
}

/** Asks the node of a URL. Rejects as connecting does. */
export async function listServices(node: RRNode, indexUrl: string): Promise<NodeServices> {
  const client = await node.connect(indexUrl);
  try {
    const found = (await client.root.call("GetLocalNodeServices")) as ReadonlyMap<number, Fields> | null;
    const services = [...(found?.values() ?? [])].map((one) => ({
      name: textOf(one.Name),
      rootType: textOf(one.RootObjectType),
      url: serviceAt(indexUrl, textOf(one.Name)),
    }));
    return { host: hostOf(indexUrl), nodeName: client.remoteName, services, others: await otherNodes(client.root) };
  } finally {
    await client.close();
  }
}

async function otherNodes(root: { call(name: string): Promise<unknown> }): Promise<{ name: string; url: string }[]> {
  try {
    const found = (await root.call("GetDetectedNodes")) as ReadonlyMap<number, Fields> | null;
    return [...(found?.values() ?? [])].flatMap((one) => {
      const list = one.ServiceIndexConnectionURL;
      const urls = list instanceof Map ? [...(list as ReadonlyMap<number, unknown>).values()] : Array.isArray(list) ? (list as unknown[]) : [];
      const url = urls.map(textOf).find((text) => /^rr\+(?:tcp|ws|wss):/.test(text));
      return url === undefined ? [] : [{ name: textOf(one.NodeName), url }];
    });
  } catch {
    // Not all nodes look for others.
    return [];
  }
}
