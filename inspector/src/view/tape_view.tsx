// SPDX-License-Identifier: Apache-2.0
// A recording: scrubbed through, with the values of its members at each time, plots and pictures.
import type { VNode } from "preact";
import { useComputed, useSignal } from "@preact/signals";
import { useEffect, useLayoutEffect, useMemo, useRef } from "preact/hooks";
import type { App } from "../model/app.js";
import { unitIn } from "../model/members.js";
import { isPlottable } from "../model/types.js";
import { valueText } from "../model/value_text.js";
import { isPictureType, pictureOf } from "../picture/picture.js";
import { PlotModel } from "../plot/plot_model.js";
import type { Tape, TapeEvent, Track } from "../tape/tape.js";
import { clock } from "./clock.js";
import { PlotView } from "./plot_view.js";
import { PictureView } from "./value_view.js";

const shownEvents = 40;
const speeds = [0.1, 0.5, 1, 2, 10, 100];

export function TapeView({ app, tape }: { app: App; tape: Tape }): VNode {
  const time = useSignal(0);
  const isPlaying = useSignal(false);
  const speed = useSignal(1);
  const plotted = useSignal<readonly Track[]>([]);
  const filter = useSignal("");
  // Before the first click can come: a later effect would take back what it has chosen.
  useLayoutEffect(() => {
    time.value = 0;
    plotted.value = [];
  }, [tape]);
  useEffect(() => {
    if (!isPlaying.value) return undefined;
    let before = performance.now();
    let request = 0;
    const step = (now: number): void => {
      time.value = Math.min(tape.duration, time.peek() + ((now - before) / 1000) * speed.peek());
      before = now;
      if (time.peek() >= tape.duration) isPlaying.value = false;
      else request = requestAnimationFrame(step);
    };
    request = requestAnimationFrame(step);
    return () => {
      cancelAnimationFrame(request);
    };
  }, [isPlaying.value, tape]);
  const now = time.value;
  const wanted = filter.value.trim().toLowerCase();
  const tracks = tape.tracks.filter((track) => wanted === "" || `${track.path}.${track.member}`.toLowerCase().includes(wanted));
  const place = (event: TapeEvent | undefined): void => {
    if (event) time.value = event.time;
  };
  return (
    <div class="tape">
      <header class="object-head">
        <h2>{tape.name}</h2>
        <span class="hint">
          {new Date(tape.began).toLocaleString()}, {tape.duration.toFixed(2)} s, {tape.messages} messages
          {tape.ending === "closed" ? "" : `, ${endings[tape.ending]}`}
          {tape.lost > 0 ? `, ${tape.lost} messages were left out while recording` : ""}
        </span>
        <button type="button" class="small" onClick={() => { app.tape.value = undefined; }}>Close the recording</button>
      </header>
      {[...tape.problems].slice(0, 3).map((one) => (
        <p class="problem" key={one}>{one}</p>
      ))}
      <div class="scrubber" role="group" aria-label="Time">
        <button type="button" class="primary" onClick={() => { if (now >= tape.duration) time.value = 0; isPlaying.value = !isPlaying.value; }}>{isPlaying.value ? "Pause" : "Play"}</button>
        <label>
          <span class="visually-hidden">Speed</span>
          <select value={String(speed.value)} onChange={(event) => { speed.value = Number(event.currentTarget.value); }}>
            {speeds.map((one) => <option key={one} value={String(one)}>{one}×</option>)}
          </select>
        </label>
        <input type="range" min={0} max={tape.duration || 1} step="any" value={now} aria-label="Time in the recording" aria-valuetext={`${now.toFixed(3)} seconds`} onInput={(event) => { isPlaying.value = false; time.value = Number(event.currentTarget.value); }} />
        <output>{now.toFixed(3)} s</output>
        <span class="hint">{clock(tape.began / 1000 + now)}</span>
      </div>
      <Connections tape={tape} />
      {plotted.value.length > 0 ? <TapePlot tape={tape} tracks={plotted.value} at={now} onChoose={(chosen) => { time.value = Math.max(0, Math.min(tape.duration, chosen - tape.began / 1000)); }} /> : null}
      <section aria-label="Members in the recording">
        <h3>
          Members <input type="search" class="filter" placeholder="Filter members" aria-label="Filter members of the recording" value={filter.value} onInput={(event) => { filter.value = event.currentTarget.value; }} />
        </h3>
        {tape.tracks.length === 0 ? <p class="empty">No values of members are in this recording.</p> : null}
        <table class="tracks">
          <thead>
            <tr>
              <th scope="col">Member</th>
              <th scope="col">Kind</th>
              <th scope="col">Value at this time</th>
              <th scope="col">Count</th>
              <th scope="col">Show</th>
            </tr>
          </thead>
          <tbody>
            {tracks.map((track) => (
              <TrackRow key={track.key} tape={tape} track={track} time={now} isPlotted={plotted.value.includes(track)} onPlot={() => { plotted.value = plotted.value.includes(track) ? plotted.value.filter((one) => one !== track) : [...plotted.value, track]; }} onPlace={place} />
            ))}
          </tbody>
        </table>
      </section>
      <Events tape={tape} time={now} onPlace={place} />
    </div>
  );
}

const endings = { open: "the recorder was not closed", "cut off": "the end is cut off", damaged: "damaged: what comes after is left out", closed: "" } as const;

function Connections({ tape }: { tape: Tape }): VNode {
  return (
    <p class="hint">
      {[...tape.connections.values()].map((one) => `${one.url}${one.agreed === "" ? "" : ` (${one.agreed})`}${one.closing === "" ? "" : `, closed: ${one.closing}`}`).join("; ") || "No connection was opened in this recording."}
    </p>
  );
}

interface RowProps {
  readonly tape: Tape;
  readonly track: Track;
  readonly time: number;
  readonly isPlotted: boolean;
  readonly onPlot: () => void;
  readonly onPlace: (event: TapeEvent | undefined) => void;
}

function TrackRow({ tape, track, time, isPlotted, onPlot, onPlace }: RowProps): VNode {
  const event = tape.at(track, time);
  const { text, picture } = useMemo(() => described(tape, track, event), [tape, track, event]);
  const canPlot = track.type !== undefined && track.what !== "event" && isPlottable(track.type);
  const at = event ? track.events.indexOf(event) : -1;
  return (
    <tr data-member={track.member}>
      <th scope="row">
        {track.path}.{track.member}
      </th>
      <td>{track.what}</td>
      <td class="value">
        {text}
        {picture ? <PictureView picture={picture} label={`${track.member} at this time`} /> : null}
      </td>
      <td class="number">
        {at + 1} of {track.events.length}
      </td>
      <td>
        {canPlot ? <button type="button" class="small" aria-pressed={isPlotted} aria-label={`Plot ${track.member}`} onClick={onPlot}>Plot</button> : null}
        <button type="button" class="small" aria-label={`Value of ${track.member} before`} disabled={at <= 0} onClick={() => { onPlace(track.events[at - 1]); }}>◂</button>
        <button type="button" class="small" aria-label={`Next value of ${track.member}`} disabled={at + 1 >= track.events.length} onClick={() => { onPlace(track.events[at + 1]); }}>▸</button>
      </td>
    </tr>
  );
}

function described(tape: Tape, track: Track, event: TapeEvent | undefined): { text: string; picture?: Exclude<ReturnType<typeof pictureOf>, Error | undefined> } {
  if (!event) return { text: "—" };
  try {
    const value = tape.value(track, event);
    if (track.what === "event") {
      const args = value as unknown[];
      return { text: (track.declared?.parameters ?? []).map(({ name, type }, i) => `${name}: ${valueText(type, args[i])}`).join(", ") || "fired" };
    }
    if (!track.type) return { text: "of an unknown type" };
    if (isPictureType(track.type)) {
      const picture = pictureOf(track.type, value);
      if (picture && !(picture instanceof Error)) return { text: "", picture };
    }
    return { text: valueText(track.type, value) };
  } catch (error) {
    return { text: error instanceof Error ? error.message : String(error) };
  }
}

/** Numbers of tracks over the whole recording. */
function TapePlot({ tape, tracks, at, onChoose }: { tape: Tape; tracks: readonly Track[]; at: number; onChoose: (time: number) => void }): VNode {
  const made = useRef(new Map<Tape, PlotModel>());
  const model = useMemo(() => {
    const known = made.current.get(tape) ?? new PlotModel();
    made.current.set(tape, known);
    const wanted = new Set(tracks.map((track) => track.key));
    for (const key of [...known.sources.keys()]) if (!wanted.has(key)) known.remove(key);
    for (const track of tracks) {
      if (known.sources.has(track.key) || !track.type) continue;
      const lines = known.source({ key: track.key, label: track.member, unit: unitIn(track.declared?.doc ?? ""), type: track.type }, Infinity);
      for (const event of track.events) {
        try {
          lines.take(tape.value(track, event), tape.began / 1000 + event.time);
        } catch {
          // What cannot be read is shown in the table.
        }
      }
    }
    return known;
  }, [tape, tracks]);
  const begin = tape.began / 1000;
  const label = useComputed(() => "Plot of the recording");
  return (
    <section class="card panel" data-kind="tape-plot" aria-label="Plot of the recording">
      <PlotView model={model} label={label.value} at={begin + at} range={[begin, begin + Math.max(tape.duration, 1e-3)]} onChoose={onChoose} />
    </section>
  );
}

/** What went over the connections around a time. */
function Events({ tape, time, onPlace }: { tape: Tape; time: number; onPlace: (event: TapeEvent) => void }): VNode {
  const { events } = tape;
  let low = 0;
  let high = events.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((events[middle]?.time ?? 0) <= time) low = middle + 1;
    else high = middle;
  }
  const from = Math.max(0, low - shownEvents / 2);
  const around = events.slice(from, from + shownEvents);
  return (
    <section aria-label="Messages around this time">
      <h3>Messages around this time</h3>
      {around.length === 0 ? <p class="empty">No message is in this recording.</p> : null}
      <ol class="entries">
        {around.map((event, i) => (
          <li key={from + i} class={`${event.error === "" ? "" : "failed"}${event.time > time ? " later" : ""}`}>
            <button type="button" class="link" onClick={() => { onPlace(event); }}>{event.time.toFixed(6)}</button> {event.direction === "service" ? "to the service" : "to the client"} <b>{event.what}</b> <span class="place">{event.path}{event.member === "" ? "" : `.${event.member}`}</span>
            {event.error === "" ? null : <span class="problem"> {event.error}</span>}
          </li>
        ))}
      </ol>
    </section>
  );
}
