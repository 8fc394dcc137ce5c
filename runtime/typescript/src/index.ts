// SPDX-License-Identifier: Apache-2.0
/**
 * Robot Raconteur in TypeScript: what browsers and Node have alike.
 *
 * @packageDocumentation
 */
import { openWebSocket } from "./channel/browser_web_socket.js";
import { ClientNode, type NodeOptions } from "./node.js";

export * from "./common.js";

/** A node in a browser: connects by web sockets. */
export class RRNode extends ClientNode {
  constructor(options: NodeOptions = {}) {
    super(options, { "rr+ws": openWebSocket, "rr+wss": openWebSocket });
  }
}
