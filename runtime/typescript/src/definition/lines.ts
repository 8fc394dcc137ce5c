// SPDX-License-Identifier: Apache-2.0
// Cuts the text of a definition into logical lines (06, section 2).
import { definitionError } from "./definition_error.js";

/** One statement with the documentation that is before it. */
export interface Line {
  readonly text: string;
  /** Of its first physical line, from 1. */
  readonly number: number;
  readonly doc: string;
}

/**
 * Logical lines of a text, without comments. `##` lines are the documentation of the statement after them;
 * a comment, or a blank line with further documentation after it, discards what was collected.
 */
export function logicalLines(text: string): Line[] {
  const lines: Line[] = [];
  const physical = text.split("\n");
  let doc: string[] = [];
  let isDocOver = false;
  for (let i = 0; i < physical.length; ++i) {
    const number = i + 1;
    let line = clean(physical[i] ?? "", number);
    const start = line.trimStart();
    if (start === "") {
      isDocOver = true;
      continue;
    }
    if (start.startsWith("#")) {
      if (!start.startsWith("##")) doc = [];
      else {
        if (isDocOver) doc = [];
        doc.push(start.slice(2).trim());
      }
      isDocOver = false;
      continue;
    }
    const parts: string[] = [];
    while (line.endsWith("\\")) {
      if (i + 1 >= physical.length) throw definitionError(number, "the last line ends in a backslash");
      parts.push(line.slice(0, -1));
      line = clean(physical[++i] ?? "", i + 1);
    }
    parts.push(line);
    const whole = parts.join(" ").trim();
    if (whole !== "") lines.push({ text: whole, number, doc: doc.join("\n") });
    doc = [];
    isDocOver = false;
  }
  return lines;
}

/** Without carriage returns at its end; refuses characters that no definition has. */
function clean(line: string, number: number): string {
  let end = line.length;
  while (end > 0 && line.charCodeAt(end - 1) === 13) --end;
  for (let i = 0; i < end; ++i) {
    const code = line.charCodeAt(i);
    if ((code < 0x20 && code !== 9) || code > 0x7e) {
      throw definitionError(number, "a character is not printable ASCII");
    }
  }
  return line.slice(0, end);
}
