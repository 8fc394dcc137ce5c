// SPDX-License-Identifier: Apache-2.0
// The page in Chromium, driven as a person does. ROBDEF_INSPECTOR_PAGE: its file; ROBDEF_STANDARD_DIR: the standard
// definitions; ROBDEF_PROGRAMS: folder of programs of the tree; ROBDEF_SHOTS: folder for pictures of the page.
import assert from "node:assert/strict";
import { spawn, type ChildProcess } from "node:child_process";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";
import { fileURLToPath } from "node:url";
import { RRNode, type StreamOpener } from "@robdef/runtime/node";
import { Recorder } from "../src/tape/recorder.js";
import { Chromium, type Page } from "./chromium.js";
import { openNodeWebSocket } from "./web_socket.js";
import { hostileName, startWorkshop, workshopPassword, type Workshop } from "./workshop.js";

const pageFile = process.env.ROBDEF_INSPECTOR_PAGE ?? fileURLToPath(new URL("../dist/inspector.html", import.meta.url));
const standard = process.env.ROBDEF_STANDARD_DIR;
const programs = process.env.ROBDEF_PROGRAMS;
const shots = process.env.ROBDEF_SHOTS;
const address = `file://${pageFile}`;
const axe = readFileSync(createRequire(`${process.env.ROBDEF_INSPECTOR_MODULES ?? process.cwd()}/`).resolve("axe-core/axe.min.js"), "utf8");

/** Times are not held on a machine that is busy with other things. */
const isSlow = process.env.ROBDEF_SLOW !== undefined;

let browser: Chromium;
let workshop: Workshop;

async function shoot(page: Page, name: string): Promise<void> {
  if (shots === undefined) return;
  mkdirSync(shots, { recursive: true });
  await page.screenshot(join(shots, `${name}.png`));
}

async function connect(page: Page, url: string): Promise<void> {
  await page.type("#address", url);
  await page.key("Enter");
}

function pause(milliseconds: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, milliseconds));
}

/** Text of an element, as people see it. */
function text(page: Page, selector: string): Promise<string> {
  return page.evaluate<string>(`document.querySelector(${JSON.stringify(selector)})?.innerText ?? ""`);
}

/** Faults that axe-core finds; the page's policy lets the debugger's scripts run, and no other. */
async function faults(page: Page): Promise<string[]> {
  await page.evaluate(`${axe}; undefined`);
  const found = await page.evaluate<{ id: string; nodes: { target: string[]; failureSummary: string }[] }[]>("axe.run(document, { resultTypes: ['violations'] }).then((r) => r.violations.map(({ id, nodes }) => ({ id, nodes: nodes.map(({ target, failureSummary }) => ({ target, failureSummary })) })))");
  return found.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target.join(" ")}: ${failureSummary}`));
}

before(async () => {
  workshop = await startWorkshop({ allowLocalPages: true, standard });
  browser = new Chromium();
});

after(async () => {
  await browser.close();
  await workshop.close();
});

describe("The page", { timeout: 300_000 }, () => {
  it("begins empty, in light and dark, and has no fault that axe finds", async () => {
    const page = await browser.open(address);
    await page.until("document.querySelector('.welcome')");
    assert.match(await text(page, "main"), /Nothing was connected from this browser yet/);
    assert.deepEqual(await faults(page), []);
    await shoot(page, "empty");
    await page.scheme("dark");
    assert.deepEqual(await faults(page), []);
    assert.deepEqual(page.complaints, []);
    await page.close();
  });

  it("says why it cannot connect", async () => {
    const closed = await startWorkshop();
    const refused = closed.url("bench");
    const page = await browser.open(address);
    try {
      await connect(page, refused);
      await page.until("document.querySelector('.failure')");
      assert.match(await text(page, ".failure"), /refuses this page[\s\S]*allow-local-pages/);
      assert.deepEqual(await faults(page), []);
      await shoot(page, "refused");
    } finally {
      await closed.close();
    }
    await connect(page, refused);
    await page.until("/Nothing answers/.test(document.querySelector('.failure')?.innerText)");
    await connect(page, "rr+ws://127.0.0.1:6000/?service=a");
    await page.until("/Browsers refuse to connect to port 6000/.test(document.querySelector('.failure')?.innerText)");
    await connect(page, "rr+local:///?service=a");
    await page.until("/a page cannot open them/.test(document.querySelector('.failure')?.innerText)");
    await connect(page, workshop.url("nothing"));
    await page.until("/has no service of this name/.test(document.querySelector('.failure')?.innerText)");
    await page.close();
  });

  it("lists the services of a node, and remembers what was connected", async () => {
    const page = await browser.open(address);
    await connect(page, `127.0.0.1:${workshop.port}`);
    await page.until("document.querySelector('.links button')");
    assert.match(await text(page, "main"), /bench\s+Bench/);
    await page.evaluate("[...document.querySelectorAll('.links button')].find((one) => one.innerText === 'trap').click()");
    await page.until("document.querySelector('[data-member=texts]')");
    await page.close();
    const again = await browser.open(address);
    await again.until("/service=trap/.test(document.querySelector('[aria-label=\"Recent connections\"]')?.innerText)");
    await again.close();
  });

  it("shows objects, and sets properties by forms made from types", async () => {
    const page = await browser.open(address);
    await connect(page, workshop.url("bench"));
    await page.until("document.querySelectorAll('[role=treeitem]').length === 5", "the bench and four tools");
    await page.until("/0.25 m\\/s/.test(document.querySelector('[data-member=speed]').innerText)");
    await page.until("/jog/.test(document.querySelector('[data-member=mode] .value')?.innerText)");
    await page.click("[aria-label='Edit speed']");
    await page.type("[data-member=speed] form input", "fast");
    await page.key("Enter");
    await page.until("/is no number/.test(document.querySelector('[data-member=speed] .problem')?.innerText)");
    await page.type("[data-member=speed] form input", "11");
    await page.key("Enter");
    await page.until("/OutOfRange[\\s\\S]*faster than 10/.test(document.querySelector('[data-member=speed]').innerText)");
    await shoot(page, "error");
    await page.type("[data-member=speed] form input", "0.75");
    await page.key("Enter");
    await page.until("/0.75 m\\/s/.test(document.querySelector('[data-member=speed] .current').innerText)");
    assert.equal(workshop.state.speed, 0.75);
    // The event that this fires.
    await page.until("/to: 0.75, why: \"speed\"/.test(document.querySelector('[data-member=moved]').innerText)");
    await page.click("[aria-label='Edit settings']");
    await page.until("document.querySelector('[data-member=settings] .matrix input')");
    await shoot(page, "form");
    const inputs = "[data-member=settings] form";
    await page.type(`${inputs} [aria-label='matrix, row 1, column 2']`, "99");
    await page.evaluate(`(() => { const s = document.querySelector("${inputs} select"); s.value = "10"; s.dispatchEvent(new Event("change", { bubbles: true })); })()`);
    await page.evaluate(`document.querySelector("${inputs}").requestSubmit()`);
    await page.until("/mode: automatic/.test(document.querySelector('[data-member=settings] .current').innerText)");
    const { matrix, mode, serial } = workshop.state.settings as { matrix: { array: Float64Array }; mode: number; serial: bigint };
    assert.deepEqual([...matrix.array], [11, 21, 12, 22, 13, 99]);
    assert.equal(mode, 10);
    assert.equal(serial, 9007199254740993n);
    assert.deepEqual(await faults(page), []);
    await page.scheme("dark");
    assert.deepEqual(await faults(page), []);
    await shoot(page, "dark");
    assert.deepEqual(page.complaints, []);
    await page.close();
  });

  it("calls functions, steps generators, answers callbacks, reads memories, sends packets", async () => {
    const page = await browser.open(address);
    await connect(page, workshop.url("bench"));
    await page.click("[aria-label='Call add with…']");
    const set = async (member: string, label: string, value: string): Promise<void> => {
      await page.until(`document.querySelector("[data-member=${member}] form label")`);
      const id = await page.evaluate<string>(`[...document.querySelectorAll("[data-member=${member}] form label")].find((one) => one.innerText.startsWith("${label}")).htmlFor`);
      await page.type(`[id="${id}"]`, value);
    };
    await set("add", "a ", "2");
    await set("add", "b ", "40");
    await page.key("Enter");
    await page.until("document.querySelector('[data-member=add] .result')?.innerText === '42'");
    await page.click("[aria-label='Call fail with…']");
    await set("fail", "how", "badly");
    await page.evaluate("document.querySelector('[data-member=fail] form').requestSubmit()");
    await page.until("/Jammed jammed: badly \\[belt\\]/.test(document.querySelector('[data-member=fail] .problem')?.innerText)");
    await page.click("[aria-label='Step through count…']");
    await set("count", "limit", "3");
    await page.key("Enter");
    for (let i = 1; i <= 3; ++i) {
      await page.click("[data-member=count] .stepping .primary");
      await page.until(`document.querySelectorAll('[data-member=count] .steps li').length === ${i}`);
    }
    await page.click("[data-member=count] .stepping .primary");
    await page.until("/At its end after 3 steps/.test(document.querySelector('[data-member=count]').innerText)");
    await page.evaluate("(() => { const s = document.querySelector('[data-member=advise] select'); s.value = 'ask'; s.dispatchEvent(new Event('change', { bubbles: true })); })()");
    await page.until("/0 calls so far/.test(document.querySelector('[data-member=advise]').innerText)");
    const asked = askAll(workshop);
    await page.until("/left or right/.test(document.querySelector('[data-member=advise] .question')?.innerText)");
    await set("advise", "answer", "1.5").catch(() => page.type("[data-member=advise] input[type=text]", "1.5"));
    await page.evaluate("document.querySelector('[data-member=advise] .question .primary').click()");
    assert.equal(await asked, 1.5);
    await page.click("[aria-label='Read table']");
    await page.until("/400 items/.test(document.querySelector('[data-member=table]').innerText)");
    await page.click("[aria-label='Read picture']");
    await page.click("[data-member=picture] input[type=checkbox]");
    await page.until("document.querySelector('[data-member=picture] canvas')?.width === 48");
    await page.click("[aria-label='Peek position']");
    await page.until("/-?\\d/.test(document.querySelector('[data-member=position] .value')?.innerText)");
    await page.click("[aria-label='Poke demand…']");
    await set("demand", "demand", "7.5");
    await page.key("Enter");
    await page.until("/demand is sent/.test(document.querySelector('[aria-live]').innerText)");
    assert.equal(workshop.state.demand, 7.5);
    await page.click("[aria-label='Send chat…']");
    await page.type("[data-member=chat] form textarea", "hello");
    await page.evaluate("document.querySelector('[data-member=chat] form').requestSubmit()");
    await page.until("/chat is sent/.test(document.querySelector('[aria-live]').innerText)");
    await pause(100);
    assert.deepEqual(workshop.state.chat, ["hello"]);
    assert.match(await text(page, ".log"), /call\s+add\s+\(2, 40\)\s+42/);
    await page.evaluate("(() => { const s = document.querySelector('.log select'); s.value = 'cpp'; s.dispatchEvent(new Event('change', { bubbles: true })); })()");
    await page.click("[aria-label='Copy call add as code']");
    await page.until("/object.call\\(\"add\", \\{2.0, 40.0\\}\\)/.test(document.querySelector('.log .code')?.innerText)");
    assert.deepEqual(await faults(page), []);
    assert.deepEqual(page.complaints, []);
    await page.close();
  });

  it("logs in, and shows and ends locks", async () => {
    const page = await browser.open(address);
    await connect(page, workshop.url("guarded"));
    await page.until("document.querySelector('.failure .login')");
    await page.type(".failure [name=user]", "alice");
    await page.type(".failure [name=password]", "wrong");
    await page.key("Enter");
    await page.until("/AuthenticationError/.test(document.querySelector('.failure')?.innerText)");
    await page.type(".failure [name=user]", "alice");
    await page.type(".failure [name=password]", workshopPassword);
    await page.key("Enter");
    await page.until("/as alice/.test(document.querySelector('.device-head')?.innerText)");
    await page.evaluate("[...document.querySelectorAll('.locks button')].find((one) => one.innerText === 'Lock for alice').click()");
    await page.until("/locked by this user/.test(document.querySelector('.locks').innerText)");
    assert.match(await text(page, "nav"), /locked/);
    await page.evaluate("[...document.querySelectorAll('.locks button')].find((one) => one.innerText === 'Unlock').click()");
    await page.until("!/locked/.test(document.querySelector('nav').innerText)");
    assert.ok(!(await page.evaluate<string>("location.href + JSON.stringify(localStorage) + document.documentElement.outerHTML")).includes(workshopPassword));
    await page.close();
  });

  it("is used by the keyboard alone", async () => {
    const page = await browser.open(address);
    await page.until("document.querySelector('.welcome')");
    await pause(200);
    await page.key("/", "Slash");
    await page.until("document.activeElement.id === 'address'");
    await page.send("Input.insertText", { text: workshop.url("bench") });
    await page.key("Enter");
    await page.until("document.querySelectorAll('[role=treeitem]').length === 5");
    await page.evaluate("document.activeElement.blur()");
    await page.key("t", "KeyT");
    await page.until("document.activeElement.getAttribute('role') === 'treeitem'");
    await page.key("ArrowDown");
    await page.key("ArrowDown");
    await page.key("Enter");
    await page.until("document.querySelector('.object-head h2')?.innerText === 'tools[0]'");
    await page.key("Home");
    await page.key("ArrowLeft");
    await page.until("document.querySelectorAll('[role=treeitem]').length === 1");
    await page.key("ArrowRight");
    await page.until("document.querySelectorAll('[role=treeitem]').length === 5");
    await page.close();
  });

  it("keeps its layout in its URL", async () => {
    const page = await browser.open(address);
    await connect(page, workshop.url("bench"));
    await page.click("[aria-label='Plot position']");
    await page.until("document.querySelector('.legend li')");
    await page.evaluate("[...document.querySelectorAll('.tree .title')].find((one) => one.innerText === 'tools[1]').click()");
    await page.until("/tools/.test(decodeURIComponent(location.hash))");
    const url = await page.evaluate<string>("location.href");
    await page.close();
    const again = await browser.open(url);
    await again.until("document.querySelector('.object-head h2')?.innerText === 'tools[1]'");
    await again.until("document.querySelector('.legend li')");
    await again.close();
  });
});

/** Asks all clients, and gives the first answer: pages of other tests have none. */
async function askAll({ bench }: Workshop): Promise<unknown> {
  for (let tries = 0; ; ++tries) {
    const clients = [...bench.places.values()].flatMap(clientsOf);
    try {
      return await Promise.any(clients.map((client) => bench.callback("advise").call(client, ["left or right?"])));
    } catch (error) {
      // The page may not have said yet that it answers.
      if (tries === 50) throw error;
      await pause(100);
    }
  }
}

function clientsOf(service: unknown): number[] {
  return [...(service as { clients: ReadonlyMap<number, unknown> }).clients.keys()];
}

describe("Hostile texts", { timeout: 300_000 }, () => {
  it("of names, docs, values and errors stay texts", async () => {
    const page = await browser.open(address);
    await connect(page, workshop.url("trap"));
    await page.until("document.querySelector('[data-member=texts] .current .value:not(.none)')");
    await page.until(`document.querySelector('[data-member=text] .current').innerText.includes('onerror')`);
    workshop.trap.event("alarm").fire(hostileName);
    await page.until(`document.querySelector('[data-member=alarm] .events')?.innerText.includes('onerror')`);
    await page.click("[aria-label='Edit text']");
    await page.evaluate("document.querySelector('[data-member=text] form').requestSubmit()");
    await page.until(`document.querySelector('[data-member=text] .problem')?.innerText.includes(${JSON.stringify(hostileName)})`);
    await page.click("[aria-label='Call shout with…']");
    await page.evaluate("document.querySelector('[data-member=shout] form').requestSubmit()");
    await page.until("document.querySelector('[data-member=shout] .result')?.innerText.includes('onerror')");
    await page.type("[data-member=inner] input", hostileName);
    await page.evaluate("document.querySelector('[data-member=inner] form').requestSubmit()");
    await page.until(`document.querySelector('.object-head h2')?.innerText.includes(${JSON.stringify(hostileName)})`);
    for (const language of ["cpp", "csharp", "matlab", "typescript", "shell"]) {
      await page.evaluate(`(() => { const s = document.querySelector('.log select'); s.value = '${language}'; s.dispatchEvent(new Event('change', { bubbles: true })); })()`);
      await page.click(".log .entries button");
    }
    await pause(200);
    assert.equal(await page.evaluate("globalThis.pwned"), undefined);
    assert.equal(await page.evaluate("document.querySelectorAll('img, svg, b.x, script:not([id]):not(:last-of-type)').length + document.querySelectorAll('main script, main iframe').length"), 0);
    assert.deepEqual(await faults(page), []);
    assert.deepEqual(page.complaints, []);
    await page.close();
  });

  it("in links do nothing", async () => {
    for (const hash of ["#url=javascript:globalThis.pwned=1", `#url=${encodeURIComponent(hostileName)}`, `#l=${encodeURIComponent(JSON.stringify({ urls: [hostileName], panels: [{ kind: hostileName, places: [] }] }))}`]) {
      const page = await browser.open(address + hash);
      await page.until("document.querySelector('.failure')");
      assert.equal(await page.evaluate("globalThis.pwned"), undefined);
      await page.close();
    }
  });

  it("that would be a script are stopped by the policy of the file", async () => {
    const page = await browser.open(address);
    await page.evaluate("(() => { document.body.insertAdjacentHTML('beforeend', '<img src=x onerror=\"globalThis.pwned=1\">'); const s = document.createElement('script'); s.textContent = 'globalThis.pwned=2'; document.head.append(s); })()");
    await pause(200);
    assert.equal(await page.evaluate("globalThis.pwned"), undefined);
    assert.ok(page.complaints.some((one) => /Content Security Policy/.test(one)), page.complaints.join("\n"));
    const policy = /Content-Security-Policy" content="([^"]*)"/.exec(readFileSync(pageFile, "utf8"))?.[1] ?? "";
    assert.match(policy, /^default-src 'none'; script-src 'sha256-[^ ]+' 'sha256-[^ ]+'; style-src 'sha256-/);
    assert.doesNotMatch(policy, /unsafe/);
    await page.close();
  });
});

/** A recording of a workshop, as the page makes it. */
async function recordedTape(): Promise<Uint8Array> {
  const recorder = new Recorder();
  const open: StreamOpener = recorder.around(openNodeWebSocket);
  const node = new RRNode({ openers: { "rr+ws": open } });
  recorder.start([]);
  const client = await node.connect(workshop.url("bench"));
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

describe("A recording", { timeout: 300_000 }, () => {
  it("is opened, scrubbed through and plotted", async () => {
    const folder = mkdtempSync(join(tmpdir(), "inspector-tape-"));
    const file = join(folder, "belt.rrtape");
    writeFileSync(file, await recordedTape());
    const page = await browser.open(address);
    await page.choose("#tape-file", file);
    await page.until("document.querySelector('.tape h2')?.innerText === 'belt.rrtape'");
    const scrub = (part: number): Promise<unknown> => page.evaluate(`(() => { const r = document.querySelector('.scrubber input'); r.value = ${part} * r.max; r.dispatchEvent(new Event('input', { bubbles: true })); })()`);
    const speed = "document.querySelector('.tracks [data-member=speed] .value').innerText";
    await scrub(0);
    await page.until(`${speed} === '—'`);
    await scrub(0.3);
    await page.until(`${speed} === '0.1'`);
    await scrub(0.6);
    await page.until(`${speed} === '0.2'`);
    await scrub(1);
    await page.until(`${speed} === '0.3'`);
    await page.click(".tracks [aria-label='Plot position']");
    await page.click(".tracks [aria-label='Plot where']");
    await page.until("document.querySelectorAll('.legend li').length === 4");
    await scrub(0.5);
    const shown = Number((await text(page, ".legend .number")).split(" ")[0]);
    assert.ok(shown >= -1 && shown <= 1, String(shown));
    await pause(300);
    await shoot(page, "tape");
    assert.deepEqual(await faults(page), []);
    await page.click(".scrubber button");
    await page.until("Number(document.querySelector('.scrubber input').value) > 0.7 * document.querySelector('.scrubber input').max");
    writeFileSync(file, "no recording");
    await page.choose("#tape-file", file);
    await page.until("/This file is no recording/.test(document.querySelector('.notice')?.innerText)");
    assert.deepEqual(page.complaints, []);
    await page.close();
    rmSync(folder, { recursive: true });
  });

  it("is made by the page itself", async () => {
    const page = await browser.open(address);
    await connect(page, workshop.url("bench"));
    await page.until("document.querySelector('[data-member=speed] .value')");
    await page.evaluate("globalThis.saved = new Promise((resolve) => { const make = URL.createObjectURL; URL.createObjectURL = (blob) => { blob.arrayBuffer().then((bytes) => resolve(Array.from(new Uint8Array(bytes)))); return make(blob); }; }); undefined");
    await page.evaluate("document.querySelector('.tools button').click()");
    await page.until("/Save/.test(document.querySelector('.tools button').innerText)");
    await page.click("[aria-label='Get speed']");
    await pause(300);
    await page.evaluate("document.querySelector('.tools button').click()");
    const bytes = Uint8Array.from(await page.evaluate<number[]>("saved"));
    const { Tape } = await import("../src/tape/tape.js");
    const tape = await Tape.open("page.rrtape", bytes);
    assert.deepEqual([...tape.problems], []);
    const speed = tape.tracks.find((one) => one.member === "speed");
    assert.ok(speed?.events[0]);
    assert.equal(tape.value(speed, speed.events[0]), workshop.state.speed);
    await page.close();
  });
});

describe("Plots, pictures and scenes", { timeout: 300_000 }, () => {
  it("show wires with cursors, pause and files", async () => {
    const page = await browser.open(address, { width: 1500 });
    await connect(page, workshop.url("bench"));
    await page.click("[aria-label='Plot position']");
    await page.click("[aria-label='Plot where']");
    await page.click("[aria-label='Plot speed']");
    await page.until("document.querySelectorAll('.legend li').length === 5");
    await pause(3000);
    await page.evaluate("[...document.querySelectorAll('.panel button')].find((one) => one.innerText === 'Cursors').click()");
    await page.until("/s apart/.test(document.querySelector('.cursors')?.innerText)");
    await shoot(page, "plot");
    await page.evaluate("[...document.querySelectorAll('.panel button')].find((one) => one.innerText === 'Pause').click()");
    const before = await text(page, ".legend");
    await page.evaluate("globalThis.saved = []; { const make = URL.createObjectURL; URL.createObjectURL = (blob) => { blob.arrayBuffer().then((bytes) => saved.push(Array.from(new Uint8Array(bytes)))); return make(blob); }; } undefined");
    await page.evaluate("[...document.querySelectorAll('.panel button')].find((one) => one.innerText === 'CSV').click()");
    await page.evaluate("[...document.querySelectorAll('.panel button')].find((one) => one.innerText === '.mat').click()");
    await page.until("saved.length === 2");
    const [csv = [], mat = []] = await page.evaluate<number[][]>("saved");
    const csvText = Buffer.from(csv).toString();
    assert.match(csvText.split("\r\n")[0] ?? "", /^time,position,time of where\.x,where\.x/);
    assert.ok(csvText.split("\r\n").length > 100, csvText.slice(0, 200));
    assert.equal(Buffer.from(mat).toString("latin1", 0, 10), "MATLAB 5.0");
    assert.ok(before.length > 0);
    assert.deepEqual(await faults(page), []);
    assert.deepEqual(page.complaints, []);
    await page.close();
  });

  it("take 100,000 points a second", async () => {
    const page = await browser.open(address);
    await connect(page, workshop.url("bench"));
    await page.click("[aria-label='Plot waves']");
    await page.until("document.querySelectorAll('.legend li').length === 1");
    await pause(500);
    await page.until("/-?\\d/.test(document.querySelector('.legend .number').innerText)");
    assert.deepEqual(page.complaints, []);
    await page.close();
  });

  it("of a camera and of poses are drawn", { skip: standard === undefined }, async () => {
    const page = await browser.open(address, { width: 1500, height: 1000 });
    await connect(page, workshop.url("cell"));
    await page.click("[aria-label='Show camera as a picture']");
    await page.until("document.querySelector('[data-kind=picture] canvas')?.width === 640");
    // The lamp is set by its form, and seen in the picture: red is its light.
    const red = "(() => { const c = document.querySelector('[data-kind=picture] canvas'); return c.getContext('2d').getImageData(10, 10, 1, 1).data[0]; })()";
    await page.until(`Math.abs(${red} - 127) < 3`);
    await page.click("[aria-label='Edit lamp']");
    await page.type("[data-member=lamp] form input", "1");
    await page.key("Enter");
    await page.until(`${red} === 255`);
    assert.equal(workshop.state.lamp, 1);
    await page.click("[aria-label='Show tcp in 3-D']");
    await page.until("/tcp: at/.test(document.querySelector('[data-kind=scene] .poses')?.innerText)");
    await page.click("[aria-label='Show frames in 3-D']");
    await page.until("document.querySelectorAll('[data-kind=scene] canvas').length === 2");
    await pause(1500);
    await shoot(page, "camera");
    assert.deepEqual(await faults(page), []);
    assert.deepEqual(page.complaints.filter((one) => !/GL Driver Message|GPU stall/.test(one)), []);
    await page.close();
  });
});

/** A program of the tree that serves; gives the URL that it prints. */
async function serve(name: string, args: readonly string[]): Promise<{ url: string; program: ChildProcess }> {
  const program = spawn(join(programs ?? "", name), [...args, "--inspector", `${pageFile}.gz`], { stdio: ["ignore", "pipe", "ignore"] });
  let printed = "";
  const url = await new Promise<string>((resolve, reject) => {
    program.stdout.setEncoding("utf8").on("data", (more: string) => {
      printed += more;
      const found = /ready: (\S+)\s/.exec(printed)?.[1];
      if (found !== undefined) resolve(found);
    });
    program.once("exit", () => { reject(new Error(`${name} has ended: ${printed}`)); });
  });
  return { url, program };
}

/** The page that a node serves. */
function pageOf(url: string): string {
  return `http://${/\/\/([^/?]*)/.exec(url)?.[1] ?? ""}/`;
}

async function end(program: ChildProcess): Promise<void> {
  const ended = new Promise((resolve) => program.once("exit", resolve));
  program.kill("SIGTERM");
  const timer = setTimeout(() => program.kill("SIGKILL"), 5000);
  await ended;
  clearTimeout(timer);
}

const hasPrograms = programs !== undefined && existsSync(`${pageFile}.gz`) && existsSync(join(programs, "smart_room_service")) && existsSync(join(programs, "dual_arm"));

describe("Services in C++", { skip: hasPrograms ? false : "the programs are not built", timeout: 300_000 }, () => {
  it("the smart room: a lamp that is set by its form is seen in the camera's picture", async () => {
    const { url, program } = await serve("smart_room_service", ["--port", "0"]);
    // From the node itself: a page of its own origin.
    const page = await browser.open(pageOf(url), { width: 1500, height: 1000 });
    try {
      await page.click(".links button");
      await page.until("document.querySelectorAll('[role=treeitem]').length > 3");
      await page.evaluate("[...document.querySelectorAll('.tree .title')].find((one) => one.innerText === 'robcamera[0]').click()");
      await page.click("[aria-label='Show GetCurrentStreamFrameCameraBitmap as a picture, again and again']");
      await page.until("document.querySelector('[data-kind=picture] canvas')?.width > 10");
      await pause(300);
      const sum = "(() => { const c = document.querySelector('[data-kind=picture] canvas'); const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let s = [0, 0, 0]; for (let i = 0; i < d.length; i += 4) for (let k = 0; k < 3; ++k) s[k] += d[i + k]; return s; })()";
      const dark = await page.evaluate<number[]>(sum);
      await page.evaluate("[...document.querySelectorAll('.tree .title')].find((one) => one.innerText === 'robdevice[0]').click()");
      await page.click("[aria-label='Call SetProperty with…']");
      await page.type("[data-member=SetProperty] form textarea", "SetRGBRange");
      await page.type("[data-member=SetProperty] form textarea.numbers", "1, 6, 1, 0, 0");
      await page.evaluate("document.querySelector('[data-member=SetProperty] form').requestSubmit()");
      await page.until("document.querySelector('[data-member=SetProperty] .result')?.innerText === '0'");
      await page.until(`${sum}[0] > ${(dark[0] ?? 0) + 100000}`, "more red in the picture");
      const lit = await page.evaluate<number[]>(sum);
      assert.ok((lit[0] ?? 0) - (dark[0] ?? 0) > 3 * Math.abs((lit[2] ?? 0) - (dark[2] ?? 0)), `red ${dark.join()} to ${lit.join()}`);
      // What the service refuses is said in its words.
      await page.type("[data-member=SetProperty] form textarea.numbers", "1, 99, 1, 0, 0");
      await page.evaluate("document.querySelector('[data-member=SetProperty] form').requestSubmit()");
      await page.until("/InvalidArgument[\\s\\S]*lamps are counted from 1/.test(document.querySelector('[data-member=SetProperty] .problem')?.innerText)");
      await shoot(page, "smart_room");
      assert.deepEqual(await faults(page), []);
      assert.deepEqual(page.complaints, []);
    } finally {
      await page.close();
      await end(program);
    }
  });

  it("the dual arm: its state is plotted, its signals are read", async () => {
    const { url, program } = await serve("dual_arm", ["--serve", "120"]);
    const page = await browser.open(pageOf(url), { width: 1500, height: 1000 });
    try {
      const begin = Date.now();
      await connect(page, url);
      await page.click("[aria-label='Plot state']");
      await page.until("document.querySelectorAll('.legend li').length > 20");
      assert.ok(Date.now() - begin < 2000 || isSlow, `the first plot took ${Date.now() - begin} ms`);
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
      await page.evaluate("document.querySelector('[data-member=gamepad] form').requestSubmit()");
      await page.until("/gamepad is sent/.test(document.querySelector('[aria-live]').innerText)");
      await pause(2500);
      await shoot(page, "dual_arm");
      assert.deepEqual(page.complaints, []);
    } finally {
      await page.close();
      await end(program);
    }
  });
});
