// SPDX-License-Identifier: Apache-2.0
// How fast the page is: times of frames with 20 wires at 1 kHz, pictures at 30 Hz, the first plot, memory over a session.
// ROBDEF_INSPECTOR_PAGE: its file; ROBDEF_STANDARD_DIR: the standard definitions; ROBDEF_WIRES: a program that serves the wires,
// else they are served from here; ROBDEF_GRAPHICS=emulated: with an emulated graphics card. Limits are held unless ROBDEF_SLOW is set.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { after, before, describe, it } from "node:test";
import { createInterface } from "node:readline";
import { fileURLToPath } from "node:url";
import { Chromium, type Page } from "./chromium.js";
import { startWorkshop, type Workshop } from "./workshop.js";

const pageFile = process.env.ROBDEF_INSPECTOR_PAGE ?? fileURLToPath(new URL("../dist/inspector.html", import.meta.url));
const standard = process.env.ROBDEF_STANDARD_DIR;
const isSlow = process.env.ROBDEF_SLOW !== undefined;
const address = `file://${pageFile}`;
const wires = 20;
const seconds = 8;
const hours = 8;
const stepsPerSecond = 20;

let browser: Chromium;
let workshop: Workshop;

/** Notes for each frame how long its callbacks ran, and when it began. */
const watchFrames = `(() => {
  const real = requestAnimationFrame.bind(window);
  let frame = 0, work = 0;
  globalThis.frames_ = [];
  globalThis.requestAnimationFrame = (callback) => real((now) => {
    const begin = performance.now();
    if (now !== frame) { if (frame) frames_.push([frame, work]); frame = now; work = 0; }
    callback(now);
    work += performance.now() - begin;
  });
})()`;

function percentile(numbers: readonly number[], part: number): number {
  const sorted = [...numbers].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))] ?? NaN;
}

async function measured(page: Page): Promise<{ work: number[]; gaps: number[] }> {
  await page.evaluate("frames_.length = 0; undefined");
  await new Promise((resolve) => setTimeout(resolve, seconds * 1000));
  const frames = await page.evaluate<[number, number][]>("frames_");
  const gaps = frames.slice(1).map(([begin], i) => begin - (frames[i]?.[0] ?? 0));
  return { work: frames.map(([, one]) => one), gaps };
}

function report(what: string, { work, gaps }: { work: number[]; gaps: number[] }): void {
  const text = (numbers: readonly number[]): string => `median ${percentile(numbers, 0.5).toFixed(1)}, p95 ${percentile(numbers, 0.95).toFixed(1)}, most ${Math.max(...numbers).toFixed(1)} ms`;
  console.log(`# ${what}: ${work.length} frames in ${seconds} s; work of a frame ${text(work)}; between frames ${text(gaps)}`);
}

/** Twenty wires at 1 kHz: of another program, which leaves more of the machine to the page, or from here. */
async function startWires(): Promise<{ readonly url: string; readonly close: () => void }> {
  const program = process.env.ROBDEF_WIRES;
  if (program === undefined) {
    workshop.drive(1000);
    return { url: workshop.url("bench"), close: () => { workshop.drive(0); } };
  }
  const service = spawn(program, ["1000"], { stdio: ["ignore", "pipe", "inherit"] });
  const close = (): void => { service.kill(); };
  process.once("exit", close);
  for await (const line of createInterface({ input: service.stdout })) {
    if (line.startsWith("ready: ")) return { url: line.slice("ready: ".length), close };
  }
  throw new Error(`${program} has ended`);
}

/** A page that shows a service; `begin` is when its address was entered. */
async function open(url: string): Promise<{ readonly page: Page; readonly begin: number }> {
  const page = await browser.open("about:blank", { width: 1500 });
  await page.send("Page.addScriptToEvaluateOnNewDocument", { source: watchFrames });
  await page.go(address);
  await page.until("document.querySelector('.welcome')");
  await page.type("#address", url);
  const begin = Date.now();
  await page.key("Enter");
  await page.until("document.querySelector('.object')");
  return { page, begin };
}

before(async () => {
  workshop = await startWorkshop({ allowLocalPages: true, standard });
  browser = new Chromium(undefined, process.env.ROBDEF_GRAPHICS === "emulated" ? "emulated" : "none");
});

after(async () => {
  await browser.close();
  await workshop.close();
});

describe("The page", { timeout: 1_800_000 }, () => {
  it(`draws ${wires} wires at 1 kHz`, async () => {
    const { url, close } = await startWires();
    const { page, begin } = await open(url);
    await page.click("[aria-label='Plot position']");
    await page.until("document.querySelectorAll('.legend li').length === 1 && /\\d/.test(document.querySelector('.legend .number').innerText)");
    const first = Date.now() - begin;
    console.log(`# first plot: ${first} ms after connecting began`);
    await page.click("[aria-label^='Close the plot']");
    for (let i = 0; i < wires; ++i) await page.click(`[aria-label='Plot channel_${i}']`);
    await page.until(`document.querySelectorAll('.legend li').length === ${wires}`);
    await new Promise((resolve) => setTimeout(resolve, 11_000));
    const frames = await measured(page);
    report(`${wires} wires at 1 kHz`, frames);
    assert.ok(frames.work.length > 0, "the page draws");
    // They are still connected, and their values still come.
    const values = (): Promise<string> => page.evaluate<string>("document.querySelector('.legend').innerText");
    const before = await values();
    await page.until(`document.querySelector('.legend').innerText !== ${JSON.stringify(before)}`);
    close();
    if (!isSlow) {
      assert.ok(first < 2000, `the first plot took ${first} ms`);
      assert.ok(percentile(frames.work, 0.95) <= 16, "p95 of the work of a frame");
    }
    await page.close();
  });

  it("shows pictures of 640 x 480 at 30 Hz", { skip: standard === undefined }, async () => {
    const { page } = await open(workshop.url("cell"));
    await page.click("[aria-label='Show camera as a picture']");
    await page.until("document.querySelector('[data-kind=picture] canvas')?.width === 640");
    const frames = await measured(page);
    report("pictures", frames);
    const rate = Number(/(\d+) a second/.exec(await page.evaluate<string>("document.querySelector('[data-kind=picture] figcaption').innerText"))?.[1]);
    console.log(`# pictures: ${rate} a second`);
    if (!isSlow) assert.ok(rate >= 28, `${rate} pictures a second`);
    await page.close();
  });

  it(`does not grow in a session of ${hours} hours, whose clock runs faster`, async () => {
    const { page } = await open(workshop.url("bench"));
    const plotted = [0, 1, 2, 3];
    for (const i of plotted) await page.click(`[aria-label='Plot channel_${i}']`);
    await page.click("[aria-label='Watch where']");
    await page.until(`document.querySelector("[data-member=where] .value")`);
    const heap = async (): Promise<number> => {
      for (let i = 0; i < 3; ++i) await page.send("HeapProfiler.collectGarbage");
      const { usedSize } = await page.send("Runtime.getHeapUsage");
      return Number(usedSize) / 1e6;
    };
    // Wires take their times from this clock, and nothing else does.
    const real = performance.now.bind(performance);
    let ahead = 0;
    performance.now = () => real() + ahead;
    const sizes: number[] = [];
    try {
      let sent = 0;
      for (let hour = 0; hour < hours; ++hour) {
        for (let second = 0; second < 3600; ++second) {
          for (let step = 0; step < stepsPerSecond; ++step, ahead += 1000 / stepsPerSecond) {
            ++sent;
            for (const i of plotted) workshop.bench.wire(`channel_${i}`).send(i + Math.sin(sent / 30));
          }
          workshop.bench.event("moved").fire(second, "again");
          if (second % 10 === 0) await new Promise((resolve) => setTimeout(resolve, 2));
          if (second % 60 === 0) await page.click("[aria-label='Get speed']");
        }
        // The page has seen all of the hour.
        await page.until(`Math.abs(Number(document.querySelector(".legend .number").innerText.split(" ")[0]) - ${Math.sin(sent / 30)}) < 1e-5`);
        sizes.push(await heap());
        console.log(`# heap after ${hour + 1} h: ${sizes.at(-1)?.toFixed(1) ?? ""} MB`);
      }
    } finally {
      performance.now = real;
    }
    const [, second = 0] = sizes;
    assert.ok((sizes.at(-1) ?? Infinity) < second * 1.25 + 2, `the heap grows: ${sizes.join(", ")} MB`);
    await page.close();
  });
});
