// SPDX-License-Identifier: Apache-2.0
// Poses and robots in 3-D. The library for it is a script of its own in the file, which runs when it is needed.
import type { VNode } from "preact";
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { App, Panel } from "../model/app.js";
import { feedKey } from "../model/feed.js";
import { errorText } from "../model/errors.js";
import { rounded } from "../model/value_text.js";
import { chainPoints, chainsOf, shapesOf, type Chain, type Shape } from "../scene/poses.js";
import { loadScene } from "../scene/load.js";
import type { Scene } from "../scene/scene.js";
import { sourceTitle } from "./panels.js";

/** What keys do: radians around, radians up, and how many times as far. */
const turns: Readonly<Record<string, readonly [number, number, number] | undefined>> = {
  ArrowLeft: [-0.1, 0, 1],
  ArrowRight: [0.1, 0, 1],
  ArrowUp: [0, 0.1, 1],
  ArrowDown: [0, -0.1, 1],
  "+": [0, 0, 0.9],
  "=": [0, 0, 0.9],
  "-": [0, 0, 1.1],
};

export function ScenePanel({ app, panel }: { app: App; panel: Panel }): VNode {
  const place = useRef<HTMLDivElement>(null);
  const problem = useSignal("");
  const texts = useSignal<readonly string[]>([]);
  const shown = useRef<Scene | undefined>(undefined);
  const keys = panel.sources.map((one) => feedKey(one.object, one.member.name)).join("\n");
  useEffect(() => {
    const values = new Map<string, Shape[]>();
    let chains: Chain[] = [];
    let scene: Scene | undefined;
    let request = 0;
    let isDirty = true;
    let isOver = false;
    const stops: (() => void)[] = [];
    for (const source of panel.sources) {
      const { object, member } = source;
      const title = sourceTitle(source);
      // A robot tells its axes in another member.
      if (object.remote.type.members.has("robot_info")) {
        object.remote.get("robot_info").then(
          (info) => {
            chains = chainsOf(info);
            isDirty = true;
          },
          (error: unknown) => {
            problem.value = errorText(error);
          },
        );
      }
      stops.push(
        app.feeds.of(object, member).use((value) => {
          if (member.name === "robot_info") chains = chainsOf(value);
          values.set(title, shapesOf(member.type, value, title));
          isDirty = true;
        }),
      );
    }
    const draw = (): void => {
      request = requestAnimationFrame(draw);
      if (!scene) return;
      if (isDirty) {
        isDirty = false;
        const shapes = [...values.values()].flat();
        const joints = shapes.find((shape) => shape.kind === "joints");
        scene.show(shapes, joints || chains.length > 0 ? chains.map((chain) => chainPoints(chain, joints?.kind === "joints" ? joints.positions : [])) : []);
        texts.value = shapes.slice(0, 12).map(describe);
      }
      scene.render();
    };
    loadScene().then(
      (make) => {
        if (isOver || !place.current) return;
        try {
          scene = make(place.current);
          shown.current = scene;
          draw();
        } catch (error) {
          problem.value = `This browser shows no 3-D: ${error instanceof Error ? error.message : String(error)}`;
        }
      },
      (error: unknown) => {
        problem.value = String(error);
      },
    );
    const again = (): void => {
      scene?.recolor();
    };
    const dark = matchMedia("(prefers-color-scheme: dark)");
    dark.addEventListener("change", again);
    addEventListener("robdef-theme", again);
    return () => {
      isOver = true;
      dark.removeEventListener("change", again);
      removeEventListener("robdef-theme", again);
      cancelAnimationFrame(request);
      for (const stop of stops) stop();
      shown.current = undefined;
      scene?.dispose();
    };
  }, [keys]);
  const onKey = (event: KeyboardEvent): void => {
    const turn = turns[event.key];
    if (!turn || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    shown.current?.turn(...turn);
  };
  const title = panel.sources.map(sourceTitle).join(", ");
  return (
    <section class="card panel" data-kind="scene" aria-label={`3-D view of ${title}`}>
      <header>
        <h3>{title}</h3>
        <span class="actions">
          <button type="button" class="small" aria-label={`Close the 3-D view of ${title}`} onClick={() => { app.remove(panel); }}>×</button>
        </span>
      </header>
      {problem.value === "" ? null : <p class="problem" role="alert">{problem.value}</p>}
      <div ref={place} class="scene" role="img" aria-label={`3-D view of ${title}; x red, y green, z blue. Drag or use the arrow keys to turn; wheel, plus or minus to zoom.`} tabIndex={0} onKeyDown={onKey} />
      {texts.value.length === 0 ? <p class="empty">Nothing to show yet.</p> : <ul class="poses">{texts.value.map((one) => <li key={one}>{one}</li>)}</ul>}
    </section>
  );
}

function describe(shape: Shape): string {
  const numbers = (list: readonly number[]): string => list.map((one) => rounded(Number(one.toFixed(4)))).join(", ");
  switch (shape.kind) {
    case "pose":
      return `${shape.label}: at ${numbers(shape.position)}, turned ${numbers(shape.orientation)}`;
    case "point":
      return `${shape.label}: at ${numbers(shape.position)}`;
    case "arrow":
      return `${shape.label}: ${numbers(shape.direction)}`;
    default:
      return `${shape.label}: joints ${numbers(shape.positions)}`;
  }
}
