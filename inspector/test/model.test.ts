// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import { Definitions, ErrorCode, makeErrorForTests } from "./runtime.js";
import { wordsOf } from "../src/model/errors.js";
import { emptyLayout, layoutText, readLayout, type Layout } from "../src/model/layout.js";
import { declarationOf, unitIn } from "../src/model/members.js";
import { forgetUrl, recentUrls, rememberUrl } from "../src/model/recent.js";
import { isPictureType, pictureOf, type Picture } from "../src/picture/picture.js";
import { chainPoints, shapesOf } from "../src/scene/poses.js";
import { workshopText } from "./workshop.js";

const definitions = new Definitions([workshopText]);

describe("A layout", () => {
  const layout: Layout = {
    urls: ["rr+ws://h:1/?service=a"],
    selected: { url: "rr+ws://h:1/?service=a", steps: [{ objref: "tools", index: 2 }, { objref: "named", index: "a b#&%" }] },
    panels: [{ kind: "plot", places: [{ url: "rr+ws://h:1/?service=a", steps: [], member: "speed" }], hidden: ["x:y"], seconds: 30 }],
  };

  it("is read from the URL as it was written", () => {
    const steps = JSON.parse(JSON.stringify(layout)) as Layout;
    assert.deepEqual(readLayout(`#${layoutText(layout)}`), steps);
    assert.equal(layoutText(emptyLayout), "");
  });

  it("of a short link is a URL, or several", () => {
    assert.deepEqual(readLayout("#url=rr+ws://h:1/?service=a"), { urls: ["rr+ws://h:1/?service=a"], panels: [] });
    assert.deepEqual(readLayout(`#url=${encodeURIComponent("rr+ws://h:1/?nodename=b&service=a")}&url=h:2`).urls, ["rr+ws://h:1/?nodename=b&service=a", "h:2"]);
  });

  it("that is none is empty, whatever is in it", () => {
    for (const hash of ["", "#", "#l=", "#l={", "#l=%7B%7D", "#l=null", "#l=[1]", `#l=${encodeURIComponent('{"urls":[1],"panels":[{"kind":"script"}],"selected":{"url":5}}')}`, `#${"x".repeat(100_000)}`]) {
      assert.deepEqual(readLayout(hash), emptyLayout, hash.slice(0, 60));
    }
  });
});

describe("Recent URLs", () => {
  const storage = (content: string | null): { getItem: () => string | null; setItem: (key: string, value: string) => void; content: () => string | null } => {
    let kept = content;
    return { getItem: () => kept, setItem: (_key, value) => void (kept = value), content: () => kept };
  };

  it("are there once, the newest first, and not too many", () => {
    const kept = storage(null);
    for (let i = 0; i < 20; ++i) rememberUrl(kept, `u${i}`);
    rememberUrl(kept, "u15");
    assert.equal(recentUrls(kept).length, 12);
    assert.deepEqual(recentUrls(kept).slice(0, 3), ["u15", "u19", "u18"]);
    assert.ok(!forgetUrl(kept, "u19").includes("u19"));
  });

  it("need no storage, and take no other content for a list", () => {
    assert.deepEqual(recentUrls(undefined), []);
    assert.deepEqual(recentUrls(storage("{}")), []);
    assert.deepEqual(recentUrls(storage("[1,\"a\"]")), ["a"]);
    assert.deepEqual(recentUrls(storage("no JSON")), []);
  });
});

describe("Errors", () => {
  it("have the name of the definition, and a hint where there is one", () => {
    const jammed = wordsOf(makeErrorForTests(ErrorCode.RemoteError, "stuck", { errorName: "experimental.workshop.Jammed", subname: "belt" }));
    assert.deepEqual(jammed, { name: "Jammed", text: "stuck [belt]" });
    assert.match(wordsOf(makeErrorForTests(ErrorCode.ObjectLockedError, "locked")).hint ?? "", /unlock/);
    assert.deepEqual(wordsOf(new TypeError("x")), { name: "Error", text: "x" });
  });
});

describe("Members", () => {
  it("are declared as definitions write them", () => {
    const bench = definitions.object("experimental.workshop.Bench");
    const of = (name: string): string => declarationOf(bench.members.get(name)!);
    assert.equal(of("settings"), "Settings settings");
    assert.equal(of("add"), "double add(double a, double b)");
    assert.equal(of("count"), "int32{generator} count(int32 limit)");
    assert.equal(of("scale"), "double{generator} scale(double factor, double{generator} step)");
    assert.equal(of("moved"), "moved(double to, string why)");
    assert.equal(of("named_tools"), "Tool{string} named_tools");
  });

  it("have the units that their docs tell, and no others", () => {
    for (const [doc, unit] of [["How fast [m/s].", "m/s"], ["In radians; the first three", "rad"], ["The force, in newtons.", "N"], ["Speed in metres per second.", "m/s"], ["Angle (deg)", "deg"], ["In the order of the file (see below)", ""], ["A list [of names]", ""], ["", ""], ["in use", ""]] as const) {
      assert.equal(unitIn(doc), unit, doc);
    }
  });
});

describe("A picture", () => {
  const record = (fields: readonly (readonly [string, string])[]): Definitions => new Definitions([`service a.b\nstdver 0.10\nstruct P\n${fields.map(([type, name]) => `field ${type} ${name}`).join("\n")}\nend\n`]);
  const bitmap = record([["int32", "width"], ["int32", "height"], ["uint8[]", "data"]]).type("a.b.P");

  function pixels(value: unknown): Extract<Picture, { kind: "pixels" }> {
    const picture = pictureOf(bitmap, value);
    assert.ok(picture && !(picture instanceof Error) && picture.kind === "pixels", String(picture));
    return picture;
  }

  it("of width, height and data is decoded by the bytes of a pixel", () => {
    assert.ok(isPictureType(bitmap));
    assert.deepEqual([...pixels({ width: 2, height: 1, data: Uint8Array.of(1, 2, 3, 4, 5, 6) }).rgba], [1, 2, 3, 255, 4, 5, 6, 255]);
    assert.deepEqual([...pixels({ width: 1, height: 2, data: Uint8Array.of(0, 200) }).rgba], [0, 0, 0, 255, 200, 200, 200, 255]);
  });

  it("that is none says why", () => {
    for (const value of [{ width: 2, height: 2, data: Uint8Array.of(1) }, { width: -1, height: 2, data: Uint8Array.of(1) }, { width: 1e9, height: 1e9, data: Uint8Array.of(1) }]) {
      assert.ok(pictureOf(bitmap, value) instanceof Error);
    }
    assert.equal(pictureOf(definitions.type("double"), 1), undefined);
  });

  it("that is a file is known by how it begins", () => {
    const picture = pictureOf(bitmap, { width: 0, height: 0, data: Uint8Array.of(0xff, 0xd8, 0xff, 0xe0) });
    assert.equal(picture && "mime" in picture && picture.mime, "image/jpeg");
  });

  it("of each encoding has its colors", () => {
    const image = new Definitions(["service com.robotraconteur.image\nstdver 0.10\nenum E\na = 0\nend\nstruct ImageInfo\nfield uint32 height\nfield uint32 width\nfield uint32 step\nfield E encoding\nend\nstruct Image\nfield ImageInfo image_info\nfield uint8[] data\nend\n"]).type("com.robotraconteur.image.Image");
    const first = (encoding: number, data: Uint8Array, step = 0): number[] => {
      const picture = pictureOf(image, { image_info: { height: 2, width: 2, step, encoding }, data });
      assert.ok(picture && !(picture instanceof Error) && picture.kind === "pixels", `${encoding.toString(16)}: ${String(picture)}`);
      return [...picture.rgba.slice(0, 4)];
    };
    const bytes = (length: number): Uint8Array => Uint8Array.from({ length }, (_, i) => i + 1);
    assert.deepEqual(first(0x1000, bytes(12)), [1, 2, 3, 255]);
    assert.deepEqual(first(0x1002, bytes(12)), [3, 2, 1, 255]);
    assert.deepEqual(first(0x1001, bytes(16)), [1, 2, 3, 4]);
    assert.deepEqual(first(0x1003, bytes(16)), [3, 2, 1, 4]);
    assert.deepEqual(first(0x1004, bytes(32)), [2, 4, 6, 8]);
    assert.deepEqual(first(0x2000, bytes(6), 3), [1, 1, 1, 255]);
    assert.deepEqual(first(0x3000, Uint8Array.of(200, 100, 50, 25)), [200, 75, 25, 255]);
    assert.deepEqual(first(0x4000, new Uint8Array(Uint16Array.of(0, 1000, 2000, 500).buffer)), [0, 0, 0, 255]);
    assert.deepEqual(first(0x4006, new Uint8Array(Float32Array.of(2, 1, 0, 1).buffer)), [255, 255, 255, 255]);
    assert.ok(pictureOf(image, { image_info: { height: 2, width: 2, step: 0, encoding: 0x5000 }, data: bytes(12) }) instanceof Error);
    assert.ok(pictureOf(image, { image_info: null, data: bytes(12) }) instanceof Error);
  });
});

describe("A pose", () => {
  const geometry = new Definitions(["service com.robotraconteur.geometry\nstdver 0.10\nnamedarray Point\nfield double x\nfield double y\nfield double z\nend\nnamedarray Quaternion\nfield double w\nfield double x\nfield double y\nfield double z\nend\nnamedarray Pose\nfield Quaternion orientation\nfield Point position\nend\n"]);

  it("is found inside of lists and rows", () => {
    const pose = { orientation: { w: 0, x: 0, y: 0, z: 0 }, position: { x: 1, y: 2, z: 3 } };
    assert.deepEqual(shapesOf(geometry.type("com.robotraconteur.geometry.Pose[]"), [pose], "a"), [{ kind: "pose", label: "a[0]", position: [1, 2, 3], orientation: [1, 0, 0, 0] }]);
    assert.deepEqual(shapesOf(geometry.type("com.robotraconteur.geometry.Point{list}"), [pose.position], "p"), [{ kind: "point", label: "p[0]", position: [1, 2, 3] }]);
  });

  it("of a chain follows its joints", () => {
    const chain = { axes: [[0, 0, 1], [1, 0, 0]] as const, offsets: [[0, 0, 1], [1, 0, 0], [1, 0, 0]] as const, joints: [0, 1], slides: [false, true] };
    const near = (found: readonly (readonly number[])[], wanted: readonly (readonly number[])[]): void => {
      assert.equal(found.length, wanted.length);
      found.forEach((point, i) => { point.forEach((one, j) => { assert.ok(Math.abs(one - (wanted[i]?.[j] ?? NaN)) < 1e-9, `${String(found)} instead of ${String(wanted)}`); }); });
    };
    near(chainPoints(chain, [0, 0]), [[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1]]);
    near(chainPoints(chain, [Math.PI / 2, 0.5]), [[0, 0, 0], [0, 0, 1], [0, 1, 1], [0, 2.5, 1]]);
  });
});

