// SPDX-License-Identifier: Apache-2.0
// A plot: drawn by uPlot from the extremes of columns, so that the number of points does not matter.
import type { VNode } from "preact";
import { useSignal } from "@preact/signals";
import { useEffect, useRef, useState } from "preact/hooks";
import uPlot from "uplot";
import { csvOf } from "../export/csv.js";
import { matOf } from "../export/mat.js";
import { drawOutline, isDense } from "../plot/outline.js";
import type { Line, PlotModel } from "../plot/plot_model.js";
import { rounded } from "../model/value_text.js";
import { clock, save } from "./clock.js";

/** Colors that differ in lightness as well, so that they can be told apart without seeing colors. */
const colors = ["--line-1", "--line-2", "--line-3", "--line-4", "--line-5", "--line-6", "--line-7", "--line-8"];
const dashes = [[], [8, 4], [2, 3], [10, 3, 2, 3]];
const windows = [1, 2, 5, 10, 30, 60, 300, 1800];
const plotHeight = 240;
const lineWidth = 1.5;
/** Lines above this have columns of two pixels instead of one; each column has two points, its low and its high. */
const mostFineLines = 8;
const mostAxes = 4;
// The enum of the library is there for the compiler only, which may not look into it in modules of their own.
/* eslint-disable @typescript-eslint/no-unsafe-enum-assignment */
const left: uPlot.Axis.Side.Left = 3;
const right: uPlot.Axis.Side.Right = 1;
/* eslint-enable @typescript-eslint/no-unsafe-enum-assignment */

function colorOf(index: number): string {
  return getComputedStyle(document.documentElement).getPropertyValue(colors[index % colors.length] ?? "").trim() || "gray";
}

/** Lines of the same unit share an axis; lines without one the first. */
function scaleOf(line: Line, units: readonly string[]): string {
  return `y${Math.max(0, units.indexOf(line.unit))}`;
}

function unitsOf(lines: readonly Line[]): string[] {
  return [...new Set(lines.map((line) => line.unit))].slice(0, mostAxes);
}

/**
 * Makes a plot whose canvas is drawn by the processor. Lines change in each frame, and where graphics are emulated, as
 * in virtual machines and remote desktops, drawing them there takes seconds. The first to ask for a context says what
 * kind it is, and uPlot has no option for it.
 */
function makePlot(options: uPlot.Options, data: uPlot.AlignedData, element: HTMLElement): uPlot {
  const prototype = HTMLCanvasElement.prototype as { getContext: (this: HTMLCanvasElement, kind: string, more?: unknown) => unknown };
  const own = prototype.getContext;
  prototype.getContext = function (kind) {
    return own.call(this, kind, { willReadFrequently: true });
  };
  try {
    return new uPlot(options, data, element);
  } finally {
    prototype.getContext = own;
  }
}

/** Lines with many points are filled, others are stroked. */
function pathsOf(color: string, scale: string, dash: readonly number[]): uPlot.Series.PathBuilder {
  const stroked = uPlot.paths.linear?.();
  return (plot, index, from, to) => {
    const values = (plot.data[index] ?? []) as (number | null)[];
    if (stroked && !isDense(values)) return stroked(plot, index, from, to);
    const { left, top, width, height } = plot.bbox;
    const { min = 0, max = 1 } = plot.scales[scale] ?? {};
    const factor = height / (max - min);
    const path = new Path2D();
    drawOutline(path, values, {
      left,
      step: width / (values.length / 2),
      pixel: (value) => top + (max - value) * factor,
      width: lineWidth * devicePixelRatio,
      dash: dash.map((length) => length * devicePixelRatio),
    });
    return { fill: path, stroke: null, _fill: color, flags: 0 };
  };
}

/** Values of a plot between two times, as uPlot takes them. */
class Frame {
  readonly data: [number[], ...(number | null)[][]] = [[]];
  /** Extremes of each axis: known from the columns, so that uPlot need not look for them. */
  fill(lines: readonly Line[], from: number, to: number, columns: number): void {
    const [times] = this.data;
    times.length = 2 * columns;
    const width = (to - from) / columns;
    for (let i = 0; i < columns; ++i) {
      times[2 * i] = from + (i + 0.25) * width;
      times[2 * i + 1] = from + (i + 0.75) * width;
    }
    this.data.length = 1 + lines.length;
    lines.forEach((line, i) => {
      const values = (this.data[i + 1] ??= []) as (number | null)[];
      values.length = 2 * columns;
      line.series.columns(from, to, columns, values);
    });
  }
}

export interface PlotProps {
  readonly model: PlotModel;
  readonly label: string;
  /** Of a recording: the time that is looked at, and what chooses another. */
  readonly at?: number | undefined;
  readonly onChoose?: (time: number) => void;
  /** Both edges, where it does not follow the newest points. */
  readonly range?: readonly [number, number];
}

export function PlotView({ model, label, at, onChoose, range }: PlotProps): VNode {
  const place = useRef<HTMLDivElement>(null);
  const plotRef = useRef<uPlot | undefined>(undefined);
  const theme = useSignal(0);
  const version = model.version.value;
  const shownKeys = model.shown.map((line) => line.key).join("\n");
  const latest = useRef({ at, range, onChoose });
  latest.current = { at, range, onChoose };
  useEffect(() => {
    const element = place.current;
    if (!element) return undefined;
    const lines = model.shown;
    const units = unitsOf(lines);
    const frame = new Frame();
    const all = model.lines;
    const options: uPlot.Options = {
      width: Math.max(100, element.clientWidth),
      height: plotHeight,
      legend: { show: false },
      cursor: { drag: { x: false, y: false }, points: { show: false } },
      scales: { x: { time: false, auto: false, range: () => edges() }, ...Object.fromEntries(units.map((_, i) => [`y${i}`, { auto: true }])) },
      axes: [
        { stroke: colorVariable("--text-quiet"), grid: { stroke: colorVariable("--grid"), width: 1 }, ticks: { stroke: colorVariable("--grid") }, values: (_, splits) => timeLabels(splits), font: "11px system-ui", space: 90 },
        ...units.map((unit, i) => ({
          scale: `y${i}`,
          // Left and right in turn.
          side: i % 2 === 0 ? left : right,
          stroke: colorVariable("--text-quiet"),
          grid: { show: i === 0, stroke: colorVariable("--grid"), width: 1 },
          ticks: { stroke: colorVariable("--grid") },
          font: "11px system-ui",
          size: 56,
          ...(unit === "" ? {} : { label: unit, labelSize: 16, labelFont: "11px system-ui" }),
        })),
      ],
      series: [
        {},
        ...lines.map((line) => {
          const index = all.indexOf(line);
          const stroke = colorOf(index);
          const scale = scaleOf(line, units);
          const dash = dashes[Math.floor(index / colors.length) % dashes.length] ?? [];
          return { label: line.label, scale, stroke, width: lineWidth, dash, spanGaps: true, points: { show: false }, paths: pathsOf(stroke, scale, dash) };
        }),
      ],
      hooks: { draw: [(plot) => { marks(plot); }] },
    };
    const edges = (): [number, number] => {
      const fixed = latest.current.range;
      if (fixed) return [fixed[0], fixed[1]];
      const end = model.paused.peek() ?? model.lastTime ?? 0;
      return [end - model.window.peek(), end];
    };
    const marks = (plot: uPlot): void => {
      const { ctx } = plot;
      const draw = (time: number, color: string): void => {
        const x = Math.round(plot.valToPos(time, "x", true));
        if (x < plot.bbox.left || x > plot.bbox.left + plot.bbox.width) return;
        ctx.save();
        ctx.strokeStyle = color;
        ctx.lineWidth = devicePixelRatio;
        ctx.beginPath();
        ctx.moveTo(x, plot.bbox.top);
        ctx.lineTo(x, plot.bbox.top + plot.bbox.height);
        ctx.stroke();
        ctx.restore();
      };
      for (const time of model.cursors.peek()) draw(time, colorVariable("--accent"));
      if (latest.current.at !== undefined) draw(latest.current.at, colorVariable("--text"));
    };
    const plot = makePlot(options, frame.data, element);
    plotRef.current = plot;
    const choose = (event: MouseEvent): void => {
      const time = plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x");
      if (latest.current.onChoose) latest.current.onChoose(time);
      else model.cursors.value = [...model.cursors.value, time].slice(-2);
    };
    plot.over.addEventListener("click", choose);
    const sized = new ResizeObserver(() => {
      plot.setSize({ width: Math.max(100, element.clientWidth), height: plotHeight });
    });
    sized.observe(element);
    let request = 0;
    let drawn = "";
    const draw = (): void => {
      request = requestAnimationFrame(draw);
      const [from, to] = edges();
      let total = 0;
      for (const { series } of lines) total += series.total;
      const state = `${from} ${to} ${total} ${latest.current.at ?? ""} ${model.cursors.peek().join(" ")} ${plot.width}`;
      if (state === drawn) return;
      drawn = state;
      const columns = Math.max(50, Math.floor(plot.over.clientWidth / (lines.length > mostFineLines ? 2 : 1)));
      frame.fill(lines, from, to, columns);
      plot.setData(frame.data, false);
      plot.setScale("x", { min: from, max: to });
    };
    draw();
    return () => {
      cancelAnimationFrame(request);
      sized.disconnect();
      plot.over.removeEventListener("click", choose);
      plot.destroy();
    };
  }, [model, version, shownKeys, theme.value]);
  useEffect(() => {
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const again = (): void => {
      ++theme.value;
    };
    dark.addEventListener("change", again);
    addEventListener("robdef-theme", again);
    return () => {
      dark.removeEventListener("change", again);
      removeEventListener("robdef-theme", again);
    };
  }, []);
  const onKey = (event: KeyboardEvent): void => {
    const plot = plotRef.current;
    if (!plot || (event.key !== "ArrowLeft" && event.key !== "ArrowRight")) return;
    event.preventDefault();
    const { min = 0, max = 0 } = plot.scales.x ?? {};
    const step = ((max - min) / 200) * (event.key === "ArrowLeft" ? -1 : 1);
    const moved = (time: number | undefined): number => Math.max(min, Math.min(max, (time ?? (min + max) / 2) + step));
    if (onChoose) {
      onChoose(moved(at));
      return;
    }
    const cursors = [...model.cursors.value];
    const which = event.shiftKey && cursors.length > 1 ? 0 : Math.max(0, cursors.length - 1);
    cursors[which] = moved(cursors[which]);
    model.cursors.value = cursors;
  };
  return (
    <div class="plot" role="group" aria-label={label}>
      <div ref={place} class="canvas" role="img" aria-label={`${label}: ${model.shown.length} lines. Arrow keys move a cursor, with Shift the other one.`} tabIndex={0} onKeyDown={onKey} />
      {model.lines.length === 0 ? <p class="empty">No values yet.</p> : null}
      <Legend model={model} at={at} />
    </div>
  );
}

function colorVariable(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Times below each other share what they have alike: whole seconds are enough for a minute. */
function timeLabels(times: readonly number[]): string[] {
  const step = times.length > 1 ? (times[1] ?? 0) - (times[0] ?? 0) : 1;
  return times.map((time) => {
    if (time < 1e8) return `${rounded(Number(time.toFixed(6)))} s`;
    const text = clock(time);
    return step >= 1 && Number.isInteger(step) ? text.slice(0, 8) : step >= 0.1 ? text.slice(0, 10) : step >= 0.001 ? text.slice(3) : `${text.slice(6)}${(time % 0.001).toFixed(6).slice(5)}`;
  });
}

/** Lines with their values; ticks show and hide them. */
function Legend({ model, at }: { model: PlotModel; at: number | undefined }): VNode {
  const [first, second] = model.cursors.value;
  // Changed, so that values are shown anew.
  const [, setRound] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => {
      if (!document.hidden) setRound((round) => round + 1);
    }, 250);
    return () => {
      clearInterval(timer);
    };
  }, []);
  const hidden = model.hidden.value;
  const toggle = (line: Line): void => {
    const changed = new Set(hidden);
    if (!changed.delete(line.key)) changed.add(line.key);
    model.hidden.value = changed;
  };
  const text = (value: number | undefined): string => (value === undefined ? "—" : rounded(value));
  return (
    <>
      {first === undefined ? null : (
        <p class="hint cursors">
          cursor {clock(first)}
          {second === undefined ? "" : `, ${clock(second)}, ${rounded(Math.abs(second - first))} s apart`}{" "}
          <button type="button" class="small quiet" onClick={() => { model.cursors.value = []; }}>Remove cursors</button>
        </p>
      )}
      <ul class={`legend${first === undefined ? "" : " with-cursors"}`}>
        {model.lines.map((line, i) => (
          <li key={line.key} class={hidden.has(line.key) ? "hidden" : ""}>
            <label>
              <input type="checkbox" checked={!hidden.has(line.key)} onChange={() => { toggle(line); }} />
              <span class="swatch" style={{ background: `var(${colors[i % colors.length] ?? ""})` }} />
              <span class="name">{line.label}</span>
            </label>
            <span class="number">
              {text(at === undefined ? line.series.lastValue : line.series.nearest(at)?.value)} {line.unit}
            </span>
            {first === undefined ? null : <span class="number">{text(line.series.nearest(first)?.value)}</span>}
            {second === undefined ? null : <span class="number">{text(line.series.nearest(second)?.value)}</span>}
          </li>
        ))}
      </ul>
    </>
  );
}

/** Buttons of a plot: pause, how much is shown, cursors, files. */
export function PlotButtons({ model, name }: { model: PlotModel; name: string }): VNode {
  const isPaused = model.paused.value !== undefined;
  const edges = (): [number, number] => {
    const end = model.paused.value ?? model.lastTime ?? 0;
    return [end - model.window.value, end];
  };
  return (
    <>
      <button type="button" class="small" aria-pressed={isPaused} onClick={() => { model.paused.value = isPaused ? undefined : model.lastTime; }}>{isPaused ? "Go on" : "Pause"}</button>
      {isPaused ? (
        <>
          <button type="button" class="small" aria-label="Earlier" onClick={() => { model.paused.value = (model.paused.value ?? 0) - model.window.value / 2; }}>◂</button>
          <button type="button" class="small" aria-label="Later" onClick={() => { model.paused.value = (model.paused.value ?? 0) + model.window.value / 2; }}>▸</button>
        </>
      ) : null}
      <label>
        <span class="visually-hidden">Seconds that are shown</span>
        <select value={String(model.window.value)} onChange={(event) => { model.window.value = Number(event.currentTarget.value); }}>
          {windows.map((one) => (
            <option key={one} value={String(one)}>{one < 60 ? `${one} s` : `${one / 60} min`}</option>
          ))}
        </select>
      </label>
      <button type="button" class="small" title="Two cursors in the middle; a click in the plot moves the older one" onClick={() => { const [from, to] = edges(); model.cursors.value = [from + (to - from) / 3, to - (to - from) / 3]; }}>Cursors</button>
      <button type="button" class="small" onClick={() => { save(`${name}.csv`, csvOf(model.columns(...edges())), "text/csv"); }}>CSV</button>
      <button type="button" class="small" onClick={() => { save(`${name}.mat`, matOf(model.columns(...edges()), new Date()), "application/octet-stream"); }}>.mat</button>
    </>
  );
}
