// SPDX-License-Identifier: Apache-2.0

export type Theme = "system" | "light" | "dark";

const key = "robdef.inspector.theme";

export function nextTheme(theme: Theme): Theme {
  return theme === "system" ? "light" : theme === "light" ? "dark" : "system";
}

export function currentTheme(): Theme {
  try {
    const kept = localStorage.getItem(key);
    return kept === "light" || kept === "dark" ? kept : "system";
  } catch {
    return "system";
  }
}

/** Chooses colors; what draws by itself hears of it by the event robdef-theme. */
export function setTheme(theme: Theme): void {
  if (theme === "system") delete document.documentElement.dataset.theme;
  else document.documentElement.dataset.theme = theme;
  try {
    localStorage.setItem(key, theme);
  } catch {
    // It is kept for this page only.
  }
  dispatchEvent(new Event("robdef-theme"));
}
