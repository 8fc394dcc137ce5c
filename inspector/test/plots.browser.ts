// SPDX-License-Identifier: Apache-2.0
// Plots, pictures and 3-D in Chromium.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { address, allowed, catchFiles, clickText, connect, faultsInBoth, savedFiles, shootBoth, standard, startBoth, text } from "./page_steps.js";

const both = startBoth();

/** A browser says how it draws without a graphics card. */
const aboutDrawing = /GL Driver Message|GPU stall/;

describe("Plots, pictures and scenes", allowed, () => {
  it("show wires with cursors, pause and files", () =>
    both.browser.with(address, { width: 1500 }, async (page) => {
      await connect(page, both.workshop.url("bench"));
      await page.click("[aria-label='Plot position']");
      await page.click("[aria-label='Plot where']");
      await page.click("[aria-label='Plot speed']");
      await page.until("document.querySelectorAll('.legend li').length === 5");
      // Two seconds of the device's time.
      await clickText(page, ".panel button", "Cursors");
      await page.until("/s apart/.test(document.querySelector('.cursors')?.innerText)");
      assert.deepEqual(await faultsInBoth(page), []);
      await page.until("document.querySelectorAll('.uplot canvas').length > 0");
      // Axes for metres and for metres a second.
      const enough = "[...document.querySelectorAll('.legend.with-cursors li')].every((one) => one.querySelectorAll('.number').length === 3)";
      await page.until(enough);
      await clickText(page, ".panel button", "Pause");
      await page.until("[...document.querySelectorAll('.panel button')].some((one) => one.innerText === 'Go on')");
      await catchFiles(page);
      // What is saved is what is shown, which grows until there are enough rows.
      let rows: string[] = [];
      for (let tries = 1; rows.length <= 100; ++tries) {
        await clickText(page, ".panel button", "Go on");
        await clickText(page, ".panel button", "Pause");
        await clickText(page, ".panel button", "CSV");
        rows = Buffer.from((await savedFiles(page, tries)).at(-1) ?? []).toString().split("\r\n");
      }
      assert.match(rows[0] ?? "", /^time,position,time of where\.x,where\.x/);
      assert.match(rows[1] ?? "", /^\d+\.?\d*,-?\d/);
      await catchFiles(page);
      await clickText(page, ".panel button", ".mat");
      const [mat] = await savedFiles(page, 1);
      assert.equal(Buffer.from(mat ?? []).toString("latin1", 0, 10), "MATLAB 5.0");
      assert.ok((await text(page, ".legend")).length > 0);
      // Arrows move a cursor. On a slow machine the cursors of before have left the window.
      await clickText(page, ".panel button", "Cursors");
      const apart = async (): Promise<number> => Number(/([\d.]+) s apart/.exec(await text(page, ".cursors"))?.[1]);
      const before = await apart();
      await page.evaluate("document.querySelector('.plot .canvas').focus()");
      await page.key("ArrowRight");
      await page.until(`Number(/([\\d.]+) s apart/.exec(document.querySelector('.cursors').innerText)[1]) > ${before}`);
      assert.ok(Math.abs((await apart()) - before - 0.05) < 1e-3, `${before} to ${await apart()}`);
      await clickText(page, ".panel button", "Go on");
      await clickText(page, ".panel button", "Cursors");
      await shootBoth(page, "plot");
      assert.deepEqual(page.complaints, []);
    }));

  it("take long rows of samples from a pipe", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, both.workshop.url("bench"));
      await page.click("[aria-label='Plot waves']");
      await page.until("document.querySelectorAll('.legend li').length === 1");
      await page.until("/-?\\d/.test(document.querySelector('.legend .number').innerText)");
      assert.deepEqual(page.complaints, []);
    }));

  it("of a camera and of poses are drawn; a lamp that is set by its form is seen", { skip: standard === undefined ? "no standard definitions" : false, ...allowed }, () =>
    both.browser.with(address, { width: 1500, height: 1000 }, async (page) => {
      await connect(page, both.workshop.url("cell"));
      await page.click("[aria-label='Show camera as a picture']");
      await page.until("document.querySelector('[data-kind=picture] canvas')?.width === 640");
      // Red is the light of the lamp.
      const red = "(() => { const c = document.querySelector('[data-kind=picture] canvas'); return c.getContext('2d').getImageData(10, 10, 1, 1).data[0]; })()";
      await page.until(`Math.abs(${red} - 127) < 3`);
      await page.click("[aria-label='Edit lamp']");
      await page.type("[data-member=lamp] form input", "1");
      await page.key("Enter");
      await page.until(`${red} === 255`);
      assert.equal(both.workshop.state.lamp, 1);
      await page.click("[aria-label='Show tcp in 3-D']");
      await page.until("/tcp: at/.test(document.querySelector('[data-kind=scene] .poses')?.innerText)");
      await page.click("[aria-label='Show frames in 3-D']");
      await page.until("document.querySelectorAll('[data-kind=scene] canvas').length === 2");
      await page.until("document.querySelectorAll('[data-kind=scene] .poses').length === 2");
      await shootBoth(page, "camera");
      // Arrows turn what is seen.
      await page.evaluate("document.querySelectorAll('[data-kind=scene] .scene')[1].scrollIntoView()");
      const seen = await page.pictureOf("[data-kind=scene]:last-of-type .scene");
      await page.evaluate("document.querySelectorAll('[data-kind=scene] .scene')[1].focus()");
      await page.key("ArrowLeft");
      await page.waitFor(async () => (await page.pictureOf("[data-kind=scene]:last-of-type .scene")) !== seen, () => "another look at the scene");
      assert.deepEqual(await faultsInBoth(page), []);
      assert.deepEqual(page.complaints.filter((one) => !aboutDrawing.test(one)), []);
    }));
});
