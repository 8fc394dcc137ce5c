// SPDX-License-Identifier: Apache-2.0
// The area that a line covers. Filling it gives the same picture as stroking the line, and costs a fraction: a line of
// a thousand points goes up and down in each column, and each of its corners is a join of the stroke.

/** Where an outline is drawn: what a canvas context or a Path2D has. */
export interface OutlineTarget {
  moveTo(x: number, y: number): void;
  lineTo(x: number, y: number): void;
  closePath(): void;
}

export interface OutlineOptions {
  /** Places of the columns: their middles are at left + (i + 0.5) * step, in pixels. */
  readonly left: number;
  readonly step: number;
  /** Pixel of a value. */
  readonly pixel: (value: number) => number;
  /** Width of the line, in pixels. */
  readonly width: number;
  /** Lengths of parts that are drawn and left out in turn, in pixels along x; none for a whole line. */
  readonly dash: readonly number[];
}

/** True where more than a quarter of the columns has several values, so that stroking the line costs much. */
export function isDense(values: readonly (number | null)[]): boolean {
  let several = 0;
  for (let i = 0; i + 1 < values.length; i += 2) if (values[i] !== null && values[i] !== values[i + 1]) ++several;
  return 8 * several > values.length;
}

/** Whether a place is in a part of a pattern that is drawn. `period`: the sum of its lengths. */
function isInDash(place: number, dash: readonly number[], period: number): boolean {
  if (period <= 0) return true;
  let at = place % period;
  let part = 0;
  while (at >= (dash[part] ?? period)) at -= dash[part++] ?? period;
  return part % 2 === 0;
}

/**
 * Draws the outline of a line whose columns have two values each, their low and their high in either order, or nulls
 * where they are empty: empty columns are spanned.
 */
export function drawOutline(target: OutlineTarget, values: readonly (number | null)[], { left, step, pixel, width, dash }: OutlineOptions): void {
  const columns = values.length >> 1;
  const period = dash.reduce((sum, length) => sum + length, 0);
  const half = width / 2;
  const places: number[] = [];
  const tops: number[] = [];
  const bottoms: number[] = [];
  const finish = (): void => {
    const last = places.length - 1;
    if (last < 0) return;
    // A single column is a dot as wide as the line.
    if (last === 0) {
      const [x = 0] = places;
      places.splice(0, 1, x - half, x + half);
      tops.push(tops[0] ?? 0);
      bottoms.push(bottoms[0] ?? 0);
    }
    target.moveTo(places[0] ?? 0, tops[0] ?? 0);
    for (let i = 1; i < places.length; ++i) target.lineTo(places[i] ?? 0, tops[i] ?? 0);
    for (let i = places.length; i-- > 0; ) target.lineTo(places[i] ?? 0, bottoms[i] ?? 0);
    target.closePath();
    places.length = tops.length = bottoms.length = 0;
  };
  let before: { column: number; top: number; bottom: number } | undefined;
  for (let column = 0; column < columns; ++column) {
    const first = values[2 * column];
    const second = values[2 * column + 1];
    if (typeof first !== "number" || typeof second !== "number") continue;
    const one = pixel(first);
    const other = pixel(second);
    let top = Math.min(one, other);
    let bottom = Math.max(one, other);
    const own = { column, top, bottom };
    // Joined with the column before, which it may not overlap. Over empty columns the line is as wide as at their sides.
    if (before?.column === column - 1) {
      top = Math.min(top, before.bottom);
      bottom = Math.max(bottom, before.top);
    }
    before = own;
    if (bottom - top < width) {
      const middle = (top + bottom) / 2;
      top = middle - half;
      bottom = middle + half;
    }
    if (!isInDash((column + 0.5) * step, dash, period)) {
      finish();
      continue;
    }
    places.push(left + (column + 0.5) * step);
    tops.push(top);
    bottoms.push(bottom);
  }
  finish();
}
