// SPDX-License-Identifier: Apache-2.0
import { ErrorCode, makeError } from "./errors.js";
import { NodeId } from "./node_id.js";

/** Where a service is: `scheme://host:port/?service=name[&nodeid=...][&nodename=...]` (04, section 1). */
export interface ServiceUrl {
  /** As it was given. */
  readonly text: string;
  /** Lower case: `rr+tcp`, `rr+ws`, `rr+wss`. */
  readonly scheme: string;
  /** Without the brackets of an IPv6 address. */
  readonly host: string;
  /** The scheme's default when the text has none. */
  readonly port: number;
  /** As it is in the URL, with its slash. */
  readonly path: string;
  /** With its question mark. */
  readonly query: string;
  /** The name of the service. */
  readonly service: string;
  /** Undefined when the URL names none. */
  readonly nodeId: NodeId | undefined;
  /** Empty when the URL names none. */
  readonly nodeName: string;
}

/** Ports where the URL has none. */
const defaultPorts: Readonly<Record<string, number>> = {
  "rr+tcp": 48653,
  "rr+ws": 80,
  "rr+wss": 443,
};

const longestUrl = 8192;
const nodeNamePattern = /^[a-zA-Z][a-zA-Z0-9_.-]{0,1023}$/;
const urlPattern = /^(rrs?\+[a-z]+):\/\/(?:\[([0-9a-fA-F:.%a-z]+)\]|([^/?#:[\]@]*))(?::(\d{1,5}))?(\/[^?#]*)?(\?[^#]*)?$/;

/** Whether a text is a name that a node can have. */
export function isNodeName(name: string): boolean {
  return nodeNamePattern.test(name);
}

function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    throw makeError(ErrorCode.InvalidArgument, `"${text.slice(0, 80)}" in a URL is not percent-encoded as UTF-8`);
  }
}

/** Throws InvalidArgument for a text that is no URL of a service. */
export function parseUrl(text: string): ServiceUrl {
  const fail = (reason: string): never => {
    throw makeError(ErrorCode.InvalidArgument, `"${text.slice(0, 200)}" ${reason}`);
  };
  const match = text.length > longestUrl ? null : urlPattern.exec(text);
  if (!match) return fail("is no URL of a service: scheme://host:port/?service=name");
  const [, scheme = "", ipv6, name = "", port, path = "/", query = ""] = match;
  const defaultPort = defaultPorts[scheme];
  if (defaultPort === undefined) return fail(`has the scheme ${scheme}, which this runtime does not have`);
  const number = port === undefined ? defaultPort : Number(port);
  if (number < 1 || number > 65535) return fail("has no such port");
  const host = ipv6 ?? name;
  if (host === "") return fail("names no host");
  const values = new Map<string, string>();
  for (const part of query.slice(1).split("&")) {
    if (part === "") continue;
    const [key = "", value, ...more] = part.split("=");
    if (value === undefined || more.length > 0) return fail("has a parameter without one =");
    if (!values.has(key)) values.set(key, decoded(value));
  }
  const service = values.get("service") ?? "";
  if (service === "") return fail("names no service");
  const nodeId = values.get("nodeid");
  const nodeName = values.get("nodename") ?? "";
  if (nodeName !== "" && !isNodeName(nodeName)) return fail("has a node name that no node has");
  return { text, scheme, host, port: number, path, query, service, nodeId: nodeId ? NodeId.parse(nodeId) : undefined, nodeName };
}
