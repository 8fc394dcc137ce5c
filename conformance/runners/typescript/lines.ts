// SPDX-License-Identifier: Apache-2.0
// Lines of JSON in, lines of JSON out.
import { createInterface } from "node:readline";
import type { Json, JsonObject } from "../../../runtime/typescript/test/notation/json.js";

/** JSON that keeps the sign of a negative zero, which JSON.stringify loses. */
export function lineOf(json: Json): string {
  if (typeof json === "number") return Object.is(json, -0) ? "-0.0" : JSON.stringify(json);
  if (Array.isArray(json)) return `[${json.map(lineOf).join(",")}]`;
  if (json === null || typeof json !== "object") return JSON.stringify(json);
  return `{${Object.entries(json)
    .map(([key, value]) => `${JSON.stringify(key)}:${lineOf(value)}`)
    .join(",")}}`;
}

/** Answers each line of the standard input, one after the other, until it ends. */
export async function answerLines(answer: (request: JsonObject) => Json | Promise<Json>): Promise<void> {
  for await (const line of createInterface({ input: process.stdin, crlfDelay: Infinity })) {
    if (line.trim() === "") continue;
    let result: Json;
    try {
      result = await answer(JSON.parse(line) as JsonObject);
    } catch (error) {
      result = { error: error instanceof Error ? `${error.name}: ${error.message}` : String(error) };
    }
    process.stdout.write(`${lineOf(result)}\n`);
  }
}
