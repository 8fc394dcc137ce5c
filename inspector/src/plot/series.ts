// SPDX-License-Identifier: Apache-2.0
// Points of one line over time: a ring that grows to a limit, with the extremes of its blocks, so that a window of
// millions of points is drawn from some thousand numbers.

const blockSize = 64;
const firstCapacity = 4096;

export interface SeriesOptions {
  /** Seconds that are kept; more only while there is room. */
  keep?: number;
  /** Points that are kept at most; a multiple of 64. */
  most?: number;
}

/** Points in the order of their times. */
export class Series {
  private times = new Float64Array(firstCapacity);
  private values = new Float64Array(firstCapacity);
  private lows = new Float64Array(firstCapacity / blockSize);
  private highs = new Float64Array(firstCapacity / blockSize);
  private start = 0;
  private count = 0;
  private readonly keep: number;
  private readonly most: number;
  /** Points that were added, those that are no longer kept included. */
  total = 0;

  constructor({ keep = 120, most = 1 << 22 }: SeriesOptions = {}) {
    this.keep = keep;
    this.most = most;
  }

  get length(): number {
    return this.count;
  }

  /** Bytes that it holds. */
  get size(): number {
    return this.times.byteLength * 2 + this.lows.byteLength * 2;
  }

  /** Seconds; undefined while there are no points. */
  get firstTime(): number | undefined {
    return this.count === 0 ? undefined : this.times[this.start];
  }

  get lastTime(): number | undefined {
    return this.count === 0 ? undefined : this.times[this.place(this.count - 1)];
  }

  get lastValue(): number | undefined {
    return this.count === 0 ? undefined : this.values[this.place(this.count - 1)];
  }

  timeAt(index: number): number {
    return this.times[this.place(index)] ?? NaN;
  }

  valueAt(index: number): number {
    return this.values[this.place(index)] ?? NaN;
  }

  private place(index: number): number {
    return (this.start + index) & (this.times.length - 1);
  }

  /** Adds a point. A time before the last one counts as the last one. */
  push(time: number, value: number): void {
    const last = this.lastTime;
    const at = last !== undefined && time < last ? last : time;
    if (this.count === this.times.length) {
      if (this.times.length < this.most && at - (this.times[this.start] ?? at) < this.keep) this.grow();
      else {
        this.start = (this.start + 1) & (this.times.length - 1);
        --this.count;
      }
    }
    const place = this.place(this.count);
    this.times[place] = at;
    this.values[place] = value;
    const block = place >> 6;
    if ((place & (blockSize - 1)) === 0) {
      this.lows[block] = value;
      this.highs[block] = value;
    } else {
      if (!(value >= (this.lows[block] ?? 0))) this.lows[block] = value;
      if (!(value <= (this.highs[block] ?? 0))) this.highs[block] = value;
    }
    ++this.count;
    ++this.total;
  }

  private grow(): void {
    const old = this.times.length;
    const grown = (from: Float64Array<ArrayBuffer>): Float64Array<ArrayBuffer> => {
      const to = new Float64Array(old * 2);
      to.set(from.subarray(this.start));
      to.set(from.subarray(0, this.start), old - this.start);
      return to;
    };
    this.times = grown(this.times);
    this.values = grown(this.values);
    this.start = 0;
    this.lows = new Float64Array((old * 2) / blockSize);
    this.highs = new Float64Array((old * 2) / blockSize);
    for (let block = 0; block < old / blockSize; ++block) {
      const items = this.values.subarray(block * blockSize, (block + 1) * blockSize);
      this.lows[block] = items.reduce((low, one) => (one >= low ? low : one), items[0] ?? 0);
      this.highs[block] = items.reduce((high, one) => (one <= high ? high : one), items[0] ?? 0);
    }
  }

  clear(): void {
    this.start = 0;
    this.count = 0;
  }

  /** The index of the first point at or after a time. */
  indexOf(time: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.timeAt(middle) < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** The point nearest to a time. */
  nearest(time: number): { readonly time: number; readonly value: number } | undefined {
    if (this.count === 0) return undefined;
    const after = Math.min(this.indexOf(time), this.count - 1);
    const before = Math.max(0, after - 1);
    const index = Math.abs(this.timeAt(before) - time) <= Math.abs(this.timeAt(after) - time) ? before : after;
    return { time: this.timeAt(index), value: this.valueAt(index) };
  }

  /**
   * Low and high of each of `columns` parts of the time from `from` to `to`, into every second place of `out`: first
   * the one that came first. Places of empty parts are null.
   */
  columns(from: number, to: number, columns: number, out: (number | null)[]): void {
    const width = (to - from) / columns;
    let index = this.indexOf(from);
    for (let column = 0; column < columns; ++column) {
      const end = column === columns - 1 ? this.after(to, index) : this.bound(from + (column + 1) * width, index);
      if (end <= index) {
        out[2 * column] = null;
        out[2 * column + 1] = null;
        continue;
      }
      const first = this.valueAt(index);
      let low = first;
      let high = first;
      let lowAt = index;
      let highAt = index;
      for (let i = index; i < end; ) {
        const place = this.place(i);
        if ((place & (blockSize - 1)) === 0 && i + blockSize <= end) {
          const block = place >> 6;
          const blockLow = this.lows[block] ?? 0;
          const blockHigh = this.highs[block] ?? 0;
          if (blockLow < low) [low, lowAt] = [blockLow, i];
          if (blockHigh > high) [high, highAt] = [blockHigh, i];
          i += blockSize;
          continue;
        }
        const value = this.values[place] ?? 0;
        if (value < low) [low, lowAt] = [value, i];
        if (value > high) [high, highAt] = [value, i];
        ++i;
      }
      const isLowFirst = lowAt < highAt || (lowAt === highAt && first - low < high - first);
      out[2 * column] = isLowFirst ? low : high;
      out[2 * column + 1] = isLowFirst ? high : low;
      index = end;
    }
  }

  private after(time: number, from: number): number {
    let end = this.bound(time, from);
    while (end < this.count && this.timeAt(end) === time) ++end;
    return end;
  }

  /** As indexOf, for a time that is probably near the index: points of columns lie close together. */
  private bound(time: number, from: number): number {
    let step = 1;
    let low = from;
    while (low + step < this.count && this.timeAt(low + step) < time) {
      low += step;
      step *= 2;
    }
    let high = Math.min(low + step, this.count);
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.timeAt(middle) < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  /** Points from one time to another, both included. */
  slice(from = -Infinity, to = Infinity): { readonly times: Float64Array; readonly values: Float64Array } {
    const begin = this.indexOf(from);
    const end = this.after(to, begin);
    const times = new Float64Array(Math.max(0, end - begin));
    const values = new Float64Array(times.length);
    for (let i = 0; i < times.length; ++i) {
      times[i] = this.timeAt(begin + i);
      values[i] = this.valueAt(begin + i);
    }
    return { times, values };
  }
}
