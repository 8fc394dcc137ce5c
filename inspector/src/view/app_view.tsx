// SPDX-License-Identifier: Apache-2.0
// The whole page.
import type { VNode } from "preact";
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import type { App } from "../model/app.js";
import { Tape } from "../tape/tape.js";
import { sizeText, save } from "./clock.js";
import { ConnectBar, Failure, Welcome } from "./connect_bar.js";
import { LogView } from "./log_view.js";
import { ObjectView } from "./object_view.js";
import { Panels } from "./panels.js";
import { TapeView } from "./tape_view.js";
import { Tree } from "./tree.js";
import { currentTheme, nextTheme, setTheme } from "./theme.js";

const mostTape = 1024 * 1024 * 1024;

export function AppView({ app }: { app: App }): VNode {
  const isDragged = useSignal(false);
  const reading = useSignal<number | undefined>(undefined);
  const showsLog = useSignal(true);
  const showsHelp = useSignal(false);
  const open = (file: File | undefined): void => {
    if (!file) return;
    if (file.size > mostTape) {
      app.notice.value = `${file.name} has ${sizeText(file.size)}; a page reads recordings up to ${sizeText(mostTape)}. robdef inspect reads longer ones.`;
      return;
    }
    reading.value = 0;
    file
      .arrayBuffer()
      .then((bytes) => Tape.open(file.name, new Uint8Array(bytes), (part) => { reading.value = part; }))
      .then((tape) => {
        app.tape.value = tape;
        app.notice.value = "";
        app.announcement.value = `${tape.name} is open: ${tape.messages} messages`;
      })
      .catch((error: unknown) => {
        app.notice.value = `${file.name}: ${error instanceof Error ? error.message : String(error)}`;
      })
      .finally(() => {
        reading.value = undefined;
      });
  };
  useEffect(() => {
    const over = (event: DragEvent): void => {
      if (!event.dataTransfer?.types.includes("Files")) return;
      event.preventDefault();
      isDragged.value = true;
    };
    const leave = (event: DragEvent): void => {
      if (event.relatedTarget === null) isDragged.value = false;
    };
    const drop = (event: DragEvent): void => {
      event.preventDefault();
      isDragged.value = false;
      open(event.dataTransfer?.files[0]);
    };
    const keys = (event: KeyboardEvent): void => {
      const isTyping = event.target instanceof HTMLElement && event.target.matches("input, textarea, select");
      if (isTyping || event.ctrlKey || event.metaKey || event.altKey) return;
      const focus = (selector: string): void => {
        event.preventDefault();
        document.querySelector<HTMLElement>(selector)?.focus();
      };
      if (event.key === "/") focus("#address");
      else if (event.key === "t") focus('[role=treeitem][tabindex="0"]');
      else if (event.key === "f") focus(".filter");
      else if (event.key === "m") focus("main");
      else if (event.key === "?") showsHelp.value = !showsHelp.value;
    };
    addEventListener("dragover", over);
    addEventListener("dragleave", leave);
    addEventListener("drop", drop);
    addEventListener("keydown", keys);
    return () => {
      removeEventListener("dragover", over);
      removeEventListener("dragleave", leave);
      removeEventListener("drop", drop);
      removeEventListener("keydown", keys);
    };
  }, []);
  const selected = app.selected.value;
  const tape = app.tape.value;
  const hasPanels = app.panels.value.length > 0;
  return (
    <div class={`app${hasPanels ? " with-panels" : ""}${showsLog.value ? "" : " without-log"}`}>
      <a class="skip" href="#main" onClick={(event) => { event.preventDefault(); document.querySelector<HTMLElement>("main")?.focus(); }}>Skip to the object</a>
      <header class="top">
        <h1>Inspector</h1>
        <ConnectBar app={app} />
        <Tools app={app} onOpen={open} showsLog={showsLog.value} onLog={() => { showsLog.value = !showsLog.value; }} showsHelp={showsHelp.value} onHelp={() => { showsHelp.value = !showsHelp.value; }} />
      </header>
      <nav aria-label="Devices">
        <Tree app={app} />
        {app.devices.value.length > 0 ? <button type="button" class="small" onClick={() => { app.selected.value = undefined; }}>Connect to another…</button> : null}
      </nav>
      <main id="main" tabIndex={-1}>
        {showsHelp.value ? <Help /> : null}
        {app.notice.value === "" ? null : (
          <p class="notice" role="status">
            {app.notice.value} <button type="button" class="small quiet" onClick={() => { app.notice.value = ""; }}>Close</button>
          </p>
        )}
        {reading.value === undefined ? null : <p role="status">Reading the recording… <progress max={1} value={reading.value} aria-label="Part that is read" /></p>}
        <Failure app={app} />
        {tape ? <TapeView app={app} tape={tape} /> : selected ? <ObjectView key={`${selected.device.url} ${selected.path}`} app={app} object={selected} /> : <Welcome app={app} />}
      </main>
      {hasPanels ? (
        <aside aria-label="Plots and pictures">
          <Panels app={app} />
        </aside>
      ) : null}
      {showsLog.value ? (
        <footer>
          <LogView app={app} />
        </footer>
      ) : null}
      <div class="visually-hidden" role="status" aria-live="polite">{app.announcement.value}</div>
      {isDragged.value ? <div class="drop">Drop a recording (.rrtape) to open it</div> : null}
    </div>
  );
}

interface ToolsProps {
  readonly app: App;
  readonly onOpen: (file: File | undefined) => void;
  readonly showsLog: boolean;
  readonly onLog: () => void;
  readonly showsHelp: boolean;
  readonly onHelp: () => void;
}

function Tools({ app, onOpen, showsLog, onLog, showsHelp, onHelp }: ToolsProps): VNode {
  const file = useRef<HTMLInputElement>(null);
  const theme = useSignal(currentTheme());
  const size = app.recorder.size.value;
  const record = (): void => {
    if (size === undefined) {
      app.startRecording();
      return;
    }
    const bytes = app.stopRecording();
    if (bytes) save(`inspector-${new Date().toISOString().replaceAll(/[:.]/g, "-").slice(0, 19)}.rrtape`, bytes, "application/octet-stream");
  };
  return (
    <div class="tools">
      <button type="button" aria-pressed={size !== undefined} class={size === undefined ? "" : "recording"} onClick={record}>
        {size === undefined ? "Record" : `Save ${sizeText(size)}`}
      </button>
      <button type="button" onClick={() => { file.current?.click(); }}>Open recording…</button>
      <input ref={file} id="tape-file" type="file" accept=".rrtape" class="visually-hidden" tabIndex={-1} aria-label="Recording to open" onChange={(event) => { onOpen(event.currentTarget.files?.[0]); event.currentTarget.value = ""; }} />
      <button type="button" aria-pressed={showsLog} onClick={onLog}>Log</button>
      <button type="button" aria-label={`Colors: ${theme.value}`} onClick={() => { theme.value = nextTheme(theme.value); setTheme(theme.value); }}>{themeWords[theme.value]}</button>
      <button type="button" aria-expanded={showsHelp} aria-label="Keys" onClick={onHelp}>?</button>
    </div>
  );
}

const themeWords = { system: "System", light: "Light", dark: "Dark" } as const;

function Help(): VNode {
  return (
    <section class="card" aria-label="Keys">
      <h2>Keys</h2>
      <dl class="keys">
        <dt><kbd>/</kbd></dt><dd>address</dd>
        <dt><kbd>t</kbd></dt><dd>tree of objects; arrows walk through it, Enter selects</dd>
        <dt><kbd>m</kbd></dt><dd>the object</dd>
        <dt><kbd>f</kbd></dt><dd>filter members</dd>
        <dt><kbd>←</kbd> <kbd>→</kbd></dt><dd>in a plot: the newer cursor, with Shift the older one; in 3-D all arrows turn, <kbd>+</kbd> and <kbd>−</kbd> zoom</dd>
        <dt><kbd>?</kbd></dt><dd>this list</dd>
      </dl>
    </section>
  );
}
