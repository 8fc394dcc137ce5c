// SPDX-License-Identifier: Apache-2.0
import type { MessageEntry } from "../codec/message.js";
import { ErrorCode, makeError } from "../errors.js";
import { optionalElement } from "../value/shapes.js";
import { textOf } from "../value/unpack.js";

/** The numbers of `clientversion`; undefined for the newest. Throws ServiceDefinitionError. */
export function clientVersionOf(entry: MessageEntry): number[] | undefined {
  const element = optionalElement(entry.elements, "clientversion");
  if (!element) return undefined;
  const text = textOf(element);
  if (!/^\d{1,9}(?:\.\d{1,9}){1,3}$/.test(text)) throw makeError(ErrorCode.ServiceDefinitionError, "clientversion is no version");
  return text.split(".").map(Number);
}
