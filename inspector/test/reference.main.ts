// SPDX-License-Identifier: Apache-2.0
// node reference.main.mjs PORT: the page in Chromium with the test server of the reference library, or that of RobotRaconteurWeb,
// which listens there.
// Properties of most types are read and set, functions called, wires watched, memories read.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { address, allowed, clickText, connect, enter, faults, shootBoth, startBoth, submit, text } from "./page_steps.js";

const port = process.argv[2] ?? process.env.ROBDEF_REFERENCE_PORT ?? "22222";
const both = startBoth();
const service = (name: string): string => `rr+ws://127.0.0.1:${port}/?service=${name}`;

describe("The reference library's test server", allowed, () => {
  it("lists its services", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, `127.0.0.1:${port}`);
      await page.until("document.querySelectorAll('.links button').length >= 4");
      assert.match(await text(page, "main"), /RobotRaconteurTestService\s+testroot/);
      await clickText(page, ".links button", "RobotRaconteurTestService2");
      await page.until("document.querySelector('.object')");
    }));

  it("has properties that are read and set", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, service("RobotRaconteurTestService"));
      await page.until("document.querySelectorAll('[role=treeitem]').length > 10");
      // The server gives always the same, and takes one value only.
      await page.until("document.querySelector('[data-member=d1] .current').innerText.trim() === '12.345'");
      await page.click("[aria-label='Edit d1']");
      await page.type("[data-member=d1] form input", "3.456");
      await page.key("Enter");
      await page.until("document.querySelector('[aria-live]').innerText === 'd1 is set'");
      await page.until("/(?:runtime_error|Exception) This is a test/.test(document.querySelector('[data-member=errtest] .problem')?.innerText)");
      // What was read of each type is taken by its form, and sent.
      const names = await page.evaluate<string[]>("[...document.querySelectorAll('.member.property')].filter((one) => one.querySelector('.current .value:not(.none)') && one.querySelector('[aria-label^=Edit]')).map((one) => one.dataset.member)");
      assert.ok(names.length > 45, `${names.length} properties`);
      const form = (name: string): string => `[data-member=${name}] form`;
      // Its test server ends when a map or struct is not the one that it wants.
      const plain = names.filter((one) => /^(?:d|s|i8_|u8_|i16_|u16_|i32_|u32_|i64_|u64_)\w*\d$|huge/.test(one) && one !== "d1");
      assert.ok(plain.length > 20, plain.join(", "));
      for (const name of plain) {
        await page.evaluate(`document.querySelector("[aria-label='Edit ${name}']").click()`);
        await page.until(`document.querySelector(${JSON.stringify(form(name))})`);
        await submit(page, form(name));
        await page.until(`document.querySelector('[aria-live]').innerText === '${name} is set' || document.querySelector('[data-member=${name}] > .problem, ${form(name)} .problem')`, `${name} is set, or refused`);
        assert.equal(await page.evaluate(`document.querySelectorAll('${form(name)} .problem').length`), 0, `the form of ${name} takes what was read`);
        await page.evaluate(`document.querySelector("[aria-label='Edit ${name}']").click()`);
      }
      await shootBoth(page, "reference");
      assert.deepEqual(await faults(page), []);
      assert.deepEqual(page.complaints, []);
    }));

  it("has functions, events and objects", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, service("RobotRaconteurTestService"));
      await page.click("[aria-label='Call func3 with…']");
      await enter(page, "func3", "d1", "2");
      await enter(page, "func3", "d2", "3.4");
      await page.key("Enter");
      await page.until("/^5.4/.test(document.querySelector('[data-member=func3] .result')?.innerText)");
      await page.click("[aria-label='Call meaning_of_life']");
      await page.until("document.querySelector('[data-member=meaning_of_life] .result')?.innerText === '42'");
      await page.click("[aria-label='Call func_errtest']");
      await page.until("document.querySelector('[data-member=func_errtest] .problem')");
      assert.match(await text(page, "[data-member=func_errtest] .problem"), /This is a test/);
      assert.deepEqual(page.complaints, []);
    }));

  it("has wires that are peeked, poked, watched and plotted", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, service("RobotRaconteurTestService2"));
      await page.click("[aria-label='Peek peekwire']");
      await page.until("document.querySelector('[data-member=peekwire] .current')?.innerText.trim() === '56295674'");
      await page.click("[aria-label='Poke pokewire…']");
      await enter(page, "pokewire", "pokewire", "75738265");
      await page.key("Enter");
      await page.until("/pokewire is sent/.test(document.querySelector('[aria-live]').innerText)");
      await page.click("[aria-label='Plot peekwire']");
      await page.until("/^56295674/.test(document.querySelector('.legend .number')?.innerText)");
      assert.deepEqual(page.complaints, []);
    }));

  it("has memories", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, service("RobotRaconteurTestService"));
      await page.click("[aria-label='Read m1']");
      await page.until("/items/.test(document.querySelector('[data-member=m1]').innerText)");
      await page.click("[aria-label='Read m2']");
      await page.until("/\\d+ × \\d+.* items/.test(document.querySelector('[data-member=m2]').innerText)");
      await page.until("/:/.test(document.querySelector('[data-member=m2] > :last-child').innerText) || document.querySelector('[data-member=m2] table')");
      assert.deepEqual(page.complaints, []);
    }));

  it("knows users", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, service("RobotRaconteurTestService_auth"));
      await page.type(".failure [name=user]", "testuser1");
      await page.type(".failure [name=password]", "testpass1");
      await page.key("Enter");
      await page.until("/as testuser1/.test(document.querySelector('.device-head')?.innerText)");
      await clickText(page, ".locks button", "Lock for testuser1");
      await page.until("/locked by this user/.test(document.querySelector('.locks').innerText)");
      await clickText(page, ".locks button", "Unlock");
      await page.until("!/locked/.test(document.querySelector('nav').innerText)");
      assert.deepEqual(page.complaints, []);
    }));
});
