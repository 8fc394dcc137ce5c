// SPDX-License-Identifier: Apache-2.0
// Errors from and to elements (07, section 14).
import { ElementType } from "./codec/element_type.js";
import type { MessageElement } from "./codec/message.js";
import { decodeText } from "./codec/text.js";
import { Definitions } from "./definition/definitions.js";
import { ErrorCode, errorName, makeError, RRError, type ErrorClass } from "./errors.js";
import { anyType } from "./definition/types.js";
import { Packer, textElement } from "./value/pack.js";
import { optionalElement } from "./value/shapes.js";
import { Unpacker } from "./value/unpack.js";

const plain = new Definitions();

function textIn(elements: readonly MessageElement[], name: string): string {
  const element = optionalElement(elements, name);
  return element?.type === ElementType.string && element.data ? decodeText(element.data) : "";
}

/** The error that an answer carries; exceptions of definitions are of the class that is known for their name. */
export function errorOf(code: number, elements: readonly MessageElement[], classes?: ReadonlyMap<string, ErrorClass>): RRError {
  // Services spell some names otherwise; the code decides (07, section 4).
  const name = errorName(code) || textIn(elements, "errorname");
  const parameter = optionalElement(elements, "errorparam");
  const details = { errorName: name, subname: textIn(elements, "errorsubname"), parameter: parameter ? parameterOf(parameter) : null };
  const message = textIn(elements, "errorstring");
  const known = code === ErrorCode.RemoteError ? classes?.get(name) : undefined;
  return known ? new known(message, details) : makeError(code, message, details);
}

function parameterOf(element: MessageElement): unknown {
  try {
    return new Unpacker(plain).any(element);
  } catch {
    return null;
  }
}

/** An error as it is to be sent: what is no RRError has a stable name. */
export function sentError(error: unknown): RRError {
  if (error instanceof RRError) return error;
  const message = error instanceof Error ? error.message : String(error);
  return new RRError(ErrorCode.RemoteError, message, { errorName: "RobotRaconteur.RemoteError" });
}

/** The elements of an answer with an error. */
export function errorElements(error: RRError): MessageElement[] {
  const elements = [textElement("errorname", error.errorName), textElement("errorstring", error.message)];
  if (error.subname !== "") elements.push(textElement("errorsubname", error.subname));
  if (error.parameter !== null && error.parameter !== undefined) {
    try {
      elements.push(new Packer(plain).value(anyType, error.parameter, "errorparam"));
    } catch {
      // One that cannot be packed is left out.
    }
  }
  return elements;
}
