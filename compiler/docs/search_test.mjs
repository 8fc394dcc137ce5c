// SPDX-License-Identifier: Apache-2.0
// The search box of pages: templates/script.js over as much of a document as it uses. Elements here
// have no innerHTML, so texts can reach a page as texts only.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import test from "node:test";
import vm from "node:vm";

const script = readFileSync(new URL("templates/script.js", import.meta.url), "utf8");

class Element {
  constructor(tag) {
    Object.assign(this, { tagName: tag, children: [], attributes: {}, listeners: {}, dataset: {} });
    Object.assign(this, { hidden: true, value: "", text: "", isFocused: false });
  }
  get textContent() { return this.text + this.children.map((one) => one.textContent).join("|"); }
  set textContent(text) {
    this.text = text;
    this.children = [];
  }
  appendChild(child) { this.children.push(child); }
  setAttribute(name, value) { this.attributes[name] = value; }
  removeAttribute(name) { delete this.attributes[name]; }
  addEventListener(name, listener) { this.listeners[name] = listener; }
  querySelectorAll(selector) {
    assert.equal(selector, "[data-address]");
    return this.children.filter((one) => one.dataset.address !== undefined);
  }
  closest() { return this.dataset.address === undefined ? null : this; }
  scrollIntoView() {}
  focus() { this.isFocused = true; }
  blur() { this.isFocused = false; }
  select() {}
  fire(name, event = {}) {
    let isPrevented = false;
    this.listeners[name]({ target: this, preventDefault: () => { isPrevented = true; }, ...event });
    return isPrevented;
  }
}

const arm = { page: "a.arm.html", name: "a.arm", entries: [
  ["definition", "a.arm", "", "Moves things."],
  ["object", "Arm", "Arm", ""],
  ["function", "Arm.move_to", "Arm.move_to", "Turns the <b>axes</b>."],
  ["property", "Arm.remove", "Arm.remove", ""]] };
const base = { page: "a.base.html", name: "a.base", entries: [
  ["struct", "Move", "Move", ""],
  ["field", "Move.x", "Move.x", "In metres."]] };

function open({ pages, own, isNarrow = false }) {
  const ids = {};
  for (const id of ["_search", "_box", "_results", "_count"]) ids[id] = new Element("div");
  ids._box.tagName = "INPUT";
  ids._own = own && new Element("script");
  if (own) ids._own.text = JSON.stringify(own);
  const contents = { open: true };
  const document = new Element("html");
  document.getElementById = (id) => ids[id] ?? null;
  document.createElement = (tag) => new Element(tag);
  document.querySelectorAll = () => [contents];
  const window = { robdefPages: pages, location: { href: "" }, matchMedia: () => ({ matches: isNarrow }) };
  vm.runInNewContext(script, { window, document, JSON });
  const names = () => ids._results.children.map((one) => one.children[0]?.textContent ?? one.text);
  const type = (text) => {
    ids._box.value = text;
    ids._box.fire("input");
    return names();
  };
  return { ...ids, box: ids._box, results: ids._results, document, window, contents, type };
}

test("better matches of names come first, then words of documentation", () => {
  const page = open({ pages: [arm, base] });
  assert.equal(page._search.hidden, false);
  assert.deepEqual(page.type("move"), ["Move", "Arm.move_to", "Move.x", "Arm.remove", "a.arm"]);
  assert.deepEqual(page.type("METRES"), ["Move.x"]);
  assert.deepEqual(page.type("a.arm.arm"), ["Arm", "Arm.remove", "Arm.move_to"]);
  assert.equal(page._count.textContent, "3 results");
});

test("all words must be found", () => {
  const page = open({ pages: [arm, base] });
  assert.deepEqual(page.type("arm turns"), ["Arm.move_to"]);
  assert.deepEqual(page.type("arm metres"), ["Nothing is found."]);
  assert.equal(page.results.querySelectorAll("[data-address]").length, 0);
});

test("texts of definitions stay texts", () => {
  const page = open({ pages: [arm] });
  page.type("move_to");
  assert.deepEqual(page.results.children[0].children.map((one) => one.textContent),
    ["Arm.move_to", "function in a.arm", "Turns the <b>axes</b>."]);
});

test("arrow keys select, round the ends, and Enter opens", () => {
  const page = open({ pages: [arm, base] });
  page.type("move");
  assert.equal(page.box.attributes["aria-activedescendant"], "_result0");
  assert.equal(page.box.fire("keydown", { key: "ArrowUp" }), true);
  assert.equal(page.box.attributes["aria-activedescendant"], "_result4");
  page.box.fire("keydown", { key: "ArrowDown" });
  page.box.fire("keydown", { key: "ArrowDown" });
  assert.equal(page.results.children[1].attributes["aria-selected"], "true");
  assert.equal(page.results.children[0].attributes["aria-selected"], "false");
  page.box.fire("keydown", { key: "Enter" });
  assert.equal(page.window.location.href, "a.arm.html#Arm.move_to");
  assert.equal(page.results.hidden, true);
});

test("Escape closes the list, and other keys are left to the box", () => {
  const page = open({ pages: [arm] });
  page.type("arm");
  assert.equal(page.box.attributes["aria-expanded"], "true");
  assert.equal(page.box.fire("keydown", { key: "x" }), false);
  page.box.fire("keydown", { key: "Escape" });
  assert.equal(page.results.hidden, true);
  assert.equal(page.box.attributes["aria-expanded"], "false");
});

test("a click opens a result", () => {
  const page = open({ pages: [arm] });
  page.type("arm");
  page.results.fire("mousedown", { target: page.results });
  assert.equal(page.window.location.href, "");
  page.results.fire("mousedown", { target: page.results.children[0] });
  assert.equal(page.window.location.href, "a.arm.html#Arm");
});

test("a slash focuses the box, but not while somebody types", () => {
  const page = open({ pages: [arm] });
  assert.equal(page.document.fire("keydown", { key: "/", target: page.box }), false);
  assert.equal(page.box.isFocused, false);
  assert.equal(page.document.fire("keydown", { key: "/", ctrlKey: true }), false);
  assert.equal(page.document.fire("keydown", { key: "/" }), true);
  assert.equal(page.box.isFocused, true);
});

test("a page alone searches itself, and the index alone has no box", () => {
  assert.deepEqual(open({ own: arm }).type("remove"), ["Arm.remove"]);
  assert.equal(open({})._search.hidden, true);
});

test("navigation is folded on phones only", () => {
  assert.equal(open({ pages: [arm] }).contents.open, true);
  assert.equal(open({ pages: [arm], isNarrow: true }).contents.open, false);
});
