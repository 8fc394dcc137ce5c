// SPDX-License-Identifier: Apache-2.0
// Recordings in Chromium: opened, scrubbed through, plotted, and made by the page.
import assert from "node:assert/strict";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { describe, it } from "node:test";
import { RRNode, type StreamOpener } from "@robdef/runtime/node";
import { Recorder } from "../src/tape/recorder.js";
import { Tape } from "../src/tape/tape.js";
import { address, allowed, catchFiles, connect, faults, faultsInBoth, pause, savedFiles, shootBoth, startBoth, text } from "./page_steps.js";
import { openNodeWebSocket } from "./web_socket.js";

const both = startBoth();

/** A recording of a workshop, as the page makes it. */
async function recordedTape(): Promise<Uint8Array> {
  const recorder = new Recorder();
  const open: StreamOpener = recorder.around(openNodeWebSocket);
  const node = new RRNode({ openers: { "rr+ws": open } });
  recorder.start([]);
  const client = await node.connect(both.workshop.url("bench"));
  const wire = await client.root.wire("position").connect();
  const where = await client.root.wire("where").connect();
  for (const speed of [0.1, 0.2, 0.3]) {
    await client.root.set("speed", speed);
    await pause(400);
  }
  await where.close();
  await wire.close();
  recorder.define(client.definitions.values());
  await node.close();
  return recorder.stop() ?? new Uint8Array(0);
}

describe("A recording", allowed, () => {
  it("is opened, scrubbed through and plotted", async () => {
    const folder = mkdtempSync(join(tmpdir(), "inspector-tape-"));
    const file = join(folder, "belt.rrtape");
    writeFileSync(file, await recordedTape());
    await both.browser.with(address, {}, async (page) => {
      await page.choose("#tape-file", file);
      await page.until("document.querySelector('.tape h2')?.innerText === 'belt.rrtape'");
      const scrub = (part: number): Promise<unknown> => page.evaluate(`(() => { const r = document.querySelector('.scrubber input'); r.value = ${part} * r.max; r.dispatchEvent(new Event('input', { bubbles: true })); })()`);
      const speed = "document.querySelector('.tracks [data-member=speed] .value').innerText";
      // The values are set one after the other; when, depends on the machine.
      await scrub(0);
      await page.until(`${speed} === '—'`);
      for (const value of ["0.1", "0.2", "0.3"]) {
        await page.click("[aria-label='Next value of speed']");
        await page.until(`${speed} === '${value}'`);
      }
      await page.click("[aria-label='Value of speed before']");
      await page.until(`${speed} === '0.2'`);
      const second = Number(await page.evaluate<string>("document.querySelector('.scrubber input').value"));
      await scrub(0);
      await page.until(`${speed} === '—'`);
      await scrub(1);
      await page.until(`${speed} === '0.3'`);
      const whole = Number(await page.evaluate<string>("document.querySelector('.scrubber input').max"));
      assert.ok(second > 0 && second < whole, `${second} of ${whole}`);
      await page.click(".tracks [aria-label='Plot position']");
      await page.click(".tracks [aria-label='Plot where']");
      await page.until("document.querySelectorAll('.legend li').length === 4");
      await scrub(0.5);
      await page.until("/^-?\\d/.test(document.querySelector('.legend .number').innerText)");
      const shown = Number((await text(page, ".legend .number")).split(" ")[0]);
      assert.ok(shown >= -1 && shown <= 1, String(shown));
      await page.evaluate("document.querySelector('main').scrollTop = 0");
      await shootBoth(page, "tape");
      assert.deepEqual(await faultsInBoth(page), []);
      await page.click(".scrubber button");
      await page.until("Number(document.querySelector('.scrubber input').value) > 0.7 * document.querySelector('.scrubber input').max");
      writeFileSync(file, "no recording");
      await page.choose("#tape-file", file);
      await page.until("/This file is no recording/.test(document.querySelector('.notice')?.innerText)");
      assert.deepEqual(page.complaints, []);
    }).finally(() => {
      rmSync(folder, { recursive: true });
    });
  });

  it("is made by the page itself", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, both.workshop.url("bench"));
      await page.until("document.querySelector('[data-member=speed] .value')");
      await catchFiles(page);
      await page.evaluate("document.querySelector('.tools button').click()");
      await page.until("/Save/.test(document.querySelector('.tools button').innerText)");
      await page.click("[aria-label='Get speed']");
      await page.until("/get\\s+speed/.test(document.querySelector('.log')?.innerText)");
      assert.deepEqual(await faults(page), []);
      await page.evaluate("document.querySelector('.tools button').click()");
      const [bytes] = await savedFiles(page, 1);
      assert.ok(bytes);
      const tape = await Tape.open("page.rrtape", bytes);
      assert.deepEqual([...tape.problems], []);
      const speed = tape.tracks.find((one) => one.member === "speed");
      assert.ok(speed?.events[0]);
      assert.equal(tape.value(speed, speed.events[0]), both.workshop.state.speed);
    }));
});
