// SPDX-License-Identifier: Apache-2.0
// node live.main.mjs URL...: connects the page in Chromium to services of any library, says what it finds of each, and
// reads all of their properties. A user and password may be given by ROBDEF_LIVE_USER=name:password.
import { address, clickText, connect, pause } from "./page_steps.js";
import { Chromium } from "./chromium.js";

const urls = process.argv.slice(2);
const [user = "", password = ""] = (process.env.ROBDEF_LIVE_USER ?? "").split(":");
const browser = new Chromium();
/** Time for properties to be asked for once. */
const settle = 3000;

for (const url of urls) {
  await browser.with(address, {}, async (page) => {
    await connect(page, url);
    await page.until("document.querySelector('.object, .links button, .failure .login, .failure')", url);
    if (user !== "" && (await page.evaluate<boolean>("document.querySelector('.failure .login') !== null"))) {
      await page.type(".failure [name=user]", user);
      await page.type(".failure [name=password]", password);
      await page.key("Enter");
      await page.until("document.querySelector('.object') || /AuthenticationError/.test(document.querySelector('.failure')?.innerText)");
    }
    await pause(settle);
    const found = await page.evaluate<unknown>(`(() => {
      const members = [...document.querySelectorAll("[data-member]")];
      return {
        failure: document.querySelector(".failure")?.innerText,
        services: [...document.querySelectorAll(".links li")].map((one) => one.innerText),
        objects: document.querySelectorAll("[role=treeitem]").length,
        members: members.length,
        values: members.filter((one) => one.querySelector(".current .value:not(.none)")).length,
        problems: members.filter((one) => one.querySelector(".problem")).map((one) => one.dataset.member + ": " + one.querySelector(".problem").innerText),
      };
    })()`);
    console.log(url, JSON.stringify(found, undefined, 1));
    if (page.complaints.length > 0) console.log(page.complaints.join("\n"));
    if (await page.evaluate<boolean>("document.querySelector('.device-head') !== null")) await clickText(page, ".device-head button", "Disconnect");
  });
}
await browser.close();
