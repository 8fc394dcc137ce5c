// SPDX-License-Identifier: Apache-2.0
// What the page shows, in the part of its URL after `#`: bookmarks and links keep it. No password is ever in it.
import type { PathStep } from "./history.js";

/** A member of a device, by names. */
export interface MemberPlace {
  readonly url: string;
  readonly steps: readonly PathStep[];
  readonly member: string;
}

export interface PanelLayout {
  readonly kind: "plot" | "picture" | "scene" | "memory";
  readonly places: readonly MemberPlace[];
  /** Of a plot: lines that are hidden, as `place:label`; seconds that are shown. */
  readonly hidden?: readonly string[];
  readonly seconds?: number;
}

export interface Layout {
  readonly urls: readonly string[];
  readonly selected?: { readonly url: string; readonly steps: readonly PathStep[] };
  readonly panels: readonly PanelLayout[];
}

export const emptyLayout: Layout = { urls: [], panels: [] };

const longest = 60_000;

/** As the part of a URL after `#`. */
export function layoutText(layout: Layout): string {
  return layout.urls.length === 0 ? "" : `l=${encodeURIComponent(JSON.stringify(layout))}`;
}

/** Reads the part of a URL after `#`; what is not understood is left out. `#url=...` alone connects. */
export function readLayout(hash: string): Layout {
  const text = hash.replace(/^#/, "");
  if (text.length > longest) return emptyLayout;
  const parameters = new URLSearchParams(text.replaceAll("+", "%2B"));
  const urls = parameters.getAll("url");
  const written = parameters.get("l");
  if (written === null) return { ...emptyLayout, urls };
  try {
    return checked(JSON.parse(written));
  } catch {
    return emptyLayout;
  }
}

type Json = Readonly<Record<string, unknown>>;

function isObject(value: unknown): value is Json {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function list(value: unknown, most = 64): unknown[] {
  return Array.isArray(value) ? value.slice(0, most) : [];
}

function texts(value: unknown, most = 64): string[] {
  return list(value, most).filter((one): one is string => typeof one === "string");
}

function checked(value: unknown): Layout {
  if (!isObject(value)) return emptyLayout;
  const urls = texts(value.urls, 16);
  const { selected } = value;
  const panels = list(value.panels).flatMap((one): PanelLayout[] => {
    if (!isObject(one)) return [];
    const { kind, seconds } = one;
    if (kind !== "plot" && kind !== "picture" && kind !== "scene" && kind !== "memory") return [];
    const places = list(one.places).flatMap((place) => {
      return isObject(place) && typeof place.url === "string" && typeof place.member === "string" ? [{ url: place.url, steps: stepsOf(place.steps), member: place.member }] : [];
    });
    const hidden = texts(one.hidden, 512);
    return [{ kind, places, ...(hidden.length > 0 ? { hidden } : {}), ...(typeof seconds === "number" && seconds > 0 && seconds <= 86_400 ? { seconds } : {}) }];
  });
  return { urls, panels, ...(isObject(selected) && typeof selected.url === "string" ? { selected: { url: selected.url, steps: stepsOf(selected.steps) } } : {}) };
}

function stepsOf(value: unknown): PathStep[] {
  return list(value).flatMap((one) => {
    if (!isObject(one) || typeof one.objref !== "string") return [];
    const { index } = one;
    return [{ objref: one.objref, index: typeof index === "number" || typeof index === "string" ? index : undefined }];
  });
}
