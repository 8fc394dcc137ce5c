// SPDX-License-Identifier: Apache-2.0
// Lines of a plot: made of the values of members as they come, or of a recording.
import { signal } from "@preact/signals";
import type { ValueType } from "@robdef/runtime";
import type { Column } from "../export/column.js";
import { channelsOf, samplesOf, type Channel } from "./channels.js";
import { Series } from "./series.js";

/** One line. */
export interface Line {
  /** Of the source and the channel, unlike all others of the plot. */
  readonly key: string;
  readonly label: string;
  readonly unit: string;
  readonly series: Series;
}

/** Where values come from. */
export interface Source {
  readonly key: string;
  readonly label: string;
  readonly unit: string;
  readonly type: ValueType;
}

const longestGap = 10;

/** Turns values of one source into points of its lines. */
export class SourceLines {
  lines: Line[] = [];
  private channels: readonly Channel[] | undefined;
  private samples: Line | undefined;
  private lastTime: number | undefined;

  constructor(
    readonly source: Source,
    private readonly changed: () => void,
    private readonly keep?: number,
  ) {}

  take(value: unknown, seconds: number): void {
    if (this.samples) {
      this.spread(samplesOf(this.source.type, value), seconds);
      return;
    }
    if (!this.channels) this.begin(value);
    const channels = this.channels ?? [];
    for (let i = 0; i < channels.length; ++i) {
      const channel = channels[i];
      const line = this.lines[i];
      if (channel && line) line.series.push(seconds, channel.get(value));
    }
    if (this.samples as Line | undefined) this.spread(samplesOf(this.source.type, value), seconds);
  }

  private line(label: string): Line {
    const { source, keep } = this;
    const series = new Series(keep === undefined ? {} : { keep });
    return { key: `${source.key}:${label}`, label: `${source.label}${label === "" || label.startsWith("[") ? label : `.${label}`}`, unit: source.unit, series };
  }

  /** What lines there are is seen at the first value. */
  private begin(value: unknown): void {
    const { type } = this.source;
    if (samplesOf(type, value)) {
      this.samples = this.line("");
      this.channels = [];
      this.lines = [this.samples];
    } else {
      const channels = channelsOf(type, value);
      if (channels.length === 0) return;
      this.channels = channels;
      this.lines = channels.map((channel) => this.line(channel.label));
    }
    this.changed();
  }

  /** Samples of a row lie evenly between the time of the row before and its own. */
  private spread(row: ArrayLike<number | bigint> | undefined, seconds: number): void {
    if (!row || !this.samples) return;
    const before = this.lastTime;
    const step = before !== undefined && seconds > before && seconds - before < longestGap ? (seconds - before) / row.length : 0;
    for (let i = 0; i < row.length; ++i) this.samples.series.push(seconds - (row.length - 1 - i) * step, Number(row[i]));
    this.lastTime = seconds;
  }
}

/** All lines of a plot, which of them are hidden, and whether it stands still. */
export class PlotModel {
  readonly sources = new Map<string, SourceLines>();
  /** Counts changes of what lines there are. */
  readonly version = signal(0);
  readonly hidden = signal<ReadonlySet<string>>(new Set());
  /** Time of the right edge while it stands still; undefined while it moves. */
  readonly paused = signal<number | undefined>(undefined);
  readonly window = signal(10);
  /** Two times that are compared. */
  readonly cursors = signal<readonly number[]>([]);

  source(source: Source, keep?: number): SourceLines {
    let found = this.sources.get(source.key);
    if (!found) {
      found = new SourceLines(
        source,
        () => {
          ++this.version.value;
        },
        keep,
      );
      this.sources.set(source.key, found);
    }
    return found;
  }

  remove(key: string): void {
    if (this.sources.delete(key)) ++this.version.value;
  }

  get lines(): Line[] {
    return [...this.sources.values()].flatMap((one) => one.lines);
  }

  get shown(): Line[] {
    return this.lines.filter((line) => !this.hidden.value.has(line.key));
  }

  /** The newest time of all lines; undefined while there are no points. */
  get lastTime(): number | undefined {
    let last: number | undefined;
    for (const source of this.sources.values()) {
      for (const { series } of source.lines) {
        const time = series.lastTime;
        if (time !== undefined && (last === undefined || time > last)) last = time;
      }
    }
    return last;
  }

  /** Lines that are shown, between two times, for a file. */
  columns(from: number, to: number): Column[] {
    return this.shown.map(({ label, series }) => ({ name: label, ...series.slice(from, to) }));
  }
}
