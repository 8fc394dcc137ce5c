// SPDX-License-Identifier: Apache-2.0
// The page that nodes in C++ serve, in Chromium: the smart room and the dual arm.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { allowed, clickText, connect, end, faultsInBoth, missing, pageOf, serve, shootBoth, startBoth, submit } from "./page_steps.js";

const both = startBoth();

/** Sums of red, green and blue of the picture. */
const sums = "(() => { const c = document.querySelector('[data-kind=picture] canvas'); const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let s = [0, 0, 0]; for (let i = 0; i < d.length; i += 4) for (let k = 0; k < 3; ++k) s[k] += d[i + k]; return s; })()";

describe("Services in C++", allowed, () => {
  it("the smart room: a lamp that is set by its form is seen in the camera's picture", { skip: missing("smart_room_service"), ...allowed }, async () => {
    const { url, program } = await serve("smart_room_service", ["--port", "0"]);
    try {
      // From the node itself: a page of its own origin.
      await both.browser.with(pageOf(url), { width: 1500, height: 1000 }, async (page) => {
        await page.click(".links button");
        await page.until("document.querySelectorAll('[role=treeitem]').length > 3");
        await clickText(page, ".tree .title", "robcamera[0]");
        await page.click("[aria-label='Show GetCurrentStreamFrameCameraBitmap as a picture, again and again']");
        await page.until("document.querySelector('[data-kind=picture] canvas')?.width === 320");
        // The lamps are white at first: there is as good as as much red as blue.
        await page.until(`(() => { const [r, g, b] = ${sums}; return b > 1e6 && Math.abs(r - b) < 0.1 * b; })()`);
        const [red = 0] = await page.evaluate<number[]>(sums);
        await clickText(page, ".tree .title", "robdevice[0]");
        await page.click("[aria-label='Call SetProperty with…']");
        await page.type("[data-member=SetProperty] form textarea", "SetRGBRange");
        await page.type("[data-member=SetProperty] form textarea.numbers", "1, 6, 1, 0, 0");
        await submit(page, "[data-member=SetProperty] form");
        await page.until("document.querySelector('[data-member=SetProperty] .result')?.innerText === '0'");
        // Nothing but red, and more of it than before.
        await page.until(`(() => { const [r, g, b] = ${sums}; return g === 0 && b === 0 && r > ${1.3 * red}; })()`, "a red picture");
        // What the service refuses is said in its words.
        await page.type("[data-member=SetProperty] form textarea.numbers", "1, 99, 1, 0, 0");
        await submit(page, "[data-member=SetProperty] form");
        await page.until("/InvalidArgument[\\s\\S]*lamps are counted from 1/.test(document.querySelector('[data-member=SetProperty] .problem')?.innerText)");
        await page.type("[data-member=SetProperty] form textarea.numbers", "1, 3, 1, 0.6, 0.2");
        await submit(page, "[data-member=SetProperty] form");
        await page.until(`${sums}[1] > 1e6`);
        await shootBoth(page, "smart_room");
        assert.deepEqual(await faultsInBoth(page), []);
        assert.deepEqual(page.complaints, []);
      });
    } finally {
      await end(program);
    }
  });

  it("the dual arm: its state is plotted, its signals are read", { skip: missing("dual_arm"), ...allowed }, async () => {
    const { url, program } = await serve("dual_arm", ["--serve", "0"]);
    try {
      await both.browser.with(pageOf(url), { width: 1500, height: 1000 }, async (page) => {
        await connect(page, url);
        await page.click("[aria-label='Plot state']");
        await page.until("document.querySelectorAll('.legend li').length > 20");
        await page.until("/^-?\\d/.test(document.querySelector('.legend .number').innerText)");
        await page.click("[aria-label='Call signal_names']");
        await page.until("/orders.mode/.test(document.querySelector('[data-member=signal_names] .result')?.innerText)");
        await page.click("[aria-label='Call change_mode with…']");
        await page.type("[data-member=change_mode] form input", "300");
        await page.key("Enter");
        await page.until("/0 to 255/.test(document.querySelector('[data-member=change_mode] .problem')?.innerText)");
        await page.type("[data-member=change_mode] form input", "2");
        await page.key("Enter");
        await page.until("/done/.test(document.querySelector('[data-member=change_mode] .result')?.innerText)");
        await page.click("[aria-label='Poke gamepad…']");
        await page.type("[data-member=gamepad] form textarea", "1, 0.5, -1, 0.3");
        await submit(page, "[data-member=gamepad] form");
        await page.until("/gamepad is sent/.test(document.querySelector('[aria-live]').innerText)");
        await shootBoth(page, "dual_arm");
        assert.deepEqual(await faultsInBoth(page), []);
        assert.deepEqual(page.complaints, []);
      });
    } finally {
      await end(program);
    }
  });
});
