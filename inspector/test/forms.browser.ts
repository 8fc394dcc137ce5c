// SPDX-License-Identifier: Apache-2.0
// The page in Chromium, used as a person does: connecting, forms, members of all kinds, login, keys, layout.
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { address, allowed, choose, clickText, connect, enter, faults, faultsInBoth, pause, shootBoth, startBoth, submit, text } from "./page_steps.js";
import { startWorkshop, workshopPassword, type Workshop } from "./workshop.js";

const both = startBoth();

describe("The page", allowed, () => {
  it("begins empty, in light and dark", () =>
    both.browser.with(address, {}, async (page) => {
      await page.until("document.querySelector('.welcome')");
      assert.match(await text(page, "main"), /Nothing was connected from this browser yet/);
      assert.deepEqual(await faultsInBoth(page), []);
      await shootBoth(page, "empty");
      await page.key("?", "Slash");
      await page.until("document.querySelector('.keys')");
      assert.deepEqual(await faultsInBoth(page), []);
      assert.deepEqual(page.complaints, []);
    }));

  it("says why it cannot connect", async () => {
    const closed = await startWorkshop();
    const refused = closed.url("bench");
    await both.browser.with(address, {}, async (page) => {
      try {
        await connect(page, refused);
        await page.until("/refuses this page[\\s\\S]*allow-local-pages/.test(document.querySelector('.failure')?.innerText)");
        assert.deepEqual(await faultsInBoth(page), []);
        await shootBoth(page, "refused");
      } finally {
        await closed.close();
      }
      await connect(page, refused);
      await page.until("/Nothing answers/.test(document.querySelector('.failure')?.innerText)");
      await connect(page, "rr+ws://127.0.0.1:6000/?service=a");
      await page.until("/Browsers refuse to connect to port 6000/.test(document.querySelector('.failure')?.innerText)");
      await connect(page, "rr+local:///?service=a");
      await page.until("/a page cannot open them/.test(document.querySelector('.failure')?.innerText)");
      await connect(page, both.workshop.url("nothing"));
      await page.until("/has no service of this name/.test(document.querySelector('.failure')?.innerText)");
      assert.deepEqual(await faultsInBoth(page), []);
    });
  });

  it("lists the services of a node, and remembers what was connected", async () => {
    await both.browser.with(address, {}, async (page) => {
      await connect(page, `127.0.0.1:${both.workshop.port}`);
      await page.until("document.querySelector('.links button')");
      assert.match(await text(page, "main"), /bench\s+Bench/);
      assert.deepEqual(await faultsInBoth(page), []);
      await shootBoth(page, "services");
      await clickText(page, ".links button", "trap");
      await page.until("document.querySelector('[data-member=texts]')");
    });
    await both.browser.with(address, {}, async (page) => {
      await page.until("/service=trap/.test(document.querySelector('[aria-label=\"Recent connections\"]')?.innerText)");
    });
  });

  it("shows objects, and sets properties by forms made from types", () =>
    both.browser.with(address, {}, async (page) => {
      const { state } = both.workshop;
      const firstSettings = state.settings;
      await connect(page, both.workshop.url("bench"));
      await page.until("document.querySelectorAll('[role=treeitem]').length === 5", "the bench and four tools");
      await page.until("/0.25 m\\/s/.test(document.querySelector('[data-member=speed]').innerText)");
      await page.until("/jog/.test(document.querySelector('[data-member=mode] .value')?.innerText)");
      await page.click("[aria-label='Edit speed']");
      await page.type("[data-member=speed] form input", "fast");
      await page.key("Enter");
      await page.until("/is no number/.test(document.querySelector('[data-member=speed] .problem')?.innerText)");
      assert.equal(state.speed, 0.25);
      await page.type("[data-member=speed] form input", "11");
      await page.key("Enter");
      await page.until("/OutOfRange[\\s\\S]*faster than 10/.test(document.querySelector('[data-member=speed]').innerText)");
      // It stays when the property has been read again.
      state.speed = 0.5;
      await page.until("/0.5 m\\/s/.test(document.querySelector('[data-member=speed] .current').innerText)");
      assert.match(await text(page, "[data-member=speed]"), /faster than 10/);
      assert.deepEqual(await faultsInBoth(page), []);
      await shootBoth(page, "error");
      await page.type("[data-member=speed] form input", "0.75");
      await page.key("Enter");
      await page.until("/0.75 m\\/s/.test(document.querySelector('[data-member=speed] .current').innerText)");
      assert.equal(state.speed, 0.75);
      // The event that this fires.
      await page.until("/to: 0.75, why: \"speed\"/.test(document.querySelector('[data-member=moved]').innerText)");
      await page.click("[aria-label='Edit settings']");
      await page.until("document.querySelector('[data-member=settings] .matrix input')");
      await shootBoth(page, "form");
      const form = "[data-member=settings] form";
      await page.type(`${form} [aria-label='matrix, row 1, column 2']`, "99");
      await choose(page, `${form} select`, "10");
      await submit(page, form);
      await page.until("/mode: automatic/.test(document.querySelector('[data-member=settings] .current').innerText)");
      const { matrix, mode, serial } = state.settings as { matrix: { array: Float64Array }; mode: number; serial: bigint };
      assert.deepEqual([...matrix.array], [11, 21, 12, 22, 13, 99]);
      assert.equal(mode, 10);
      assert.equal(serial, 9007199254740993n);
      assert.deepEqual(await faultsInBoth(page), []);
      // A field with a million numbers would block the page.
      state.settings = { ...(state.settings as object), bytes: new Uint8Array(1_000_000).fill(7) };
      await page.until("/1000000 items/.test(document.querySelector('[data-member=settings] .current').innerText) || /7, 7, 7/.test(document.querySelector('[data-member=settings] .current').innerText)");
      await page.click("[aria-label='Edit settings']");
      await page.until("!document.querySelector('[data-member=settings] form')");
      await page.click("[aria-label='Edit settings']");
      await page.until("/1000000 numbers, too many to edit here/.test(document.querySelector('[data-member=settings] form')?.innerText)");
      await choose(page, `${form} select`, "0");
      await submit(page, form);
      await page.until("/mode: idle/.test(document.querySelector('[data-member=settings] .current').innerText)");
      assert.equal((state.settings as { bytes: Uint8Array }).bytes.length, 1_000_000);
      state.settings = firstSettings;
      assert.deepEqual(page.complaints, []);
    }));

  it("calls functions, and says their errors", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, both.workshop.url("bench"));
      await page.click("[aria-label='Call add with…']");
      await enter(page, "add", "a", "2");
      await enter(page, "add", "b", "40");
      await page.key("Enter");
      await page.until("document.querySelector('[data-member=add] .result')?.innerText === '42'");
      await page.click("[aria-label='Call fail with…']");
      await enter(page, "fail", "how", "badly");
      await submit(page, "[data-member=fail] form");
      await page.until("/Jammed jammed: badly \\[belt\\]/.test(document.querySelector('[data-member=fail] .problem')?.innerText)");
      await page.click("[aria-label='Call slow with…']");
      await enter(page, "slow", "seconds", "3600");
      await page.key("Enter");
      await clickText(page, "[data-member=slow] button", "Stop waiting");
      await page.until("/stopped waiting/.test(document.querySelector('[data-member=slow] .problem')?.innerText)");
      assert.match(await text(page, ".log"), /call\s+add\s+\(2, 40\)\s+42/);
      await choose(page, ".log select", "cpp");
      await page.click("[aria-label='Copy call add as code']");
      await page.until("/object.call\\(\"add\", \\{2.0, 40.0\\}\\)/.test(document.querySelector('.log .code')?.innerText)");
      assert.deepEqual(await faults(page), []);
      assert.deepEqual(page.complaints, []);
    }));

  it("steps generators", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, both.workshop.url("bench"));
      await page.click("[aria-label='Step through count…']");
      await enter(page, "count", "limit", "3");
      await page.key("Enter");
      for (let i = 1; i <= 3; ++i) {
        await page.click("[data-member=count] .stepping .primary");
        await page.until(`document.querySelectorAll('[data-member=count] .steps li').length === ${i}`);
      }
      await page.click("[data-member=count] .stepping .primary");
      await page.until("/At its end after 3 steps/.test(document.querySelector('[data-member=count]').innerText)");
      // One that takes a value for each step.
      await page.click("[aria-label='Step through scale…']");
      await enter(page, "scale", "factor", "2.5");
      await page.key("Enter");
      await page.until("document.querySelector('[data-member=scale] .stepping input')");
      await page.type("[data-member=scale] .stepping input", "4");
      await page.click("[data-member=scale] .stepping .primary");
      await page.until("document.querySelector('[data-member=scale] .steps li')?.innerText.trim() === '10'");
      assert.deepEqual(await faults(page), []);
      assert.deepEqual(page.complaints, []);
    }));

  it("answers callbacks by hand", () =>
    both.browser.with(address, {}, async (page) => {
      const { bench } = both.workshop;
      await connect(page, both.workshop.url("bench"));
      await choose(page, "[aria-label='How advise is answered']", "ask");
      await page.until("/0 calls so far/.test(document.querySelector('[data-member=advise]').innerText)");
      const [client] = clientsOf(both.workshop);
      assert.ok(client !== undefined);
      // A service says in its own time that nobody answers; people take longer on a busy machine.
      const call = async (question: string): Promise<unknown> => {
        for (;;) {
          try {
            return await bench.callback("advise").call(client, [question], { timeout: 600_000 });
          } catch (error) {
            // What is drawn is ahead of what is set.
            if (!/not set/.test(String(error))) throw error;
            await pause(20);
          }
        }
      };
      const asked = call("left or right?");
      await page.until("/left or right/.test(document.querySelector('[data-member=advise] .question')?.innerText)");
      assert.deepEqual(await faults(page), []);
      await enter(page, "advise", "answer", "1.5");
      await page.key("Enter");
      assert.equal(await asked, 1.5);
      await choose(page, "[aria-label='How advise is answered']", "refuse");
      await page.until("!document.querySelector('[data-member=advise] .question')");
      await assert.rejects(call("and now?"), /refused by a rule/);
      assert.deepEqual(page.complaints, []);
    }));

  it("reads and writes memories, peeks and pokes wires, sends packets", () =>
    both.browser.with(address, {}, async (page) => {
      const { state } = both.workshop;
      await connect(page, both.workshop.url("bench"));
      await page.click("[aria-label='Read table']");
      await page.until("/400 items/.test(document.querySelector('[data-member=table]').innerText)");
      await page.click("[aria-label='Read picture']");
      await page.click("[data-member=picture] input[type=checkbox]");
      await page.until("document.querySelector('[data-member=picture] canvas')?.width === 48");
      await page.click("[aria-label='Peek position']");
      await page.until("/-?\\d/.test(document.querySelector('[data-member=position] .value')?.innerText)");
      await page.click("[aria-label='Poke demand…']");
      await enter(page, "demand", "demand", "7.5");
      await page.key("Enter");
      await page.until("/demand is sent/.test(document.querySelector('[aria-live]').innerText)");
      assert.equal(state.demand, 7.5);
      await page.click("[aria-label='Watch chat']");
      await page.until("/a second/.test(document.querySelector('[data-member=chat] .stream-state')?.innerText)");
      await page.click("[aria-label='Send chat…']");
      await page.type("[data-member=chat] form textarea", "hello");
      await submit(page, "[data-member=chat] form");
      await page.until("/echo hello/.test(document.querySelector('[data-member=chat] .value')?.innerText)");
      assert.deepEqual(state.chat, ["hello"]);
      assert.deepEqual(await faultsInBoth(page), []);
      assert.deepEqual(page.complaints, []);
    }));

  it("logs in, and shows and ends locks", () =>
    both.browser.with(address, {}, async (page) => {
      await connect(page, both.workshop.url("guarded"));
      await page.until("document.querySelector('.failure .login')");
      assert.deepEqual(await faultsInBoth(page), []);
      await shootBoth(page, "login");
      await page.type(".failure [name=user]", "alice");
      await page.type(".failure [name=password]", "wrong");
      await page.key("Enter");
      await page.until("/AuthenticationError/.test(document.querySelector('.failure')?.innerText)");
      await page.type(".failure [name=user]", "alice");
      await page.type(".failure [name=password]", workshopPassword);
      await page.key("Enter");
      await page.until("/as alice/.test(document.querySelector('.device-head')?.innerText)");
      await clickText(page, ".locks button", "Lock for alice");
      await page.until("/locked by this user/.test(document.querySelector('.locks').innerText)");
      assert.match(await text(page, "nav"), /locked/);
      assert.deepEqual(await faultsInBoth(page), []);
      await clickText(page, ".locks button", "Unlock");
      await page.until("!/locked/.test(document.querySelector('nav').innerText)");
      assert.ok(!(await page.evaluate<string>("location.href + JSON.stringify(localStorage) + document.documentElement.outerHTML")).includes(workshopPassword));
    }));

  it("says when a service is lost", async () => {
    const other = await startWorkshop({ allowLocalPages: true });
    await both.browser.with(address, {}, async (page) => {
      try {
        await connect(page, other.url("bench"));
        await page.until("/0.25/.test(document.querySelector('[data-member=speed] .value')?.innerText)");
      } finally {
        await other.close();
      }
      await page.until("/lost/.test(document.querySelector('.device-head .state')?.innerText)");
      assert.deepEqual(await faultsInBoth(page), []);
      await shootBoth(page, "lost");
      await clickText(page, ".device-head button", "Connect again");
      await page.until("/Nothing answers/.test(document.querySelector('.failure')?.innerText)");
      assert.deepEqual(await faultsInBoth(page), []);
    });
  });

  it("is used by the keyboard alone", () =>
    both.browser.with(address, {}, async (page) => {
      await page.until("document.querySelector('.welcome')");
      // The page listens for keys once it is drawn.
      while (!(await page.evaluate<boolean>("document.activeElement.id === 'address'"))) await page.key("/", "Slash");
      await page.evaluate("document.activeElement.select()");
      await page.send("Input.insertText", { text: both.workshop.url("bench") });
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
      // Tab goes from the tree to all that can be used, and every stop is seen.
      for (let i = 0; i < 12; ++i) {
        await page.key("Tab");
        assert.ok(await page.evaluate<boolean>("document.activeElement !== document.body && document.activeElement.getClientRects().length > 0"), `stop ${i}`);
      }
    }));

  it("keeps its layout in its URL", async () => {
    let url = "";
    await both.browser.with(address, {}, async (page) => {
      await connect(page, both.workshop.url("bench"));
      await page.click("[aria-label='Plot position']");
      await page.until("document.querySelector('.legend li')");
      await clickText(page, ".tree .title", "tools[1]");
      await page.until("/tools/.test(decodeURIComponent(location.hash))");
      url = await page.evaluate<string>("location.href");
    });
    await both.browser.with(url, {}, async (page) => {
      await page.until("document.querySelector('.object-head h2')?.innerText === 'tools[1]'");
      await page.until("document.querySelector('.legend li')");
    });
  });

  it("fits a small window", () =>
    both.browser.with(address, { width: 420, height: 800 }, async (page) => {
      const fits = "document.documentElement.scrollWidth <= innerWidth";
      await page.until("document.querySelector('.welcome')");
      assert.ok(await page.evaluate<boolean>(fits), "the empty page");
      await connect(page, both.workshop.url("bench"));
      await page.until("document.querySelector('[data-member=settings] .value')");
      await page.click("[aria-label='Edit settings']");
      await page.click("[aria-label='Plot position']");
      await page.until("document.querySelector('.legend li')");
      assert.ok(await page.evaluate<boolean>(fits), "with a form and a plot");
      assert.deepEqual(await faults(page), []);
      await shootBoth(page, "small");
    }));
});

function clientsOf({ bench }: Workshop): number[] {
  const services = [...bench.places.values()] as unknown as { clients: ReadonlyMap<number, unknown> }[];
  // The page of this test is the newest.
  return services.flatMap(({ clients }) => [...clients.keys()]).reverse();
}
