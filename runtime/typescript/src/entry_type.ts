// SPDX-License-Identifier: Apache-2.0

/** Type numbers of message entries (07, section 2). An answer has the number of its request plus one. */
export const EntryType = {
  streamOp: 1,
  streamOpRet: 2,
  streamCheckCapability: 3,
  streamCheckCapabilityRet: 4,
  getServiceDesc: 101,
  objectTypeName: 103,
  serviceClosed: 105,
  connectClient: 107,
  connectClientRet: 108,
  disconnectClient: 109,
  connectionTest: 111,
  connectionTestRet: 112,
  getNodeInfo: 113,
  nodeCheckCapability: 117,
  getServiceAttributes: 119,
  connectClientCombined: 121,
  connectClientCombinedRet: 122,
  endpointCheckCapability: 501,
  serviceCheckCapability: 1101,
  clientKeepAlive: 1105,
  clientSessionOp: 1107,
  servicePathReleased: 1109,
  propertyGet: 1111,
  propertySet: 1113,
  functionCall: 1121,
  generatorNext: 1123,
  event: 1131,
  pipePacket: 1141,
  pipePacketRet: 1142,
  pipeConnect: 1143,
  pipeDisconnect: 1145,
  pipeClosed: 1147,
  callbackCall: 1151,
  callbackCallRet: 1152,
  wirePacket: 1161,
  wirePacketRet: 1162,
  wireConnect: 1163,
  wireDisconnect: 1165,
  wireClosed: 1167,
  memoryRead: 1171,
  memoryReadRet: 1172,
  memoryWrite: 1173,
  memoryGetParam: 1175,
  wirePeekIn: 1181,
  wirePeekOut: 1183,
  wirePokeOut: 1185,
} as const;

/** Types below are handled by nodes without a session. */
export const firstSessionType = 500;

/** Whether an entry that is alone in its message is for a node, not for a session. */
export function isSpecialType(type = 0): boolean {
  return type > 0 && type < firstSessionType;
}

/** Metadata of what a transport may drop. */
export const unreliableMark = "unreliable\n";
