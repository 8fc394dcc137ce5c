// SPDX-License-Identifier: Apache-2.0
// What tests of the page in Chromium share. ROBDEF_INSPECTOR_PAGE: the file of the page; ROBDEF_STANDARD_DIR: the
// standard definitions; ROBDEF_PROGRAMS: folder of programs of the tree; ROBDEF_SHOTS: folder for pictures of the page.
import { spawn, type ChildProcess } from "node:child_process";
import { existsSync, mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { after, before } from "node:test";
import { fileURLToPath } from "node:url";
import { Chromium, type Page } from "./chromium.js";
import { startWorkshop, type Workshop, type WorkshopOptions } from "./workshop.js";

export const pageFile = process.env.ROBDEF_INSPECTOR_PAGE ?? fileURLToPath(new URL("../dist/inspector.html", import.meta.url));
export const address = `file://${pageFile}`;
/** The standard definitions are not part of every tree. */
export const standard = process.env.ROBDEF_STANDARD_DIR === "" ? undefined : process.env.ROBDEF_STANDARD_DIR;
const programs = process.env.ROBDEF_PROGRAMS;
const shots = process.env.ROBDEF_SHOTS;
const axe = readFileSync(createRequire(fileURLToPath(new URL("../", import.meta.url))).resolve("axe-core/axe.min.js"), "utf8");

/** A whole test file: the browser has to start, and the machine may be busy. */
export const allowed = { timeout: 900_000 };

/** A browser and a workshop for the tests of a file. */
export function startBoth(options: WorkshopOptions = {}): { readonly browser: Chromium; readonly workshop: Workshop } {
  const both: { browser?: Chromium; workshop?: Workshop } = {};
  before(async () => {
    both.workshop = await startWorkshop({ allowLocalPages: true, standard, ...options });
    both.browser = new Chromium();
  });
  after(async () => {
    await both.browser?.close();
    await both.workshop?.close();
  });
  return both as { readonly browser: Chromium; readonly workshop: Workshop };
}

/** Keeps a picture of the page, where somebody wants it. */
export async function shoot(page: Page, name: string): Promise<void> {
  if (shots === undefined) return;
  mkdirSync(shots, { recursive: true });
  await page.screenshot(join(shots, `${name}.png`));
}

/** In light and in dark. */
export async function shootBoth(page: Page, name: string): Promise<void> {
  if (shots === undefined) return;
  await page.scheme("light");
  await shoot(page, name);
  await page.scheme("dark");
  await pause(300);
  await shoot(page, `${name}-dark`);
  await page.scheme("light");
}

export async function connect(page: Page, url: string): Promise<void> {
  await page.type("#address", url);
  await page.key("Enter");
}

export function pause(milliseconds: number): Promise<void> {
  return new Promise((resolve) => setTimeout(resolve, milliseconds));
}

/** Text of an element, as people see it. */
export function text(page: Page, selector: string): Promise<string> {
  return page.evaluate<string>(`document.querySelector(${JSON.stringify(selector)})?.innerText ?? ""`);
}

/** Chooses in a list. */
export async function choose(page: Page, selector: string, value: string): Promise<void> {
  await page.until(`document.querySelector(${JSON.stringify(selector)})`, selector);
  await page.evaluate(`(() => { const s = document.querySelector(${JSON.stringify(selector)}); s.value = ${JSON.stringify(value)}; s.dispatchEvent(new Event("change", { bubbles: true })); })()`);
}

/** Clicks what has exactly this text, among elements that a selector finds. */
export async function clickText(page: Page, selector: string, words: string): Promise<void> {
  const found = `[...document.querySelectorAll(${JSON.stringify(selector)})].find((one) => one.innerText === ${JSON.stringify(words)})`;
  await page.until(found, `${words} among ${selector}`);
  await page.evaluate(`${found}.click()`);
}

/** Enters a text in a member's field, found by its label. */
export async function enter(page: Page, member: string, label: string, value: string): Promise<void> {
  const found = `[...document.querySelectorAll("[data-member=${member}] form label")].find((one) => one.innerText.startsWith(${JSON.stringify(`${label} `)}))`;
  await page.until(found, `the field ${label} of ${member}`);
  await page.type(`[id="${await page.evaluate<string>(`${found}.htmlFor`)}"]`, value);
}

export async function submit(page: Page, selector: string): Promise<void> {
  await page.until(`document.querySelector(${JSON.stringify(selector)})`, selector);
  await page.evaluate(`document.querySelector(${JSON.stringify(selector)}).requestSubmit()`);
}

/** Keeps the files that the page saves from now on in `saved`. */
export async function catchFiles(page: Page): Promise<void> {
  await page.evaluate("if (!globalThis.saved) { const make = URL.createObjectURL; URL.createObjectURL = (blob) => { blob.arrayBuffer().then((bytes) => saved.push(Array.from(new Uint8Array(bytes)))); return make(blob); }; } globalThis.saved = []; undefined");
}

export async function savedFiles(page: Page, count: number): Promise<Uint8Array[]> {
  await page.until(`saved.length === ${count}`, `${count} files`);
  return (await page.evaluate<number[][]>("saved")).map((bytes) => Uint8Array.from(bytes));
}

/** Faults that axe-core finds; the page's policy lets the debugger's scripts run, and no other. */
export async function faults(page: Page): Promise<string[]> {
  await page.evaluate(`${axe}; undefined`);
  const found = await page.evaluate<{ id: string; nodes: { target: string[]; failureSummary: string }[] }[]>("axe.run(document, { resultTypes: ['violations'] }).then((r) => r.violations.map(({ id, nodes }) => ({ id, nodes: nodes.map(({ target, failureSummary }) => ({ target, failureSummary })) })))");
  return found.flatMap(({ id, nodes }) => nodes.map(({ target, failureSummary }) => `${id}: ${target.join(" ")}: ${failureSummary}`));
}

/** Faults in light and in dark: contrasts differ. */
export async function faultsInBoth(page: Page): Promise<string[]> {
  const light = await faults(page);
  await page.scheme("dark");
  const dark = await faults(page);
  await page.scheme("light");
  return [...light, ...dark.map((one) => `dark: ${one}`)];
}

const served = new Set<ChildProcess>();
process.on("exit", () => {
  for (const one of served) one.kill("SIGKILL");
});

/** Why a program of the tree cannot be used, or false. */
export function missing(...names: string[]): string | false {
  if (programs === undefined || programs === "") return "ROBDEF_PROGRAMS is not set";
  const absent = names.filter((name) => !existsSync(join(programs, name)));
  return absent.length === 0 ? false : `not built: ${absent.join(", ")}`;
}

/** A program of the tree that serves; gives the URL that it prints. */
export async function serve(name: string, args: readonly string[]): Promise<{ url: string; program: ChildProcess }> {
  const program = spawn(join(programs ?? "", name), [...args, "--inspector", `${pageFile}.gz`], { stdio: ["ignore", "pipe", "ignore"] });
  served.add(program);
  let printed = "";
  const url = await new Promise<string>((resolve, reject) => {
    program.stdout.setEncoding("utf8").on("data", (more: string) => {
      printed += more;
      const found = /ready: (\S+)\s/.exec(printed)?.[1];
      if (found !== undefined) resolve(found);
    });
    program.once("exit", () => {
      served.delete(program);
      reject(new Error(`${name} has ended: ${printed}`));
    });
  });
  return { url, program };
}

/** The page that a node serves. */
export function pageOf(url: string): string {
  return `http://${/\/\/([^/?]*)/.exec(url)?.[1] ?? ""}/`;
}

export async function end(program: ChildProcess): Promise<void> {
  if (program.exitCode !== null || program.signalCode !== null) return;
  const ended = new Promise((resolve) => program.once("exit", resolve));
  program.kill("SIGTERM");
  const timer = setTimeout(() => program.kill("SIGKILL"), 10_000);
  await ended;
  clearTimeout(timer);
}
