// SPDX-License-Identifier: Apache-2.0
// Everything that was done to devices, newest last.
import { signal, type Signal } from "@preact/signals";
import type { Definitions, Member, ValueType } from "@robdef/runtime";

/** One objref on the way from a root object. */
export interface PathStep {
  readonly objref: string;
  readonly index: number | string | undefined;
}

export type OperationKind =
  | "connect"
  | "close"
  | "login"
  | "logout"
  | "lock"
  | "unlock"
  | "get"
  | "set"
  | "call"
  | "generate"
  | "next"
  | "end"
  | "abort"
  | "peek"
  | "poke"
  | "watch"
  | "send"
  | "answer"
  | "read"
  | "write";

/** An argument, or the value that is set. */
export interface Argument {
  readonly name: string;
  readonly type: ValueType;
  readonly value: unknown;
}

/** What was asked for. */
export interface Operation {
  readonly kind: OperationKind;
  readonly url: string;
  readonly definitions?: Definitions;
  /** From the root object to the one that was used. */
  readonly steps: readonly PathStep[];
  readonly objectType: string;
  /** Of the root object of the service. */
  readonly rootType?: string;
  readonly member?: Member;
  readonly args: readonly Argument[];
  /** Of a lock: whose; of a login: the user; of a memory: place and count. */
  readonly detail?: string;
}

export type Outcome = { readonly state: "pending" } | { readonly state: "done"; readonly text: string; readonly took: number } | { readonly state: "failed"; readonly text: string; readonly took: number };

export interface HistoryEntry {
  readonly id: number;
  /** Milliseconds since 1970. */
  readonly at: number;
  readonly operation: Operation;
  readonly outcome: Signal<Outcome>;
}

const most = 1000;

/** What was done, up to a limit: the oldest entries go first. */
export class History {
  readonly entries = signal<readonly HistoryEntry[]>([]);
  private last = 0;

  begin(operation: Operation): HistoryEntry {
    const entry: HistoryEntry = { id: ++this.last, at: Date.now(), operation, outcome: signal<Outcome>({ state: "pending" }) };
    this.entries.value = [...this.entries.value.slice(-(most - 1)), entry];
    return entry;
  }

  clear(): void {
    this.entries.value = [];
  }
}

/** The member with its object, as `tool.gripper.speed`. */
export function placeText(steps: readonly PathStep[], member?: string): string {
  const parts = steps.map(({ objref, index }) => (index === undefined ? objref : `${objref}[${escapedIndex(index)}]`));
  return [...parts, ...(member === undefined ? [] : [member])].join(".");
}

/** An index as the command line takes it. */
function escapedIndex(index: number | string): string {
  return String(index).replace(/[%\]]/g, (one) => `%${one.charCodeAt(0).toString(16).padStart(2, "0")}`);
}
