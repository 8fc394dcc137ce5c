// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import fc from "fast-check";
import { Definitions, MultiDimArray } from "@robdef/runtime";
import { csvOf } from "../src/export/csv.js";
import { matOf } from "../src/export/mat.js";
import { channelsOf, deviceTime } from "../src/plot/channels.js";
import { PlotModel } from "../src/plot/plot_model.js";
import { Series } from "../src/plot/series.js";
import { workshopText } from "./workshop.js";

const definitions = new Definitions([workshopText]);

/** What columns should be, looked at point by point. */
function slowColumns(series: Series, from: number, to: number, count: number): (readonly [number, number] | null)[] {
  const width = (to - from) / count;
  return Array.from({ length: count }, (_, column) => {
    const begin = column === 0 ? from : from + column * width;
    const end = from + (column + 1) * width;
    let low = Infinity;
    let high = -Infinity;
    for (let i = 0; i < series.length; ++i) {
      const time = series.timeAt(i);
      const isInside = time >= begin && (column === count - 1 ? time <= to : time < end);
      if (!isInside) continue;
      low = Math.min(low, series.valueAt(i));
      high = Math.max(high, series.valueAt(i));
    }
    return low === Infinity ? null : ([low, high] as const);
  });
}

describe("A series", () => {
  it("has columns with the lowest and highest of their points", () => {
    fc.assert(
      fc.property(fc.array(fc.tuple(fc.integer({ min: 0, max: 5 }), fc.integer({ min: -100, max: 100 })), { maxLength: 700 }), fc.integer({ min: 1, max: 40 }), fc.boolean(), (points, count, isSmall) => {
        const series = new Series(isSmall ? { keep: 0, most: 4096 } : {});
        let time = 0;
        // The ring goes round first, so that blocks are used again.
        for (let i = 0; i < (isSmall ? 4000 : 0); ++i) series.push(0, 0);
        for (const [step, value] of points) series.push((time += step), value);
        const out: (number | null)[] = [];
        const to = Math.max(1, time);
        series.columns(0.5, to, count, out);
        const expected = slowColumns(series, 0.5, to, count);
        for (let i = 0; i < count; ++i) {
          const [a, b] = [out[2 * i] ?? null, out[2 * i + 1] ?? null];
          const found = a === null || b === null ? null : [Math.min(a, b), Math.max(a, b)];
          assert.deepEqual(found, expected[i], `column ${i} of ${count}`);
        }
      }),
      { numRuns: 300 },
    );
  });

  it("keeps the newest points, and no more than it may", () => {
    const series = new Series({ keep: 10, most: 8192 });
    for (let i = 0; i < 100_000; ++i) series.push(i, i);
    assert.equal(series.length, 4096);
    assert.equal(series.lastValue, 99_999);
    assert.equal(series.firstTime, 99_999 - 4095);
    const fast = new Series({ keep: 10, most: 8192 });
    for (let i = 0; i < 100_000; ++i) fast.push(i / 10_000, i);
    assert.equal(fast.length, 8192);
  });

  it("finds the nearest point and slices by time", () => {
    const series = new Series();
    for (let i = 0; i < 10; ++i) series.push(i, i * i);
    assert.deepEqual(series.nearest(3.4), { time: 3, value: 9 });
    assert.deepEqual(series.nearest(3.6), { time: 4, value: 16 });
    assert.deepEqual([...series.slice(2, 4).values], [4, 9, 16]);
    assert.equal(new Series().nearest(1), undefined);
  });

  it("takes a time that goes back as the last one", () => {
    const series = new Series();
    series.push(5, 1);
    series.push(3, 2);
    assert.equal(series.lastTime, 5);
    assert.equal(series.length, 2);
  });

  // How long it takes is measured in a browser (browser_speed.main.ts): a busy machine says nothing about it.
  it("shows a window of a million points by the extremes of each column", () => {
    const series = new Series({ keep: 1_000_000, most: 1 << 20 });
    const wave = (i: number): number => Math.sin(i / 1000) + (i % 7) / 10;
    for (let i = 0; i < 1_000_000; ++i) series.push(i, wave(i));
    assert.equal(series.length, 1_000_000);
    const out: (number | null)[] = [];
    series.columns(0, 1_000_000, 800, out);
    assert.equal(out.length, 1600);
    for (const column of [0, 1, 399, 798]) {
      const points = Array.from({ length: 1250 }, (_, i) => wave(column * 1250 + i));
      const shown = [out[2 * column] ?? NaN, out[2 * column + 1] ?? NaN];
      assert.equal(Math.min(...shown), Math.min(...points));
      assert.equal(Math.max(...shown), Math.max(...points));
    }
  });
});

describe("Channels", () => {
  const vec = { x: 1, y: 2, z: 3 };

  it("are the numbers of a record, with their names", () => {
    const channels = channelsOf(definitions.type("experimental.workshop.Vec[]"), [vec, vec]);
    assert.deepEqual(channels.map((one) => one.label), ["[0].x", "[0].y", "[0].z", "[1].x", "[1].y", "[1].z"]);
    assert.equal(channels[4]?.get([vec, { x: 7, y: 8, z: 9 }]), 8);
    assert.ok(Number.isNaN(channels[4].get([vec])));
  });

  it("leave texts and containers out", () => {
    const type = definitions.type("experimental.workshop.Settings");
    const value = { width: 1, mode: 10, label: "x", enabled: true, serial: 5n, bytes: new Uint8Array(2), matrix: new MultiDimArray([2, 3], new Float64Array(6)), block: new MultiDimArray([0, 0], new Float64Array(0)), place: vec, samples: [], notes: null, counts: null, path: null, anything: null };
    const channels = channelsOf(type, value);
    assert.deepEqual(channels.map((one) => one.label).filter((label) => !label.startsWith("matrix")), ["width", "mode", "enabled", "serial", "bytes[0]", "bytes[1]", "place.x", "place.y", "place.z"]);
    assert.equal(channels.find((one) => one.label === "serial")?.get(value), 5);
  });

  it("of long rows are samples between the times", () => {
    const model = new PlotModel();
    const lines = model.source({ key: "k", label: "waves", unit: "", type: definitions.type("double[]") });
    lines.take(new Float64Array(100), 1);
    lines.take(Float64Array.from({ length: 100 }, (_, i) => i), 2);
    const series = lines.lines[0]?.series;
    assert.equal(series?.length, 200);
    assert.equal(series.lastTime, 2);
    assert.ok(Math.abs(series.timeAt(100) - 1.01) < 1e-9);
  });

  it("know the device's time inside of values", () => {
    assert.equal(deviceTime({ ts: { seconds: 5n, nanoseconds: 500_000_000 } }), 5.5);
    assert.equal(deviceTime({ data_header: { ts: { seconds: 5n, nanoseconds: 0 } } }), 5);
    assert.equal(deviceTime({ ts: { microseconds: 1_500_000n } }), 1.5);
    assert.equal(deviceTime({ ts: 5 }), undefined);
    assert.equal(deviceTime(null), undefined);
  });
});

/** Variables of a MAT-file, read by its description; for what the inspector writes only. */
function readMat(bytes: Uint8Array): Map<string, number[]> {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  assert.equal(view.getUint16(126, true), 0x4d49);
  const found = new Map<string, number[]>();
  for (let at = 128; at < bytes.length; ) {
    assert.equal(view.getUint32(at, true), 14);
    const end = at + 8 + view.getUint32(at + 4, true);
    const rows = view.getInt32(at + 32, true);
    const size = view.getUint32(at + 44, true);
    const name = new TextDecoder().decode(bytes.subarray(at + 48, at + 48 + size));
    let data = at + 48 + Math.ceil(size / 8) * 8;
    assert.equal(view.getUint32(data, true), 9);
    assert.equal(view.getUint32(data + 4, true), rows * 8);
    data += 8;
    found.set(name, Array.from({ length: rows }, (_, i) => view.getFloat64(data + 8 * i, true)));
    assert.equal(data + rows * 8, end);
    at = end;
  }
  return found;
}

describe("A file of a plot", () => {
  const times = Float64Array.of(1.5, 2.5);
  const columns = [
    { name: "arm.position[0]", times, values: Float64Array.of(0.1, -2) },
    { name: "arm.position[1]", times, values: Float64Array.of(3, NaN) },
    { name: '=1+"a",b', times: Float64Array.of(9), values: Float64Array.of(4) },
  ];

  it("as CSV has times once where they are the same, and no formulas", () => {
    assert.equal(csvOf(columns), `time,arm.position[0],arm.position[1],"time of =1+""a"",b","'=1+""a"",b"\r\n1.5,0.1,3,9,4\r\n2.5,-2,NaN,,\r\n`);
  });

  it("as a MAT-file has a variable for times and one for values", () => {
    const found = readMat(matOf(columns, new Date(0)));
    assert.deepEqual([...found.keys()], ["arm_position_0_time", "arm_position_0", "arm_position_1_time", "arm_position_1", "x_1_a_b_time", "x_1_a_b"]);
    assert.deepEqual(found.get("arm_position_0_time"), [1.5, 2.5]);
    assert.deepEqual(found.get("arm_position_1"), [3, NaN]);
  });

  it("as a MAT-file gives equal names numbers", () => {
    const same = { name: "a b", times, values: times };
    assert.deepEqual([...readMat(matOf([same, { ...same, name: "a_b" }], new Date(0))).keys()], ["a_b_time", "a_b", "a_b_2_time", "a_b_2"]);
  });
});
