// SPDX-License-Identifier: Apache-2.0
// Checks that values of both directions share.
import type { MessageElement } from "../codec/message.js";
import { product, type ArrayForm } from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";

/** Throws DataTypeError for a count that a row of this form cannot have. */
export function checkCount(array: ArrayForm, count: number, what: string): void {
  if (array.kind !== "array" || array.length === undefined) return;
  if (array.isMaximum ? count > array.length : count !== array.length) {
    throw makeError(
      ErrorCode.DataTypeError,
      `${what} has ${count} items instead of ${array.isMaximum ? "at most " : ""}${array.length}`,
    );
  }
}

/** Throws DataTypeError for dimensions that are not those of this form, or do not have so many items. */
export function checkDims(array: ArrayForm, dims: readonly number[], count: number, what: string): void {
  if (array.kind === "dims" && array.dims) {
    const wanted = array.dims;
    if (dims.length !== wanted.length || dims.some((dim, i) => dim !== wanted[i])) {
      throw makeError(ErrorCode.DataTypeError, `${what} is ${dims.join(" x ")} instead of ${wanted.join(" x ")}`);
    }
  }
  // No dimensions at all are sent for an empty array.
  if ((dims.length === 0 ? 0 : product(dims)) !== count) {
    throw makeError(ErrorCode.DataTypeError, `${what} has ${count} items, which are not ${dims.join(" x ")}`);
  }
}

/** The first element of this name. Throws MessageElementNotFound. */
export function findElement(elements: readonly MessageElement[] | undefined, name: string): MessageElement {
  const found = optionalElement(elements, name);
  if (!found) throw makeError(ErrorCode.MessageElementNotFound, `there is no element ${name}`);
  return found;
}

export function optionalElement(elements: readonly MessageElement[] | undefined, name: string): MessageElement | undefined {
  return elements?.find((element) => element.name === name);
}

/** Throws DataTypeMismatch for an element of another type. */
export function checkType(element: MessageElement, type: number, what: string): void {
  if (element.type === type) return;
  if (element.type === 0) throw makeError(ErrorCode.NullValue, `${what} is null`);
  throw makeError(ErrorCode.DataTypeMismatch, `${what} has element type ${element.type} instead of ${type}`);
}

const decimal = /^[+-]?\d{1,10}$/;

/** The number of an element, or its name read as one; undefined when it is none. */
export function elementNumber(element: MessageElement): number | undefined {
  if (element.name === undefined) return element.number;
  if (!decimal.test(element.name)) return undefined;
  const value = Number(element.name);
  return value === (value | 0) ? value : undefined;
}
