// SPDX-License-Identifier: Apache-2.0
import type { Offer } from "./channel/capabilities.js";
import type { NodeId } from "./node_id.js";

/** What peers may make a node hold. More closes the connection. */
export interface Limits {
  /** Bytes of a message, received; 100 less when sent. */
  messageSize: number;
  /** The same before a session is connected and, where users are needed, logged in. */
  sizeBeforeSession: number;
  /** Elements in each other. */
  depth: number;
  /** Elements of a message, nested ones included. */
  elements: number;
  /** The same before a session. */
  elementsBeforeSession: number;
  /** Bytes that may wait to be sent on one connection. */
  sendQueue: number;
  /** Packets of one pipe end, or events of one iterator, that wait to be read. */
  packetQueue: number;
  /** Bytes of one service definition, and of all of one session. */
  definitionSize: number;
  /** Bytes of all service definitions of one session. */
  definitionsSize: number;
  /** Definitions of one session. */
  definitions: number;
  /** Requests of one session that a service handles at a time; more wait, unread. */
  requestsAtOnce: number;
  /** Ends of one pipe, generators and objects of one session. */
  pipeEnds: number;
  /** Generators of one session. */
  generators: number;
  /** Objects of one session. */
  objects: number;
  /** Connections that a node accepts at a time. */
  connections: number;
}

/** How a node behaves. Times are in milliseconds. */
export interface NodeSettings {
  /** Letters, digits, `_`, `.`, `-`, a letter first; empty for none. */
  name: string;
  /** The node's id. A random one unless it is given. */
  id: NodeId;
  /** What is offered to services, and to clients. */
  clientOffer: Offer;
  /** What is offered to clients. */
  serverOffer: Offer;
  /** How long a call waits for its answer. */
  requestTimeout: number;
  /** How long connecting to a service may take. */
  connectTimeout: number;
  /** A service closes connections that bring no whole message for so long after they are made. */
  firstMessageTimeout: number;
  /** A message that has begun must be whole after this time, and a second for each 64 KiB. */
  messageTimeout: number;
  /** A side that has sent nothing for so long sends a connection test. */
  heartbeatPeriod: number;
  /** A connection is given up when nothing came for so long after something was sent. */
  receiveTimeout: number;
  /** A client that has sent nothing for so long tells its service that it is there. */
  keepAlivePeriod: number;
  /** A service drops clients that it has not heard for so long. */
  clientTimeout: number;
  /** A service drops generators that nobody used for so long. */
  generatorTimeout: number;
  /** Bytes of a memory that travel in one request; the smaller one of both sides counts. */
  memoryTransferLimit: number;
  /** What peers may make the node hold. */
  limits: Limits;
  /** Hears what no caller is told. Nothing is printed. */
  log: (level: "info" | "warning" | "error", message: string) => void;
}

const everything: Offer = { format4: true, stringTable: true, combinedConnect: true };

/** The limits that hold where nothing else is said. */
export const defaultLimits: Limits = {
  messageSize: 12 * 1024 * 1024,
  sizeBeforeSession: 512 * 1024,
  depth: 64,
  elements: 500_000,
  elementsBeforeSession: 16_384,
  sendQueue: 64 * 1024 * 1024,
  packetQueue: 65_536,
  definitionSize: 4 * 1024 * 1024,
  definitionsSize: 16 * 1024 * 1024,
  definitions: 256,
  requestsAtOnce: 64,
  pipeEnds: 64,
  generators: 1024,
  objects: 4096,
  connections: 256,
};

/** All settings but the identity, as they are when nothing else is said. */
export const defaultSettings: Omit<NodeSettings, "id"> = {
  name: "",
  clientOffer: everything,
  serverOffer: { ...everything, stringTable: false },
  requestTimeout: 15_000,
  connectTimeout: 5_000,
  firstMessageTimeout: 5_000,
  messageTimeout: 10_000,
  heartbeatPeriod: 10_000,
  receiveTimeout: 15_000,
  keepAlivePeriod: 60_000,
  clientTimeout: 600_000,
  generatorTimeout: 600_000,
  memoryTransferLimit: 102_400,
  limits: defaultLimits,
  log: () => undefined,
};
