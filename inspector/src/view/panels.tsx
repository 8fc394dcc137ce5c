// SPDX-License-Identifier: Apache-2.0
// Panels: plots, pictures and scenes that stay while other objects are looked at.
import type { VNode } from "preact";
import { untracked, useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useMemo, useRef } from "preact/hooks";
import type { App, Panel } from "../model/app.js";
import { feedKey } from "../model/feed.js";
import { unitIn } from "../model/members.js";
import { PlotModel } from "../plot/plot_model.js";
import { pictureOf } from "../picture/picture.js";
import { clock, save } from "./clock.js";
import { PlotButtons, PlotView } from "./plot_view.js";
import { ScenePanel } from "./scene_panel.js";
import { drawPicture } from "./value_view.js";

export function Panels({ app }: { app: App }): VNode {
  const panels = app.panels.value;
  return (
    <div class="panels">
      {panels.length === 0 ? <p class="empty">Plot, Picture and 3-D of a member show it here.</p> : null}
      {panels.map((panel) => (panel.kind === "plot" ? <PlotPanel key={panel.id} app={app} panel={panel} /> : panel.kind === "picture" ? <PicturePanel key={panel.id} app={app} panel={panel} /> : <ScenePanel key={panel.id} app={app} panel={panel} />))}
    </div>
  );
}

/** The name of a member with its object, for lines and titles. */
export function sourceTitle({ object, member }: Panel["sources"][number]): string {
  return object.steps.length === 0 ? member.name : `${object.title}.${member.name}`;
}

function PlotPanel({ app, panel }: { app: App; panel: Panel }): VNode {
  const model = useMemo(() => {
    const made = new PlotModel();
    made.window.value = panel.seconds;
    made.hidden.value = new Set(panel.hidden);
    return made;
  }, [panel.id]);
  const uses = useRef(new Map<string, () => void>());
  useEffect(() => {
    const wanted = new Map(panel.sources.map((one) => [feedKey(one.object, one.member.name), one]));
    for (const [key, stop] of uses.current) {
      if (wanted.has(key)) continue;
      stop();
      uses.current.delete(key);
      model.remove(key);
    }
    for (const [key, source] of wanted) {
      if (uses.current.has(key)) continue;
      const lines = model.source({ key, label: sourceTitle(source), unit: unitIn(source.member.doc), type: source.member.type });
      uses.current.set(key, app.feeds.of(source.object, source.member).use((value, seconds) => { lines.take(value, seconds); }));
    }
  }, [panel.sources]);
  useEffect(
    () => () => {
      for (const stop of uses.current.values()) stop();
      uses.current.clear();
    },
    [],
  );
  useSignalEffect(() => {
    const seconds = model.window.value;
    const hidden = [...model.hidden.value];
    untracked(() => {
      app.change(panel, { seconds, hidden });
    });
  });
  const title = panel.sources.map(sourceTitle).join(", ");
  const failed = panel.sources.map(({ object, member }) => app.feeds.of(object, member)).find((feed) => feed.state.value === "failed");
  return (
    <section class="card panel" data-kind="plot" aria-label={`Plot of ${title}`}>
      <header>
        <h3>{title}</h3>
        <span class="actions">
          <PlotButtons model={model} name={panel.sources[0]?.member.name ?? "plot"} />
          <button type="button" class="small" aria-label={`Close the plot of ${title}`} onClick={() => { app.remove(panel); }}>×</button>
        </span>
      </header>
      {failed ? <p class="problem" role="alert">{failed.problem.value}</p> : null}
      <PlotView model={model} label={`Plot of ${title}`} />
      {panel.sources.length > 1 ? (
        <details class="sources">
          <summary>{panel.sources.length} members</summary>
          <ul class="links">
            {panel.sources.map((one) => (
              <li key={feedKey(one.object, one.member.name)}>
                {sourceTitle(one)}{" "}
                <button type="button" class="small quiet" aria-label={`Remove ${sourceTitle(one)} from the plot`} onClick={() => { app.change(panel, { sources: panel.sources.filter((other) => other !== one) }); }}>Remove</button>
              </li>
            ))}
          </ul>
        </details>
      ) : null}
    </section>
  );
}

/** Pictures of a wire, pipe, property or function; the newest one is drawn with each frame of the screen. */
function PicturePanel({ app, panel }: { app: App; panel: Panel }): VNode | null {
  const [source] = panel.sources;
  const canvas = useRef<HTMLCanvasElement>(null);
  const about = useSignal("");
  const problem = useSignal("");
  const isPaused = useSignal(false);
  const rate = useSignal(0);
  useEffect(() => {
    if (!source) return undefined;
    const feed = app.feeds.of(source.object, source.member);
    let newest: { value: unknown; seconds: number } | undefined;
    let request = 0;
    let drawn = 0;
    let stopDrawing: () => void = () => undefined;
    const draw = (): void => {
      request = requestAnimationFrame(draw);
      const to = canvas.current;
      if (!newest || !to || isPaused.peek()) return;
      const { value, seconds } = newest;
      newest = undefined;
      const picture = pictureOf(source.member.type, value);
      if (!picture || picture instanceof Error) {
        problem.value = picture?.message ?? "this value is no picture";
        return;
      }
      problem.value = "";
      stopDrawing();
      stopDrawing = drawPicture(to, picture);
      ++drawn;
      about.value = `${picture.about}, ${feed.timeSource === "device" ? "device's" : "arrival"} time ${clock(seconds)}`;
    };
    draw();
    const counting = setInterval(() => {
      rate.value = drawn;
      drawn = 0;
    }, 1000);
    const stop = feed.use((value, seconds) => {
      newest = { value, seconds };
    });
    const unsubscribe = feed.problem.subscribe((text) => {
      if (text !== "") problem.value = text;
    });
    return () => {
      cancelAnimationFrame(request);
      clearInterval(counting);
      stopDrawing();
      unsubscribe();
      stop();
    };
  }, [source?.object.remote, source?.member.name]);
  if (!source) return null;
  const title = sourceTitle(source);
  const saveFile = (): void => {
    canvas.current?.toBlob((blob) => {
      void blob?.arrayBuffer().then((bytes) => { save(`${source.member.name}.png`, new Uint8Array(bytes), "image/png"); });
    });
  };
  return (
    <section class="card panel" data-kind="picture" aria-label={`Pictures of ${title}`}>
      <header>
        <h3>{title}</h3>
        <span class="actions">
          <button type="button" class="small" aria-pressed={isPaused.value} onClick={() => { isPaused.value = !isPaused.value; }}>{isPaused.value ? "Go on" : "Pause"}</button>
          <button type="button" class="small" onClick={saveFile}>PNG</button>
          <button type="button" class="small" aria-label={`Close the pictures of ${title}`} onClick={() => { app.remove(panel); }}>×</button>
        </span>
      </header>
      {problem.value === "" ? null : <p class="problem" role="alert">{problem.value}</p>}
      <figure class="picture">
        <canvas ref={canvas} role="img" aria-label={`Newest picture of ${title}`} />
        <figcaption>{about.value === "" ? "No picture yet." : `${about.value}, ${rate.value} a second`}</figcaption>
      </figure>
    </section>
  );
}
