// SPDX-License-Identifier: Apache-2.0
import { ErrorCode, makeError, type RRError } from "../errors.js";

/** A text that is no service definition, with the place. */
export function definitionError(line: number, message: string): RRError {
  return makeError(ErrorCode.ServiceDefinitionError, `line ${line}: ${message}`);
}
