// SPDX-License-Identifier: Apache-2.0
// Devices and links that try to become HTML or scripts, and what the file's policy stops.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import type { AddressInfo } from "node:net";
import { describe, it } from "node:test";
import { RRNode } from "@robdef/runtime/node";
import { indexName, makeIndex, type Service } from "./runtime.js";
import { address, allowed, choose, clickText, connect, faultsInBoth, pageFile, startBoth, submit, text } from "./page_steps.js";
import type { Page } from "./chromium.js";
import { hostileName, startWorkshop } from "./workshop.js";

const both = startBoth();

/** Waits for so many complaints about the policy. */
async function complained(page: Page, count: number): Promise<void> {
  await page.waitFor(() => page.complaints.filter((one) => /Content Security Policy/.test(one)).length >= count, () => `${count} complaints about the policy; there are:\n${page.complaints.join("\n")}`);
}
const quoted = JSON.stringify(hostileName);
/** Elements that only a text that became HTML could have made. */
const foreign = "document.querySelectorAll('img, svg, iframe, object, embed, a[href^=\"javascript:\"], main script').length + document.querySelectorAll('script').length - 2";

describe("Hostile texts", allowed, () => {
  it("of names, docs, values and errors stay texts", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, both.workshop.url("trap"));
      await page.until("document.querySelector('[data-member=texts] .current .value:not(.none)')");
      await page.until("document.querySelector('[data-member=text] .current').innerText.includes('onerror')");
      both.workshop.trap.event("alarm").fire(hostileName);
      await page.until("document.querySelector('[data-member=alarm] .events')?.innerText.includes('onerror')");
      await page.click("[aria-label='Edit text']");
      await submit(page, "[data-member=text] form");
      await page.until(`document.querySelector('[data-member=text] .problem')?.innerText.includes(${quoted})`);
      await page.click("[aria-label='Edit bait']");
      await page.until("document.querySelector('[data-member=bait] form label')");
      await page.click("[aria-label='Call shout with…']");
      await submit(page, "[data-member=shout] form");
      await page.until("document.querySelector('[data-member=shout] .result')?.innerText.includes('onerror')");
      await page.type("[data-member=inner] input", hostileName);
      await submit(page, "[data-member=inner] form");
      await page.until(`document.querySelector('.object-head h2')?.innerText.includes(${quoted})`);
      for (const language of ["cpp", "csharp", "matlab", "typescript", "shell"]) {
        await choose(page, ".log select", language);
        await page.click(".log .entries button");
      }
      // The layout with these names, in another page.
      const link = await page.evaluate<string>("location.href");
      assert.equal(await page.evaluate("globalThis.pwned"), undefined);
      assert.equal(await page.evaluate(foreign), 0);
      assert.deepEqual(await faultsInBoth(page), []);
      assert.deepEqual(page.complaints, []);
      await both.browser.with(link, {}, async (again) => {
        await again.until(`document.querySelector('.object-head h2')?.innerText.includes(${quoted})`);
        assert.equal(await again.evaluate("globalThis.pwned"), undefined);
        assert.equal(await again.evaluate(foreign), 0);
        assert.deepEqual(again.complaints, []);
      });
    }));

  it("of services in a node's list stay texts", async () => {
    // No node of ours lets such names be registered.
    const node = new RRNode({ name: "experimental.hostile" });
    const service = { name: hostileName, root: { type: { name: hostileName, implements: [] } }, attributes: new Map() } as unknown as Service;
    const index = makeIndex({ id: node.id, services: () => [service], addressFor: () => hostileName });
    const inside = node as unknown as { offered: Map<string, unknown>; register: (name: string, root: unknown) => void };
    inside.offered.delete(indexName);
    inside.register(indexName, index);
    const port = await node.listen({ port: 0, webSocket: { allowLocalPages: true } });
    await both.browser.with(address, {}, async (page) => {
      try {
        await connect(page, `127.0.0.1:${port}`);
        await clickText(page, ".links button", hostileName);
        await page.until(`document.querySelector('.failure')?.innerText.includes('onerror')`);
        assert.equal(await page.evaluate("globalThis.pwned"), undefined);
        assert.equal(await page.evaluate(foreign), 0);
        assert.deepEqual(await faultsInBoth(page), []);
        assert.deepEqual(page.complaints, []);
      } finally {
        await node.close();
      }
    });
  });

  it("in links do nothing", async () => {
    for (const hash of ["#url=javascript:globalThis.pwned=1", `#url=${encodeURIComponent(hostileName)}`, `#l=${encodeURIComponent(JSON.stringify({ urls: [hostileName], panels: [{ kind: hostileName, places: [] }] }))}`]) {
      await both.browser.with(address + hash, {}, async (page) => {
        await page.until("document.querySelector('.failure')");
        assert.equal(await page.evaluate("globalThis.pwned"), undefined);
        assert.equal(await page.evaluate(foreign), 0);
      });
    }
  });

  it("that would be a script are stopped by the policy of the file", () =>
    both.browser.with(address, {}, async (page) => {
      await page.until("document.querySelector('.welcome')");
      await page.evaluate("(() => { document.body.insertAdjacentHTML('beforeend', '<img src=x onerror=\"globalThis.pwned=1\"><a href=\"javascript:globalThis.pwned=3\" id=trap>x</a>'); const s = document.createElement('script'); s.textContent = 'globalThis.pwned=2'; document.head.append(s); document.querySelector('#trap').click(); })()");
      await complained(page, 3);
      assert.equal(await page.evaluate("globalThis.pwned"), undefined);
      const policy = /Content-Security-Policy" content="([^"]*)"/.exec(readFileSync(pageFile, "utf8"))?.[1] ?? "";
      assert.match(policy, /^default-src 'none'; script-src 'sha256-[^ ]+' 'sha256-[^ ]+'; style-src 'sha256-/);
      assert.doesNotMatch(policy, /unsafe/);
    }));

  it("cannot leave by pictures, frames or forms", () =>
    both.browser.with(address, {}, async (page) => {
      await page.until("document.querySelector('.welcome')");
      const asked: string[] = [];
      const server = createServer((request, answer) => {
        asked.push(request.url ?? "");
        answer.end("");
      });
      await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
      const to = `http://127.0.0.1:${(server.address() as AddressInfo).port}`;
      try {
        await page.evaluate(`document.body.insertAdjacentHTML("beforeend", '<img src="${to}/img"><iframe src="${to}/frame"></iframe><link rel="stylesheet" href="${to}/style"><form id="out" action="${to}/form"></form>'); document.querySelector("#out").submit();`);
        await complained(page, 4);
        assert.deepEqual(asked, []);
      } finally {
        server.closeAllConnections();
        server.close();
      }
    }));
});

describe("Origins", allowed, () => {
  it("that a node does not know are refused, with what would let them in", async () => {
    const html = readFileSync(pageFile);
    const server = createServer((_request, answer) => {
      answer.setHeader("Content-Type", "text/html; charset=utf-8");
      answer.end(html);
    });
    await new Promise<void>((resolve) => server.listen(0, "127.0.0.1", resolve));
    const origin = `http://127.0.0.1:${(server.address() as AddressInfo).port}`;
    const known = await startWorkshop({ origins: [origin] });
    try {
      await both.browser.with(`${origin}/`, {}, async (page) => {
        await page.until("document.querySelector('.welcome')");
        // A node that allows pages from disks does not allow those of servers.
        await connect(page, both.workshop.url("bench"));
        await page.until("document.querySelector('.failure')");
        assert.match(await text(page, ".failure"), /refuses this page/);
        assert.ok((await text(page, ".failure")).includes(`--robotraconteur-tcp-ws-add-origin=${origin}`), await text(page, ".failure"));
        await connect(page, known.url("bench"));
        await page.until("/0.25/.test(document.querySelector('[data-member=speed] .value')?.innerText)");
      });
      // A node that knows one server does not know pages from disks.
      await both.browser.with(address, {}, async (page) => {
        await connect(page, known.url("bench"));
        await page.until("/refuses this page/.test(document.querySelector('.failure')?.innerText)");
      });
    } finally {
      await known.close();
      server.closeAllConnections();
      server.close();
    }
  });
});
