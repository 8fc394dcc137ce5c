// SPDX-License-Identifier: Apache-2.0
// Everything that was done, newest first, with the code that does the same.
import type { VNode } from "preact";
import { useSignal } from "@preact/signals";
import type { App } from "../model/app.js";
import { codeOf, languages, type Language } from "../copy/code.js";
import { placeText, type HistoryEntry } from "../model/history.js";
import { valueText } from "../model/value_text.js";
import { clock, duration } from "./clock.js";

export function LogView({ app }: { app: App }): VNode {
  const language = useSignal<Language>("shell");
  const shown = useSignal<{ readonly id: number; readonly text: string } | undefined>(undefined);
  const entries = app.history.entries.value;
  const copy = (entry: HistoryEntry): void => {
    const text = codeOf(language.value, entry.operation);
    shown.value = { id: entry.id, text };
    navigator.clipboard.writeText(text).then(
      () => {
        app.announcement.value = "Copied";
      },
      () => {
        app.announcement.value = "The browser does not let this page copy; the code is shown instead";
      },
    );
  };
  return (
    <section class="log" aria-label="Log of what was done">
      <header>
        <h2>Log</h2>
        <label>
          Copy as{" "}
          <select value={language.value} onChange={(event) => { language.value = event.currentTarget.value as Language; shown.value = undefined; }}>
            {languages.map(([key, name]) => (
              <option key={key} value={key}>{name}</option>
            ))}
          </select>
        </label>
        <button type="button" class="small" disabled={entries.length === 0} onClick={() => { app.history.clear(); }}>Clear</button>
      </header>
      {entries.length === 0 ? <p class="empty">Nothing was done yet.</p> : null}
      <ol class="entries">
        {[...entries].reverse().slice(0, 200).map((entry) => (
          <Entry key={entry.id} entry={entry} code={shown.value?.id === entry.id ? shown.value.text : undefined} onCopy={() => { copy(entry); }} />
        ))}
      </ol>
    </section>
  );
}

function Entry({ entry, code, onCopy }: { entry: HistoryEntry; code: string | undefined; onCopy: () => void }): VNode {
  const { operation, at } = entry;
  const outcome = entry.outcome.value;
  const place = operation.member ? placeText(operation.steps, operation.member.name) : operation.kind === "connect" ? operation.url : placeText(operation.steps);
  const args = operation.args.map(({ type, value }) => valueText(type, value, 80)).join(", ");
  return (
    <li class={outcome.state}>
      <time>{clock(at / 1000)}</time> <b>{operation.kind}</b> <span class="place">{place}</span>
      {operation.detail === undefined ? null : <span> {operation.detail}</span>}
      {args === "" ? null : <span class="args">({args})</span>}
      <span class="outcome">
        {outcome.state === "pending" ? "…" : `${outcome.text === "" ? "done" : outcome.text} `}
        {outcome.state === "pending" ? null : <span class="took">{duration(outcome.took)}</span>}
      </span>
      <button type="button" class="small quiet" aria-label={`Copy ${operation.kind} ${place} as code`} onClick={onCopy}>Copy</button>
      {code === undefined ? null : <pre class="code" tabIndex={0} aria-label="Code">{code}</pre>}
    </li>
  );
}
