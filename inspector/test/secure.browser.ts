// SPDX-License-Identifier: Apache-2.0
// The page over rr+wss: a proxy in front of the node has TLS and a certificate, which the browser trusts or not.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash, X509Certificate } from "node:crypto";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { connect as dial, type AddressInfo } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";
import { createServer, type Server } from "node:tls";
import { Chromium } from "./chromium.js";
import { address, allowed, connect, text } from "./page_steps.js";
import { startWorkshop, type Workshop } from "./workshop.js";

const folder = mkdtempSync(join(tmpdir(), "inspector-tls-"));
let workshop: Workshop;
let proxy: Server;
let certificate: Buffer;
let url: string;

before(async () => {
  workshop = await startWorkshop({ allowLocalPages: true });
  const [key, cert] = [join(folder, "key.pem"), join(folder, "cert.pem")];
  execFileSync("openssl", ["req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes", "-days", "2", "-subj", "/CN=localhost", "-addext", "subjectAltName=IP:127.0.0.1", "-keyout", key, "-out", cert], { stdio: "ignore" });
  certificate = readFileSync(cert);
  const port = Number(new URL(workshop.url("bench").replace(/^rr\+ws/, "http")).port);
  proxy = createServer({ key: readFileSync(key), cert: certificate }, (client) => {
    const node = dial(port, "127.0.0.1");
    const end = (): void => {
      client.destroy();
      node.destroy();
    };
    for (const one of [client, node]) one.on("error", end).on("close", end);
    client.pipe(node).pipe(client);
  });
  proxy.on("tlsClientError", () => undefined);
  await new Promise<void>((resolve) => { proxy.listen(0, "127.0.0.1", resolve); });
  url = `rr+wss://127.0.0.1:${(proxy.address() as AddressInfo).port}/?service=bench`;
});

after(async () => {
  proxy.close();
  await workshop.close();
  rmSync(folder, { recursive: true, force: true });
});

async function withBrowser(flags: readonly string[], use: (browser: Chromium) => Promise<void>): Promise<void> {
  const browser = new Chromium(undefined, "none", flags);
  try {
    await use(browser);
  } finally {
    await browser.close();
  }
}

describe("The page over rr+wss", allowed, () => {
  it("works like any other when the browser trusts the certificate", async () => {
    const key = new X509Certificate(certificate).publicKey.export({ type: "spki", format: "der" });
    const pin = createHash("sha256").update(key).digest("base64");
    await withBrowser([`--ignore-certificate-errors-spki-list=${pin}`], async (browser) => {
      await browser.with(address, {}, async (page) => {
        await connect(page, url);
        await page.until("document.querySelector('.object')");
        await page.click("[aria-label='Get speed']");
        await page.until("/\\d/.test(document.querySelector('[data-member=speed] .current')?.innerText)");
        assert.deepEqual(page.complaints, []);
      });
    });
  });

  it("says what to look at when it does not", async () => {
    await withBrowser([], async (browser) => {
      await browser.with(address, {}, async (page) => {
        await connect(page, url);
        await page.until("/trust the certificate/.test(document.querySelector('main').innerText)");
        const said = await text(page, "main");
        assert.match(said, new RegExp(`open https://127\\.0\\.0\\.1:${url.replace(/.*:(\d+)\/.*/, "$1")}/ once`));
      });
    });
  });
});
