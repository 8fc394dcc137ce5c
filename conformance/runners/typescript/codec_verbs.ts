// SPDX-License-Identifier: Apache-2.0
// `decode` and `encode`: messages, elements and values from and to bytes.
import { join } from "../../../runtime/typescript/src/codec/byte_writer.js";
import type { MessageElement } from "../../../runtime/typescript/src/codec/message.js";
import { readElement, readMessage } from "../../../runtime/typescript/src/codec/read_message.js";
import { writeElement, writeMessage } from "../../../runtime/typescript/src/codec/write_message.js";
import { RRError, type Definitions } from "../../../runtime/typescript/src/index.node.js";
import type { ValueType } from "../../../runtime/typescript/src/definition/types.js";
import { Packer } from "../../../runtime/typescript/src/value/pack.js";
import { Unpacker } from "../../../runtime/typescript/src/value/unpack.js";
import { elementOfJson, jsonOfElement, jsonOfMessage, messageOfJson } from "../../../runtime/typescript/test/notation/decoded.js";
import { bytesOf, hexOf } from "../../../runtime/typescript/test/notation/hex.js";
import { number, part, text, type Json, type JsonObject } from "../../../runtime/typescript/test/notation/json.js";
import { jsonOfValue, valueOfJson } from "../../../runtime/typescript/test/notation/values.js";

const options = { keepUnknownCodes: true };

function versionOf(request: JsonObject): 2 | 4 {
  return number(request["message_version"]) === 2 ? 2 : 4;
}

/** A definition spells no type for the null of a varvalue, the captures do. */
function typeOf(definitions: Definitions, request: JsonObject): ValueType {
  const type = text(request["type"]);
  return definitions.type(type === "void" ? "varvalue" : type);
}

export function decode(definitions: Definitions, request: JsonObject): Json {
  const bytes = bytesOf(text(request["hex"]));
  if (request["do"] === "message") return { decoded: jsonOfMessage(readMessage(bytes, options)) };
  const version = versionOf(request);
  const element = readElement(bytes, version, options);
  const type = typeOf(definitions, request);
  const value = new Unpacker(definitions).value(type, element);
  return { decoded: jsonOfElement(element, version), value: jsonOfValue(definitions, type, value) };
}

export function encode(definitions: Definitions, request: JsonObject): Json {
  if (request["do"] === "message") return { hex: hexOf(writeMessage(messageOfJson(request["decoded"]))) };
  const version = versionOf(request);
  if (request["do"] === "element") return { hex: hexOf(writeElement(elementOfJson(request["decoded"], version), version)) };
  try {
    return { hex: hexOf(join(writeElement(pack(definitions, request), version))) };
  } catch (error) {
    if (error instanceof RRError) return { refused: error.message };
    throw error;
  }
}

function pack(definitions: Definitions, request: JsonObject): MessageElement {
  const numbered = part(request, "element_number");
  const key = typeof numbered === "number" ? numbered : text(part(request, "element_name") ?? "");
  const type = typeOf(definitions, request);
  const element = new Packer(definitions).value(type, valueOfJson(definitions, type, request["value"] ?? null), key);
  // Metadata and extended fields are not part of a value: they are put into its element.
  const metadata = part(request, "metadata");
  const extended = part(request, "extended");
  if (metadata !== undefined) element.metadata = text(metadata);
  if (extended !== undefined) element.extended = bytesOf(text(extended));
  return element;
}
