// SPDX-License-Identifier: Apache-2.0
// What the tests of the runtime use of `node:assert/strict`, in a page.
function textOf(value: unknown): string {
  const text = JSON.stringify(value, (_, one: unknown) => (typeof one === "bigint" ? `${one}n` : Object.is(one, -0) ? "-0" : ArrayBuffer.isView(one) ? [...new Uint8Array(one.buffer, one.byteOffset, one.byteLength)] : one)) as string | undefined;
  return (text ?? String(value)).slice(0, 1000);
}

function fail(what: string, message: string | undefined): never {
  throw new Error(`${message === undefined ? "" : `${message}: `}${what}`);
}

function same(a: unknown, b: unknown): boolean {
  if (Object.is(a, b)) return true;
  if (typeof a !== "object" || typeof b !== "object" || a === null || b === null) return false;
  if (Object.getPrototypeOf(a) !== Object.getPrototypeOf(b)) return false;
  if (a instanceof Map) return b instanceof Map && a.size === b.size && [...a].every(([key, value]) => b.has(key) && same(value, b.get(key)));
  if (a instanceof DataView) throw new Error("views of data are not compared");
  const keys = Object.keys(a);
  return keys.length === Object.keys(b).length && keys.every((key) => Object.hasOwn(b, key) && same((a as Record<string, unknown>)[key], (b as Record<string, unknown>)[key]));
}

function ok(value: unknown, message?: string): void {
  if (!value) fail("not true", message);
}

export default {
  ok,
  equal(a: unknown, b: unknown, message?: string): void {
    if (!Object.is(a, b)) fail(`${textOf(a)} is not ${textOf(b)}`, message);
  },
  notEqual(a: unknown, b: unknown, message?: string): void {
    if (Object.is(a, b)) fail(`both are ${textOf(a)}`, message);
  },
  deepEqual(a: unknown, b: unknown, message?: string): void {
    if (!same(a, b)) fail(`${textOf(a)} is not ${textOf(b)}`, message);
  },
  throws(run: () => unknown, expected?: unknown, message?: string): void {
    try {
      run();
    } catch (error) {
      if (typeof expected === "function" && !(error instanceof (expected as new () => Error))) fail(`threw ${String(error)}`, message);
      if (expected instanceof RegExp && !expected.test(String(error))) fail(`threw ${String(error)}`, message);
      return;
    }
    fail("threw nothing", message);
  },
};
