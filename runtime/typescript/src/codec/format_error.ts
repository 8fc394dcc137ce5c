// SPDX-License-Identifier: Apache-2.0

/** Bytes that are no message: the connection they came by is closed. */
export class FormatError extends Error {
  constructor(message: string) {
    super(message);
    this.name = "FormatError";
  }
}
