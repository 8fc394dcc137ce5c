// SPDX-License-Identifier: Apache-2.0
// Chromium, driven over its DevTools protocol by a pipe: no port, no library.
import { spawn, type ChildProcess } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Readable, Writable } from "node:stream";

export interface PageOptions {
  readonly width?: number;
  readonly height?: number;
  readonly scheme?: "light" | "dark";
}

type Json = Readonly<Record<string, unknown>>;

interface Pending {
  readonly resolve: (result: Json) => void;
  readonly reject: (error: Error) => void;
}

/** How long a page may take before a test gives up: long, since machines are busy at times. */
const patience = Number(process.env.ROBDEF_PATIENCE ?? 180) * 1000;

/** Browsers that run: none is left behind when a test ends early. */
const running = new Set<ChildProcess>();
process.on("exit", () => {
  for (const one of running) kill(one);
});
for (const name of ["SIGTERM", "SIGINT", "SIGHUP"] as const) process.on(name, () => process.exit(1));

/** Ends a browser with all of its processes, which are a group. */
function kill({ pid }: ChildProcess): void {
  if (pid === undefined) return;
  try {
    process.kill(-pid, "SIGKILL");
  } catch {
    // It has ended.
  }
}

/** A browser without a window. Close it, or it stays until the test ends. */
export class Chromium {
  private readonly profile = mkdtempSync(join(tmpdir(), "inspector-"));
  private readonly process: ChildProcess;
  private readonly out: Writable;
  private readonly pending = new Map<number, Pending>();
  private readonly pages = new Map<string, Page>();
  private last = 0;
  private rest = "";
  private isOver = false;

  /** `graphics`: a graphics card is emulated, which 3-D needs; or there is none, as Chromium finds on a machine without one. `more`: flags. */
  constructor(program = process.env.ROBDEF_BROWSER ?? "chromium", graphics: "emulated" | "none" = "emulated", more: readonly string[] = []) {
    const flags = [
      ...more,
      ...(graphics === "none" ? ["--disable-gpu"] : ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]),
      "--headless=new", "--no-sandbox", "--no-first-run", "--disable-background-networking", "--disable-dev-shm-usage", "--remote-debugging-pipe",
      "--hide-scrollbars", "--force-color-profile=srgb", `--user-data-dir=${this.profile}`, "about:blank",
    ];
    this.process = spawn(program, flags, { stdio: ["ignore", "ignore", "ignore", "pipe", "pipe"], detached: true });
    running.add(this.process);
    this.out = this.process.stdio[3] as Writable;
    (this.process.stdio[4] as Readable).setEncoding("utf8").on("data", (text: string) => {
      const parts = (this.rest + text).split("\0");
      this.rest = parts.pop() ?? "";
      for (const part of parts) this.take(JSON.parse(part) as Json);
    });
    const ended = (why: string): void => {
      running.delete(this.process);
      this.isOver = true;
      for (const { reject } of this.pending.values()) reject(new Error(why));
      this.pending.clear();
    };
    this.process.on("exit", (code, name) => {
      ended(`the browser has ended (${code ?? name ?? ""})`);
    });
    this.process.on("error", (error) => {
      ended(`${program}: ${error.message}`);
    });
    this.out.on("error", () => undefined);
  }

  send(method: string, params: Json = {}, sessionId?: string): Promise<Json> {
    const id = ++this.last;
    return new Promise((resolve, reject) => {
      if (this.isOver) {
        reject(new Error("the browser has ended"));
        return;
      }
      const timer = setTimeout(() => {
        this.pending.delete(id);
        reject(new Error(`no answer within ${patience / 1000} s to ${method} ${String(params.expression ?? "").slice(0, 200)}`));
      }, patience);
      const over = <T>(then: (value: T) => void) => (value: T): void => {
        clearTimeout(timer);
        then(value);
      };
      this.pending.set(id, { resolve: over(resolve), reject: over(reject) });
      this.out.write(`${JSON.stringify({ id, method, params, ...(sessionId === undefined ? {} : { sessionId }) })}\0`);
    });
  }

  private take(message: Json): void {
    const waiting = typeof message.id === "number" ? this.pending.get(message.id) : undefined;
    if (waiting) {
      this.pending.delete(message.id as number);
      const error = message.error as { message: string } | undefined;
      if (error) waiting.reject(new Error(error.message));
      else waiting.resolve((message.result ?? {}) as Json);
      return;
    }
    if (typeof message.sessionId === "string") this.pages.get(message.sessionId)?.event(String(message.method), (message.params ?? {}) as Json);
  }

  /** A page of so many pixels, at a URL. */
  async open(url: string, { width = 1280, height = 860, scheme = "light" }: PageOptions = {}): Promise<Page> {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, String(sessionId), String(targetId));
    this.pages.set(String(sessionId), page);
    for (const domain of ["Page", "Runtime", "Log", "DOM"]) await page.send(`${domain}.enable`);
    await page.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await page.scheme(scheme);
    await page.go(url);
    return page;
  }

  /** Opens a page, does something with it, and closes it whatever comes of that. */
  async with(url: string, options: PageOptions, use: (page: Page) => Promise<void>): Promise<void> {
    const page = await this.open(url, options);
    try {
      await use(page);
    } finally {
      await page.close().catch(() => undefined);
    }
  }

  async close(): Promise<void> {
    const ended = this.isOver ? undefined : new Promise((resolve) => this.process.once("exit", resolve));
    void this.send("Browser.close").catch(() => undefined);
    const timer = setTimeout(() => { kill(this.process); }, 10_000);
    await ended;
    clearTimeout(timer);
    kill(this.process);
    rmSync(this.profile, { recursive: true, force: true, maxRetries: 5 });
  }
}

/** A page in the browser. */
export class Page {
  /** What the page said about itself: errors, exceptions, violations of its policy. */
  readonly complaints: string[] = [];
  private loaded: (() => void) | undefined;

  constructor(
    private readonly browser: Chromium,
    private readonly session: string,
    private readonly target: string,
  ) {}

  send(method: string, params: Json = {}): Promise<Json> {
    return this.browser.send(method, params, this.session);
  }

  event(method: string, params: Json): void {
    if (method === "Page.loadEventFired") this.loaded?.();
    if (method === "Runtime.exceptionThrown") {
      const details = params.exceptionDetails as { text: string; exception?: { description?: string } };
      this.complaints.push(details.exception?.description ?? details.text);
    }
    if (method === "Log.entryAdded") {
      const entry = params.entry as { level: string; text: string; source: string };
      if (entry.level === "error") this.complaints.push(`${entry.source}: ${entry.text}`);
    }
    if (method === "Runtime.consoleAPICalled" && params.type === "error") {
      this.complaints.push((params.args as { value?: unknown; description?: string }[]).map((one) => String(one.value ?? one.description)).join(" "));
    }
  }

  async scheme(scheme: "light" | "dark"): Promise<void> {
    await this.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: scheme }] });
  }

  async go(url: string): Promise<void> {
    const loaded = new Promise<void>((resolve) => (this.loaded = resolve));
    const { errorText, loaderId } = await this.send("Page.navigate", { url });
    // Another part of the same document is there at once.
    if (loaderId === undefined) return;
    if (typeof errorText === "string" && errorText !== "") throw new Error(`${url}: ${errorText}`);
    await loaded;
  }

  /** The value of an expression in the page; promises are awaited. */
  async evaluate<T>(expression: string): Promise<T> {
    const { result, exceptionDetails } = (await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true, userGesture: true })) as {
      result: { value: T };
      exceptionDetails?: { text: string; exception?: { description?: string } };
    };
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Waits until an expression is true. */
  async until(expression: string, what = expression): Promise<void> {
    await this.waitFor(
      () => this.evaluate<boolean>(`Boolean(${expression})`),
      async () => `${what}; the page says:\n${(await this.evaluate<string>("document.body.innerText")).slice(-6000)}\n${this.complaints.join("\n")}`,
    );
  }

  /** Waits until a test has what it wants, for as long as a busy machine may take. */
  async waitFor(isThere: () => boolean | Promise<boolean>, what: () => string | Promise<string>): Promise<void> {
    const end = Date.now() + patience;
    while (!(await isThere())) {
      if (Date.now() > end) throw new Error(`not within ${patience / 1000} s: ${await what()}`);
      await new Promise((resolve) => setTimeout(resolve, 20));
    }
  }

  /** Waits for an element that can be seen and is covered by no other, and clicks it. */
  async click(selector: string): Promise<void> {
    const found = `document.querySelector(${JSON.stringify(selector)})`;
    await this.until(
      `(() => { const e = ${found}; if (!e || e.disabled) return false; e.scrollIntoView({ block: "center" }); const r = e.getBoundingClientRect(); const top = document.elementFromPoint(r.x + r.width / 2, r.y + r.height / 2); if (!top || !(e.contains(top) || top.contains(e))) return false; e.focus(); e.click(); return true; })()`,
      `a click on ${selector}`,
    );
  }

  /** Puts a text in place of what a field has. */
  async type(selector: string, text: string): Promise<void> {
    await this.until(`document.querySelector(${JSON.stringify(selector)})`, selector);
    await this.evaluate(`(() => { const e = document.querySelector(${JSON.stringify(selector)}); e.scrollIntoView({ block: "center" }); e.focus(); e.select(); })()`);
    await this.send("Input.insertText", { text });
  }

  async key(key: string, code = key): Promise<void> {
    const text = key.length === 1 ? { text: key } : key === "Enter" ? { text: "\r" } : {};
    await this.send("Input.dispatchKeyEvent", { type: "keyDown", key, code, windowsVirtualKeyCode: keyCodes[key] ?? 0, ...text });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", key, code, windowsVirtualKeyCode: keyCodes[key] ?? 0 });
  }

  /** Chooses a file in a field for files. */
  async choose(selector: string, file: string): Promise<void> {
    const { root } = (await this.send("DOM.getDocument")) as { root: { nodeId: number } };
    const { nodeId } = await this.send("DOM.querySelector", { nodeId: root.nodeId, selector });
    await this.send("DOM.setFileInputFiles", { nodeId, files: [file] });
  }

  async screenshot(file: string): Promise<void> {
    const { data } = await this.send("Page.captureScreenshot", { format: "png" });
    writeFileSync(file, Buffer.from(String(data), "base64"));
  }

  /** The picture of an element, in base64. */
  async pictureOf(selector: string): Promise<string> {
    const clip = await this.evaluate<Json>(`(() => { const { x, y, width, height } = document.querySelector(${JSON.stringify(selector)}).getBoundingClientRect(); return { x, y, width, height, scale: 1 }; })()`);
    return String((await this.send("Page.captureScreenshot", { format: "png", clip })).data);
  }

  async close(): Promise<void> {
    await this.browser.send("Target.closeTarget", { targetId: this.target });
  }
}

const keyCodes: Readonly<Record<string, number>> = { Enter: 13, ArrowDown: 40, ArrowUp: 38, ArrowLeft: 37, ArrowRight: 39, Tab: 9, Home: 36, End: 35, " ": 32 };
