// SPDX-License-Identifier: Apache-2.0
// Messages and elements as the captures write them down: `decoded`. Node ids are written out, texts are whole.
import { ElementType, isNested } from "../../src/codec/element_type.js";
import { ElementFlag, EntryFlag, HeaderFlag, type Message, type MessageElement, type MessageEntry } from "../../src/codec/message.js";
import { decodeStrictText, encodeText } from "../../src/codec/text.js";
import { NodeId } from "../../src/node_id.js";
import { bytesOf, hexOf } from "./hex.js";
import { list, number, object, part, text, type Json, type JsonObject } from "./json.js";
import { jsonOfNumbers, numbersOfJson } from "./numbers.js";

const none = new Uint8Array(0);
const zeroNode = new Uint8Array(16);

function idText(id: Uint8Array | undefined): string {
  return NodeId.fromBytes(id ?? zeroNode).toString();
}

export function jsonOfMessage(message: Message): JsonObject {
  return {
    header: message.version === 2 ? jsonOfHeader2(message) : jsonOfHeader4(message),
    entries: message.entries.map((entry) => jsonOfEntry(entry, message.version)),
  };
}

function jsonOfHeader2(message: Message): JsonObject {
  const header: JsonObject = {
    version: 2,
    sender_node_id: idText(message.senderNode),
    receiver_node_id: idText(message.receiverNode),
    sender_endpoint: message.senderEndpoint ?? 0,
    receiver_endpoint: message.receiverEndpoint ?? 0,
    message_id: message.messageId ?? 0,
  };
  if (message.senderName) header["sender_node_name"] = message.senderName;
  if (message.receiverName) header["receiver_node_name"] = message.receiverName;
  if (message.metadata) header["metadata"] = message.metadata;
  if (message.messageResId) header["message_res_id"] = message.messageResId;
  return header;
}

function jsonOfHeader4(message: Message): JsonObject {
  const flags = message.flags ?? 0;
  const header: JsonObject = { version: 4, flags };
  if (flags & HeaderFlag.routing) {
    header["sender_node_id"] = idText(message.senderNode);
    header["receiver_node_id"] = idText(message.receiverNode);
    header["sender_node_name"] = message.senderName ?? "";
    header["receiver_node_name"] = message.receiverName ?? "";
  }
  if (flags & HeaderFlag.endpoints) {
    header["sender_endpoint"] = message.senderEndpoint ?? 0;
    header["receiver_endpoint"] = message.receiverEndpoint ?? 0;
  }
  if (flags & HeaderFlag.priority) header["priority"] = message.priority ?? 0;
  if (flags & HeaderFlag.meta) {
    header["metadata"] = message.metadata ?? "";
    header["message_id"] = message.messageId ?? 0;
    header["message_res_id"] = message.messageResId ?? 0;
  }
  if (flags & HeaderFlag.stringTable) header["string_table"] = (message.strings ?? []).map(([code, one]) => [code, one]);
  if (flags & HeaderFlag.extended) header["extended"] = hexOf(message.extended ?? none);
  return header;
}

function jsonOfEntry(entry: MessageEntry, version: 2 | 4): JsonObject {
  const json: JsonObject = {
    entry_type: entry.type,
    service_path: entry.path,
    member: entry.member,
    request_id: entry.requestId,
    error: entry.error,
  };
  if (version === 2) {
    if (entry.metadata) json["metadata"] = entry.metadata;
  } else {
    const flags = entry.flags ?? 0;
    json["flags"] = flags;
    if (flags & EntryFlag.pathCode) json["service_path_code"] = entry.pathCode ?? 0;
    if (flags & EntryFlag.memberCode) json["member_code"] = entry.memberCode ?? 0;
    if (flags & EntryFlag.meta) json["metadata"] = entry.metadata ?? "";
    if (flags & EntryFlag.extended) json["extended"] = hexOf(entry.extended ?? none);
  }
  json["elements"] = entry.elements.map((element) => jsonOfElement(element, version));
  return json;
}

export function jsonOfElement(element: MessageElement, version: 2 | 4): JsonObject {
  const json: JsonObject = { type: element.type, count: element.count };
  if (version === 2) {
    json["name"] = element.name ?? "";
    if (element.typeName) json["type_name"] = element.typeName;
    if (element.metadata) json["metadata"] = element.metadata;
  } else {
    const flags = element.flags ?? 0;
    json["flags"] = flags;
    if (flags & (ElementFlag.name | ElementFlag.nameCode)) json["name"] = element.name ?? "";
    if (flags & ElementFlag.nameCode) json["name_code"] = element.nameCode ?? 0;
    if (flags & ElementFlag.number) json["number"] = element.number ?? 0;
    if (flags & (ElementFlag.typeName | ElementFlag.typeNameCode)) json["type_name"] = element.typeName;
    if (flags & ElementFlag.typeNameCode) json["type_name_code"] = element.typeNameCode ?? 0;
    if (flags & ElementFlag.meta) json["metadata"] = element.metadata ?? "";
    if (flags & ElementFlag.extended) json["extended"] = hexOf(element.extended ?? none);
  }
  if (element.elements) {
    json["elements"] = element.elements.map((nested) => jsonOfElement(nested, version));
    return json;
  }
  const data = element.data ?? none;
  let value: Json | undefined;
  if (element.type === ElementType.void) value = null;
  else if (element.type === ElementType.string) value = decodeStrictText(data);
  else value = jsonOfNumbers(element.type, data);
  if (value === undefined) json["value_hex"] = hexOf(data);
  else json["value"] = value;
  return json;
}

function optionalText(json: JsonObject, key: string): string | undefined {
  const found = part(json, key);
  return found === undefined ? undefined : text(found);
}

function optionalNumber(json: JsonObject, key: string): number | undefined {
  const found = part(json, key);
  return found === undefined ? undefined : number(found);
}

/** Leaves out what is not there, as optional properties are. */
function compact<T extends object>(given: { [K in keyof T]: T[K] | undefined }): T {
  return Object.fromEntries(Object.entries(given).filter(([, value]) => value !== undefined)) as T;
}

function idOf(json: JsonObject, key: string): Uint8Array | undefined {
  const found = optionalText(json, key);
  return found === undefined ? undefined : NodeId.parse(found).bytes;
}

function extendedOf(json: JsonObject): Uint8Array | undefined {
  const found = optionalText(json, "extended");
  return found === undefined ? undefined : bytesOf(found);
}

export function messageOfJson(json: Json | undefined): Message {
  const decoded = object(json);
  const header = object(decoded["header"]);
  const version = number(header["version"]) as 2 | 4;
  const strings = part(header, "string_table");
  return compact<Message>({
    version,
    flags: optionalNumber(header, "flags"),
    senderNode: idOf(header, "sender_node_id"),
    receiverNode: idOf(header, "receiver_node_id"),
    senderName: optionalText(header, "sender_node_name"),
    receiverName: optionalText(header, "receiver_node_name"),
    senderEndpoint: optionalNumber(header, "sender_endpoint"),
    receiverEndpoint: optionalNumber(header, "receiver_endpoint"),
    priority: optionalNumber(header, "priority"),
    metadata: optionalText(header, "metadata"),
    messageId: optionalNumber(header, "message_id"),
    messageResId: optionalNumber(header, "message_res_id"),
    strings: strings === undefined ? undefined : list(strings).map((one) => [number(list(one)[0]), text(list(one)[1])] as [number, string]),
    extended: extendedOf(header),
    entries: list(decoded["entries"]).map((entry) => entryOfJson(object(entry), version)),
  });
}

function entryOfJson(json: JsonObject, version: 2 | 4): MessageEntry {
  return compact<MessageEntry>({
    type: number(json["entry_type"]),
    path: optionalText(json, "service_path") ?? "",
    member: optionalText(json, "member") ?? "",
    requestId: optionalNumber(json, "request_id") ?? 0,
    error: optionalNumber(json, "error") ?? 0,
    metadata: optionalText(json, "metadata"),
    extended: extendedOf(json),
    flags: version === 4 ? optionalNumber(json, "flags") : undefined,
    pathCode: optionalNumber(json, "service_path_code"),
    memberCode: optionalNumber(json, "member_code"),
    elements: list(json["elements"]).map((element) => elementOfJson(element, version)),
  });
}

export function elementOfJson(json: Json | undefined, version: 2 | 4): MessageElement {
  const decoded = object(json);
  const type = number(decoded["type"]);
  return compact<MessageElement>({
    name: optionalText(decoded, "name"),
    number: optionalNumber(decoded, "number"),
    type,
    typeName: optionalText(decoded, "type_name") ?? "",
    metadata: optionalText(decoded, "metadata"),
    extended: extendedOf(decoded),
    count: optionalNumber(decoded, "count") ?? 0,
    flags: version === 4 ? optionalNumber(decoded, "flags") : undefined,
    nameCode: optionalNumber(decoded, "name_code"),
    typeNameCode: optionalNumber(decoded, "type_name_code"),
    elements: isNested(type) ? list(decoded["elements"]).map((nested) => elementOfJson(nested, version)) : undefined,
    data: isNested(type) ? undefined : payloadOf(decoded, type),
  });
}

function payloadOf(json: JsonObject, type: number): Uint8Array {
  const hex = part(json, "value_hex");
  if (hex !== undefined) return bytesOf(text(hex));
  if (type === ElementType.void) return none;
  if (type === ElementType.string) return encodeText(text(json["value"]));
  return numbersOfJson(type, json["value"]);
}
