// SPDX-License-Identifier: Apache-2.0
// The code that does what was done.
import type { Operation } from "./history.js";
import { placeText } from "./history.js";
import { jsonText } from "./value_text.js";

export type Language = "typescript" | "cpp" | "csharp" | "matlab" | "shell";

export const languages: readonly (readonly [Language, string])[] = [["shell", "command line"]];

export function codeOf(_language: Language, operation: Operation): string {
  return `robdef ${operation.kind} '${operation.url}' ${placeText(operation.steps, operation.member?.name)} ${operation.args.map(({ type, value }) => (operation.definitions ? jsonText(operation.definitions, type, value) : "")).join(" ")}`;
}
