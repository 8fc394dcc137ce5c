// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, it } from "node:test";
import fc from "fast-check";
import { drawOutline, isDense, type OutlineOptions } from "../src/plot/outline.js";

type Corner = readonly [x: number, y: number];

/** The closed areas that are drawn. */
function areas(values: readonly (number | null)[], more: Partial<OutlineOptions> = {}): Corner[][] {
  const drawn: Corner[][] = [];
  let open: Corner[] = [];
  drawOutline(
    {
      moveTo: (x, y) => {
        open = [[x, y]];
      },
      lineTo: (x, y) => {
        open.push([x, y]);
      },
      closePath: () => {
        drawn.push(open);
      },
    },
    values,
    { left: 0, step: 1, pixel: (value) => value, width: 2, dash: [], ...more },
  );
  return drawn;
}

/** Top and bottom of an area at each of its places. */
function edges(area: readonly Corner[]): { readonly x: number; readonly top: number; readonly bottom: number }[] {
  const half = area.length / 2;
  return area.slice(0, half).map(([x, top], i) => {
    const [otherX, bottom] = area[area.length - 1 - i] ?? [NaN, NaN];
    assert.equal(otherX, x);
    return { x, top, bottom };
  });
}

describe("The outline of a line", () => {
  it("goes along the highs and back along the lows", () => {
    assert.deepEqual(areas([10, 30, 32, 11]), [[[0.5, 10], [1.5, 11], [1.5, 32], [0.5, 30]]]);
  });

  it("is as wide as the line where values hardly change", () => {
    assert.deepEqual(areas([5, 5, 5, 5.5]), [[[0.5, 4], [1.5, 4.25], [1.5, 6.25], [0.5, 6]]]);
  });

  it("reaches from a column to the next, up and down", () => {
    assert.deepEqual(edges(areas([0, 1, 50, 60, 3, 4])[0] ?? []), [
      { x: 0.5, top: -0.5, bottom: 1.5 },
      { x: 1.5, top: 1, bottom: 60 },
      { x: 2.5, top: 3, bottom: 50 },
    ]);
  });

  it("spans empty columns", () => {
    const [area = []] = areas([10, 10, null, null, null, null, 20, 20]);
    assert.deepEqual(edges(area), [
      { x: 0.5, top: 9, bottom: 11 },
      { x: 3.5, top: 19, bottom: 21 },
    ]);
  });

  it("is a dot for a single column, and nothing for none", () => {
    assert.deepEqual(areas([7, 7], { left: 100 }), [[[99.5, 6], [101.5, 6], [101.5, 8], [99.5, 8]]]);
    assert.deepEqual(areas([]), []);
    assert.deepEqual(areas([null, null]), []);
  });

  it("has gaps after a pattern", () => {
    const drawn = areas(Array<number>(20).fill(3), { dash: [3, 2] });
    assert.deepEqual(drawn.map((area) => edges(area).map(({ x }) => x)), [[0.5, 1.5, 2.5], [5.5, 6.5, 7.5]]);
  });

  it("covers all values and joins all columns", () => {
    const column = fc.option(fc.tuple(fc.integer({ min: 0, max: 240 }), fc.integer({ min: 0, max: 240 })), { nil: null });
    fc.assert(
      fc.property(fc.array(column, { minLength: 2, maxLength: 40 }), (columns) => {
        const given = columns.flatMap((one, i) => (one ? [{ x: i + 0.5, low: Math.min(...one), high: Math.max(...one) }] : []));
        if (given.length < 2) return;
        const drawn = areas(columns.flatMap((one) => one ?? [null, null]));
        assert.equal(drawn.length, 1);
        const made = edges(drawn[0] ?? []);
        assert.deepEqual(made.map(({ x }) => x), given.map(({ x }) => x));
        made.forEach(({ top, bottom }, i) => {
          assert.ok(top <= (given[i]?.low ?? NaN) && bottom >= (given[i]?.high ?? NaN) && bottom - top >= 2);
          const before = made[i - 1];
          const isNext = before?.x === (made[i]?.x ?? NaN) - 1;
          assert.ok(!before || !isNext || (top <= before.bottom && bottom >= before.top), `columns ${i - 1} and ${i} touch`);
        });
      }),
    );
  });

  it("is worth it where columns have several points", () => {
    assert.ok(isDense([1, 2, 3, 4]));
    assert.ok(!isDense([1, 1, 2, 2, 3, 3, 4, 4]));
    assert.ok(!isDense([1, 1, null, null, null, null, null, null]));
    assert.ok(!isDense([]));
  });
});
