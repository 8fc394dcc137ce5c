// SPDX-License-Identifier: Apache-2.0
export { openNodeWebSocket } from "../../runtime/typescript/src/node/web_socket_client.js";
