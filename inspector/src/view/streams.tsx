// SPDX-License-Identifier: Apache-2.0
// Members that bring values over time: wires, pipes, events, callbacks, generators.
import type { VNode } from "preact";
import { useSignal, useSignalEffect } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import type { RemoteGenerator } from "@robdef/runtime";
import { wordsOf, type Words } from "../model/errors.js";
import { unitIn } from "../model/members.js";
import type { Feed } from "../model/feed.js";
import { valueText } from "../model/value_text.js";
import { clock } from "./clock.js";
import { ErrorWords, MemberCard, ShowButtons, useDrafts, type MemberProps } from "./members.js";
import { ValueView } from "./value_view.js";

/** A wire or a pipe: watched, peeked, sent to. */
export function StreamCard(props: MemberProps): VNode {
  const { app, object, member } = props;
  const watched = useSignal<{ readonly feed: Feed; readonly stop: () => void } | undefined>(undefined);
  const words = useSignal<Words | undefined>(undefined);
  const peeked = useSignal<{ readonly value: unknown } | undefined>(undefined);
  const isSending = useSignal(false);
  const form = useDrafts(object, [{ name: member.name, type: member.type }]);
  useEffect(
    () => () => {
      watched.value?.stop();
      watched.value = undefined;
    },
    [object.remote],
  );
  const isWire = member.kind === "wire";
  const watch = (): void => {
    if (watched.value) {
      watched.value.stop();
      watched.value = undefined;
      return;
    }
    const feed = app.feeds.of(object, member);
    watched.value = { feed, stop: feed.use() };
  };
  const peek = (): void => {
    object.run("peek", member, [], () => object.remote.wire(member.name).peekIn()).then(
      (found) => {
        peeked.value = { value: found.value };
        words.value = undefined;
      },
      (error: unknown) => {
        words.value = wordsOf(error);
      },
    );
  };
  const send = (event: Event): void => {
    event.preventDefault();
    const args = form.read();
    if (!args) return;
    const value = args[0]?.value;
    const action = async (): Promise<void> => {
      if (isWire) {
        await object.remote.wire(member.name).pokeOut(value);
        return;
      }
      const feed = app.feeds.of(object, member);
      const known = feed.pipeEnd;
      const end = known && !known.isClosed ? known : await object.remote.pipe(member.name).connect();
      end.send(value);
      if (end !== known) await end.close();
    };
    object.run(isWire ? "poke" : "send", member, args, action).then(
      () => {
        words.value = undefined;
        app.announcement.value = `${member.name} is sent`;
      },
      (error: unknown) => {
        words.value = wordsOf(error);
      },
    );
  };
  const { value: use } = watched;
  const shown = use?.feed.shown.value;
  const current = shown ?? peeked.value;
  return (
    <MemberCard
      {...props}
      actions={
        <>
          <ShowButtons {...props} />
          {member.isWriteonly ? null : <button type="button" class="small" aria-label={`${use ? "Stop" : "Watch"} ${member.name}`} onClick={watch}>{use ? "Stop" : "Watch"}</button>}
          {isWire && !member.isWriteonly ? <button type="button" class="small" aria-label={`Peek ${member.name}`} onClick={peek}>Peek</button> : null}
          {member.isReadonly ? null : <button type="button" class="small" aria-expanded={isSending.value} aria-label={`${isWire ? "Poke" : "Send"} ${member.name}…`} onClick={() => { isSending.value = !isSending.value; }}>{isWire ? "Poke…" : "Send…"}</button>}
        </>
      }
    >
      {current ? (
        <div class="current">
          <ValueView definitions={object.device.definitions} type={member.type} value={current.value} unit={unitIn(member.doc)} />
        </div>
      ) : null}
      {use ? (
        <p class="hint stream-state">
          {use.feed.state.value === "failed" ? use.feed.problem.value : use.feed.state.value === "connecting" ? "connecting…" : use.feed.state.value === "closed" ? "closed by the service" : `${Math.round(use.feed.rate.value)} a second`}
          {shown ? `, ${use.feed.timeSource === "device" ? "device's" : "arrival"} time ${clock(shown.seconds)}` : ""}
        </p>
      ) : null}
      <ErrorWords words={words.value} />
      {isSending.value ? (
        <form onSubmit={send} aria-label={`${isWire ? "Poke" : "Send"} ${member.name}`}>
          {form.forms()}
          <button type="submit" class="primary">{isWire ? "Poke" : "Send"} {member.name}</button>
        </form>
      ) : null}
    </MemberCard>
  );
}

const mostEvents = 100;

/** Events as they come. They are listened to while the object is looked at. */
export function EventCard(props: MemberProps): VNode {
  const { object, member } = props;
  const events = useSignal<readonly { readonly id: number; readonly at: number; readonly args: readonly unknown[] }[]>([]);
  useEffect(() => {
    let id = 0;
    return object.remote.event(member.name).on((...args) => {
      events.value = [{ id: ++id, at: Date.now() / 1000, args }, ...events.value].slice(0, mostEvents);
    });
  }, [object.remote, member.name]);
  const { value: list } = events;
  return (
    <MemberCard {...props} actions={list.length > 0 ? <button type="button" class="small" aria-label={`Clear ${member.name}`} onClick={() => { events.value = []; }}>Clear</button> : undefined}>
      {list.length === 0 ? (
        <p class="empty">No event came since this object is shown.</p>
      ) : (
        <ol class="events" aria-label={`Events of ${member.name}`}>
          {list.map((one) => (
            <li key={one.id}>
              <time>{clock(one.at)}</time> {member.parameters.map(({ name, type }, i) => `${name}: ${valueText(type, one.args[i])}`).join(", ")}
            </li>
          ))}
        </ol>
      )}
    </MemberCard>
  );
}

interface Question {
  readonly id: number;
  readonly at: number;
  readonly args: readonly unknown[];
  readonly answer: (value: unknown) => void;
  readonly refuse: (error: Error) => void;
}

type Rule = "none" | "ask" | "fixed" | "refuse";

/** Calls of the service: answered by hand, or by a rule. */
export function CallbackCard(props: MemberProps): VNode {
  const { app, object, member } = props;
  const rule = useSignal<Rule>("none");
  const questions = useSignal<readonly Question[]>([]);
  const answered = useSignal(0);
  const isVoid = member.type.base.kind === "void";
  const form = useDrafts(object, isVoid ? [] : [{ name: "answer", type: member.type }]);
  useEffect(() => {
    let id = 0;
    const callback = object.remote.callback(member.name);
    const ask = (args: readonly unknown[]): Promise<unknown> =>
      new Promise((resolve, reject) => {
        const question: Question = { id: ++id, at: Date.now() / 1000, args, answer: resolve, refuse: reject };
        questions.value = [...questions.value, question];
        app.announcement.value = `${member.name} asks`;
      });
    callback.set(rule.value === "none" ? null : async (...args: unknown[]) => {
      ++answered.value;
      const kind = rule.peek();
      if (kind === "ask") return await ask(args);
      if (kind === "refuse") throw new Error("refused by a rule of the inspector");
      const fixed = form.read();
      if (!fixed) throw new Error("the fixed answer of the inspector is no value");
      return fixed[0]?.value;
    });
    return () => {
      callback.set(null);
      for (const one of questions.value) one.refuse(new Error("the inspector answers no more"));
      questions.value = [];
    };
  }, [object.remote, member.name, rule.value]);
  const finish = (question: Question): void => {
    questions.value = questions.value.filter((one) => one !== question);
  };
  const answer = (question: Question): void => {
    const args = form.read();
    if (!args) return;
    void object.run("answer", member, args, () => Promise.resolve());
    question.answer(args[0]?.value);
    finish(question);
  };
  return (
    <MemberCard
      {...props}
      actions={
        <label>
          Answer{" "}
          <select value={rule.value} aria-label={`How ${member.name} is answered`} onChange={(event) => { rule.value = event.currentTarget.value as Rule; }}>
            <option value="none">not</option>
            <option value="ask">by hand</option>
            <option value="fixed">always the same</option>
            <option value="refuse">with an error</option>
          </select>
        </label>
      }
    >
      {rule.value === "fixed" && !isVoid ? (
        <form onSubmit={(event) => { event.preventDefault(); }} aria-label={`Answer to ${member.name}`}>{form.forms()}</form>
      ) : null}
      {rule.value === "none" ? null : <p class="hint">{answered.value} {answered.value === 1 ? "call" : "calls"} so far</p>}
      {questions.value.map((question, i) => (
        <form class="question" key={question.id} aria-label={`Call of ${member.name}`} onSubmit={(event) => { event.preventDefault(); answer(question); }}>
          <p>
            <time>{clock(question.at)}</time> {member.name}({member.parameters.map(({ name, type }, at) => `${name}: ${valueText(type, question.args[at])}`).join(", ")})
          </p>
          {i === 0 && !isVoid ? form.forms() : null}
          <button type="submit" class="small primary" disabled={i > 0 && !isVoid}>Answer</button>
          <button type="button" class="small" onClick={() => { question.refuse(new Error("refused by a person")); finish(question); }}>Refuse</button>
        </form>
      ))}
    </MemberCard>
  );
}

const mostSteps = 200;

/** A function whose values come, or are taken, step by step. */
export function GeneratorCard(props: MemberProps): VNode {
  const { object, member } = props;
  const isOpen = useSignal(false);
  const generator = useSignal<RemoteGenerator | undefined>(undefined);
  const steps = useSignal<readonly { readonly id: number; readonly value: unknown }[]>([]);
  const count = useSignal(0);
  const state = useSignal<"idle" | "stepping" | "running" | "over">("idle");
  const words = useSignal<Words | undefined>(undefined);
  const takes = member.generator?.takes;
  const form = useDrafts(object, member.parameters);
  const stepForm = useDrafts(object, useMemo(() => (takes ? [{ name: "step", type: takes }] : []), [takes]));
  useSignalEffect(() => {
    if (state.value === "over") generator.value = undefined;
  });
  const fail = (error: unknown): void => {
    words.value = wordsOf(error);
    state.value = "over";
  };
  const begin = (event: Event): void => {
    event.preventDefault();
    const args = form.read();
    if (!args) return;
    words.value = undefined;
    object.run("generate", member, args, () => object.remote.generate(member.name, args.map((one) => one.value))).then((made) => {
      generator.value = made;
      steps.value = [];
      count.value = 0;
      state.value = "idle";
    }, fail);
  };
  const step = async (): Promise<boolean> => {
    const { value: current } = generator;
    const args = stepForm.read();
    if (!current || !args) return false;
    const next = await object.run("next", member, args, async () => {
      const found = await current.next(args[0]?.value);
      return found.done ? undefined : found;
    });
    if (!next) {
      state.value = "over";
      return false;
    }
    steps.value = [{ id: ++count.value, value: next.value }, ...steps.value].slice(0, mostSteps);
    return true;
  };
  const once = (): void => {
    state.value = "stepping";
    step().then((goesOn) => {
      if (goesOn || state.value === "stepping") state.value = "idle";
    }, fail);
  };
  const run = (): void => {
    state.value = "running";
    const loop = async (): Promise<void> => {
      while (state.peek() === "running" && (await step()));
    };
    loop().catch(fail);
  };
  const finish = (kind: "end" | "abort"): void => {
    const { value: current } = generator;
    if (!current) return;
    state.value = "over";
    object.run(kind, member, [], () => (kind === "end" ? current.close() : current.abort())).catch(fail);
  };
  const isBusy = state.value === "stepping" || state.value === "running";
  return (
    <MemberCard
      {...props}
      actions={
        <button type="button" class="small" aria-expanded={isOpen.value} aria-label={`Step through ${member.name}…`} onClick={() => { isOpen.value = !isOpen.value; }}>Step through…</button>
      }
    >
      {isOpen.value ? (
        <>
          <form onSubmit={begin} aria-label={`Begin ${member.name}`}>
            {form.forms()}
            <button type="submit" class={generator.value ? "" : "primary"}>{generator.value ? "Begin again" : `Begin ${member.name}`}</button>
          </form>
          {generator.value ? (
            <div class="stepping">
              {stepForm.forms()}
              <button type="button" class="primary" disabled={isBusy} onClick={once}>Next</button>
              {state.value === "running" ? <button type="button" onClick={() => { state.value = "idle"; }}>Pause</button> : takes ? null : <button type="button" disabled={isBusy} onClick={run}>Run to the end</button>}
              <button type="button" onClick={() => { finish("end"); }}>Close</button>
              <button type="button" onClick={() => { finish("abort"); }}>Abort</button>
            </div>
          ) : null}
          {state.value === "over" && !words.value ? <p class="hint">At its end after {count.value} {count.value === 1 ? "step" : "steps"}.</p> : null}
        </>
      ) : null}
      <ErrorWords words={words.value} />
      {steps.value.length > 0 && member.generator?.gives ? (
        <ol class="steps" aria-label={`Values of ${member.name}`}>
          {steps.value.map((one) => (
            <li key={one.id} value={one.id}>
              <ValueView definitions={object.device.definitions} type={member.type} value={one.value} />
            </li>
          ))}
        </ol>
      ) : null}
    </MemberCard>
  );
}
