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

/** True where most columns have several points, so that stroking the line costs much. */
export function isDense(values: readonly (number | null)[]): boolean {
  let several = 0;
  for (let i = 0; i + 1 < values.length; i += 2) if (values[i] !== null && values[i] !== values[i + 1]) ++several;
  return 4 * several > values.length / 2;
}

/** Which columns are drawn, after a pattern of lengths. */
function dashes(columns: number, step: number, dash: readonly number[]): (column: number) => boolean {
  const period = dash.reduce((sum, length) => sum + length, 0);
  if (period <= 0) return () => true;
  const isOn = Array.from({ length: columns }, (_, column) => {
    let at = ((column + 0.5) * step) % period;
    let part = 0;
    while (at >= (dash[part] ?? period)) at -= dash[part++] ?? period;
    return part % 2 === 0;
  });
  return (column) => isOn[column] ?? true;
}

/**
 * Draws the outline of a line whose columns have two values each, their low and their high in either order, or nulls
 * where they are empty: empty columns are spanned.
 */
export function drawOutline(target: OutlineTarget, values: readonly (number | null)[], { left, step, pixel, width, dash }: OutlineOptions): void {
  const columns = values.length >> 1;
  const isDrawn = dashes(columns, step, dash);
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
    const own = { column, top: Math.min(pixel(first), pixel(second)), bottom: Math.max(pixel(first), pixel(second)) };
    // Joined with the column before, which it may not overlap. Over empty columns the line is as wide as at their sides.
    const isNext = before?.column === column - 1;
    let top = before && isNext ? Math.min(own.top, before.bottom) : own.top;
    let bottom = before && isNext ? Math.max(own.bottom, before.top) : own.bottom;
    before = own;
    if (bottom - top < width) {
      const middle = (top + bottom) / 2;
      top = middle - half;
      bottom = middle + half;
    }
    if (!isDrawn(column)) {
      finish();
      continue;
    }
    places.push(left + (column + 0.5) * step);
    tops.push(top);
    bottoms.push(bottom);
  }
  finish();
}
