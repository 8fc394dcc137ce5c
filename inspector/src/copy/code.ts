// SPDX-License-Identifier: Apache-2.0
// The code that does what was done, in the languages that Robdef has.
import type { Operation } from "../model/history.js";
import { cppCode } from "./cpp.js";
import { csharpCode } from "./csharp.js";
import { matlabCode } from "./matlab.js";
import { shellCode } from "./shell.js";
import { typescriptCode } from "./typescript.js";

export type Language = "shell" | "typescript" | "cpp" | "csharp" | "matlab";

export const languages: readonly (readonly [Language, string])[] = [
  ["shell", "command line"],
  ["typescript", "TypeScript"],
  ["cpp", "C++"],
  ["csharp", "C#"],
  ["matlab", "MATLAB"],
];

const writers: Readonly<Record<Language, (operation: Operation) => string>> = {
  shell: shellCode,
  typescript: typescriptCode,
  cpp: cppCode,
  csharp: csharpCode,
  matlab: matlabCode,
};

/** Whole lines that connect, find the object and do it. */
export function codeOf(language: Language, operation: Operation): string {
  return writers[language](operation);
}
