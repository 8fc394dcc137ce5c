// SPDX-License-Identifier: Apache-2.0
// The tests of the codec that Node runs, in Chromium: all recorded messages and values, byte for byte, and properties of
// random ones. ROBDEF_CAPTURES_DIR: conformance/captures.
import assert from "node:assert/strict";
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { describe, it } from "node:test";
import { fileURLToPath } from "node:url";
import { allowed, startBoth } from "./page_steps.js";

const captures = process.env.ROBDEF_CAPTURES_DIR;
const both = startBoth();
const wanted = ["captures", "codec", "values"];
/** Tests in the three files: fewer would mean that some were not found. */
const leastTests = 12;

describe("The codec in Chromium", allowed, () => {
  it("holds what it holds in Node", { skip: captures === undefined ? "ROBDEF_CAPTURES_DIR is not set" : false, ...allowed }, async (t) => {
    const folder = captures ?? "";
    const files = ["values-v2.json", "values-v4.json", "blobs.json"];
    for (const name of ["scenarios", "robdef"]) files.push(...readdirSync(join(folder, name)).map((file) => `${name}/${file}`));
    let count = 0;
    for (const name of wanted) {
      await both.browser.with("about:blank", {}, async (page) => {
        const script = readFileSync(fileURLToPath(new URL(`in_page/${name}.js`, import.meta.url)), "utf8");
        // The tests read them when they are loaded.
        await page.evaluate("globalThis.pageFiles = new Map(); undefined");
        for (const file of files) await page.evaluate(`pageFiles.set(${JSON.stringify(`captures/${file}`)}, ${JSON.stringify(readFileSync(join(folder, file), "utf8"))}); undefined`);
        await page.evaluate(`${script}; undefined`);
        const names = await page.evaluate<string[]>("namesOfPageTests()");
        for (const [index, one] of names.entries()) {
          await t.test(one, async () => {
            assert.equal(await page.evaluate<string>(`runPageTest(${index})`), "");
          });
          ++count;
        }
        assert.deepEqual(page.complaints, []);
      });
    }
    assert.ok(count >= leastTests, `only ${count} tests`);
  });
});
