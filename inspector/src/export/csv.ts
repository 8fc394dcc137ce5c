// SPDX-License-Identifier: Apache-2.0
import type { Column } from "./column.js";

/**
 * Columns as CSV (RFC 4180). Lines of the same times share a column of times; the others have one of their own before
 * them.
 */
export function csvOf(columns: readonly Column[]): string {
  const headers: string[] = [];
  const parts: ((row: number) => string)[] = [];
  let before: Float64Array | undefined;
  let rows = 0;
  for (const { name, times, values } of columns) {
    if (!before || !sameTimes(before, times)) {
      headers.push(columns.length === 1 || before === undefined ? "time" : `time of ${name}`);
      parts.push((row) => (row < times.length ? String(times[row]) : ""));
      before = times;
    }
    headers.push(name);
    parts.push((row) => (row < values.length ? String(values[row]) : ""));
    rows = Math.max(rows, times.length);
  }
  const lines = [headers.map(quoted).join(",")];
  for (let row = 0; row < rows; ++row) lines.push(parts.map((part) => part(row)).join(","));
  return `${lines.join("\r\n")}\r\n`;
}

function sameTimes(a: Float64Array, b: Float64Array): boolean {
  return a.length === b.length && a.every((time, i) => time === b[i]);
}

/** A text that a spreadsheet takes for a text: one that begins like a formula is not run. */
function quoted(text: string): string {
  const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\r\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
}
