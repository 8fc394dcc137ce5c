// SPDX-License-Identifier: Apache-2.0

/** What JSON holds. */
export type Json = null | boolean | number | string | Json[] | JsonObject;
export interface JsonObject {
  [key: string]: Json;
}

/** The part of an object, or undefined when it has none. */
export function part(json: Json | undefined, key: string): Json | undefined {
  if (json === null || json === undefined || typeof json !== "object" || Array.isArray(json)) return undefined;
  return Object.hasOwn(json, key) ? json[key] : undefined;
}

/** The part as an object; throws when it is none. */
export function object(json: Json | undefined): JsonObject {
  if (json === null || json === undefined || typeof json !== "object" || Array.isArray(json)) {
    throw new Error(`no object: ${(JSON.stringify(json) as string | undefined)?.slice(0, 60) ?? "nothing"}`);
  }
  return json;
}

export function list(json: Json | undefined): Json[] {
  if (!Array.isArray(json)) throw new Error(`no list: ${(JSON.stringify(json) as string | undefined)?.slice(0, 60) ?? "nothing"}`);
  return json;
}

export function text(json: Json | undefined): string {
  if (typeof json !== "string") throw new Error(`no text: ${(JSON.stringify(json) as string | undefined)?.slice(0, 60) ?? "nothing"}`);
  return json;
}

export function number(json: Json | undefined): number {
  if (typeof json !== "number") throw new Error(`no number: ${(JSON.stringify(json) as string | undefined)?.slice(0, 60) ?? "nothing"}`);
  return json;
}
