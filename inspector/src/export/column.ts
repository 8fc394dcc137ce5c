// SPDX-License-Identifier: Apache-2.0

/** One line of a plot, as it is exported. Times in seconds since 1970. */
export interface Column {
  readonly name: string;
  readonly times: Float64Array;
  readonly values: Float64Array;
}
