// SPDX-License-Identifier: Apache-2.0
// Members of the object that is looked at, each as its kind is used.
import type { ComponentChildren, VNode } from "preact";
import { useSignal, type Signal } from "@preact/signals";
import { useEffect, useMemo } from "preact/hooks";
import type { Member, ValueType } from "@robdef/runtime";
import type { App } from "../model/app.js";
import type { DeviceObject } from "../model/device.js";
import { DraftReader, emptyDraft, fullDraft, type Draft, type Problem } from "../model/draft.js";
import { wordsOf, type Words } from "../model/errors.js";
import type { Argument } from "../model/history.js";
import { accessText, declarationOf, unitIn } from "../model/members.js";
import { isPlottable } from "../model/types.js";
import { isPictureType } from "../picture/picture.js";
import { isPoseType } from "../scene/poses.js";
import { ValueForm } from "./form.js";
import { ValueView } from "./value_view.js";

export interface MemberProps {
  readonly app: App;
  readonly object: DeviceObject;
  readonly member: Member;
}

/** Name, type, access and documentation of a member, and what it is used by. */
export function MemberCard({ member, children, actions }: MemberProps & { children?: ComponentChildren; actions?: ComponentChildren }): VNode {
  const access = accessText(member);
  return (
    <article class={`member ${member.kind}`} data-member={member.name} aria-label={`${member.kind} ${member.name}`}>
      <header>
        <h4>{member.name}</h4>
        <code class="declaration">{declarationOf(member)}</code>
        {access === "" ? null : <span class="badge">{access}</span>}
        {member.nolock ? <span class="badge" title="Locks leave it alone">no lock</span> : null}
        {member.isUnreliable ? <span class="badge">unreliable</span> : null}
        <span class="actions">{actions}</span>
      </header>
      {member.doc === "" ? null : <p class="doc">{member.doc}</p>}
      {children}
    </article>
  );
}

export function ErrorWords({ words }: { words: Words | undefined }): VNode | null {
  if (!words) return null;
  return (
    <p class="problem" role="alert">
      <b>{words.name}</b> {words.text}
      {words.hint === undefined ? null : <span class="hint"> {words.hint}</span>}
    </p>
  );
}

/** Buttons that show a member's values elsewhere on the page. */
export function ShowButtons({ app, object, member }: MemberProps): VNode {
  const { type } = member;
  // Pictures have numbers and poses, too, which nobody means.
  const isPicture = isPictureType(type);
  return (
    <>
      {!isPicture && isPlottable(type) && !member.isWriteonly ? <button type="button" class="small" aria-label={`Plot ${member.name}`} onClick={() => { app.show("plot", object, member); }}>Plot</button> : null}
      {isPicture && !member.isWriteonly ? <button type="button" class="small" aria-label={`Show ${member.name} as a picture`} onClick={() => { app.show("picture", object, member); }}>Picture</button> : null}
      {!isPicture && isPoseType(type) && !member.isWriteonly ? <button type="button" class="small" aria-label={`Show ${member.name} in 3-D`} onClick={() => { app.show("scene", object, member); }}>3-D</button> : null}
    </>
  );
}

/** Drafts of one or several values, with their problems. */
export function useDrafts(object: DeviceObject, parts: readonly { readonly name: string; readonly type: ValueType }[]): {
  readonly drafts: Signal<readonly Draft[]>;
  readonly problems: Signal<readonly Problem[]>;
  /** The values, or undefined when there are problems, which are shown then. */
  read: () => Argument[] | undefined;
  forms: () => VNode[];
} {
  const drafts = useSignal<readonly Draft[]>(useMemo(() => parts.map(({ type }) => emptyDraft(type)), []));
  const problems = useSignal<readonly Problem[]>([]);
  const check = (given: readonly Draft[]): { values: Argument[]; found: readonly Problem[] } => {
    const reader = new DraftReader(object.device.definitions);
    const values = parts.map(({ name, type }, i) => ({ name, type, value: reader.value(type, given[i] ?? emptyDraft(type), name) }));
    return { values, found: reader.problems };
  };
  return {
    drafts,
    problems,
    read: () => {
      const { values, found } = check(drafts.value);
      problems.value = found;
      return found.length > 0 ? undefined : values;
    },
    forms: () =>
      parts.map(({ name, type }, i) => (
        <ValueForm
          key={name}
          definitions={object.device.definitions}
          type={type}
          draft={drafts.value[i] ?? emptyDraft(type)}
          problems={problems.value}
          where={name}
          label={name}
          onChange={(draft) => {
            drafts.value = drafts.value.map((old, at) => (at === i ? draft : old));
            // What was wrong is checked while it is typed.
            if (problems.value.length > 0) problems.value = check(drafts.value).found;
          }}
        />
      )),
  };
}

export function PropertyCard(props: MemberProps): VNode {
  const { app, object, member } = props;
  const value = useSignal<unknown>(undefined);
  const words = useSignal<Words | undefined>(undefined);
  /** Of a set; reading, which goes on, does not take it away. */
  const refusal = useSignal<Words | undefined>(undefined);
  const isEditing = useSignal(false);
  const isLive = app.live.value;
  const form = useDrafts(object, [{ name: member.name, type: member.type }]);
  const get = async (isLogged: boolean): Promise<void> => {
    try {
      const read = (): Promise<unknown> => object.remote.get(member.name);
      value.value = await (isLogged ? object.run("get", member, [], read) : read());
      words.value = undefined;
    } catch (error) {
      words.value = wordsOf(error);
    }
  };
  useEffect(() => {
    if (member.isWriteonly) return undefined;
    let timer: ReturnType<typeof setTimeout> | undefined;
    let isOver = false;
    const round = async (): Promise<void> => {
      const begin = performance.now();
      // A page that nobody sees asks for nothing.
      if (!document.hidden && object.device.state.value === "open") await get(false);
      const took = performance.now() - begin;
      // The dependency on the state ends the rounds of this effect.
      if (!isOver && isLive) timer = setTimeout(() => void round(), Math.max(1000, 10 * took));
    };
    void round();
    return () => {
      isOver = true;
      clearTimeout(timer);
    };
  }, [object.remote, member.name, isLive]);
  const edit = (): void => {
    isEditing.value = !isEditing.value;
    form.problems.value = [];
    refusal.value = undefined;
    if (isEditing.value && value.value !== undefined) form.drafts.value = [fullDraft(object.device.definitions, member.type, value.value)];
  };
  const set = (event: Event): void => {
    event.preventDefault();
    const args = form.read();
    if (!args) return;
    object.run("set", member, args, () => object.remote.set(member.name, args[0]?.value)).then(
      () => {
        refusal.value = undefined;
        app.announcement.value = `${member.name} is set`;
        if (!member.isWriteonly) void get(false);
      },
      (error: unknown) => {
        refusal.value = wordsOf(error);
      },
    );
  };
  return (
    <MemberCard
      {...props}
      actions={
        <>
          <ShowButtons {...props} />
          {member.isWriteonly ? null : <button type="button" class="small" aria-label={`Get ${member.name}`} onClick={() => void get(true)}>Get</button>}
          {member.isReadonly ? null : <button type="button" class="small" aria-label={`Edit ${member.name}`} aria-expanded={isEditing.value} onClick={edit}>Edit</button>}
        </>
      }
    >
      {member.isWriteonly ? null : (
        <div class="current">
          <ValueView definitions={object.device.definitions} type={member.type} value={value.value} unit={unitIn(member.doc)} />
        </div>
      )}
      <ErrorWords words={words.value} />
      <ErrorWords words={refusal.value} />
      {isEditing.value ? (
        <form onSubmit={set} aria-label={`Set ${member.name}`}>
          {form.forms()}
          <button type="submit" class="primary">Set {member.name}</button>
        </form>
      ) : null}
    </MemberCard>
  );
}

/** A form with parameters and what calling gave. */
export function FunctionCard(props: MemberProps): VNode {
  const { object, member, app } = props;
  const isOpen = useSignal(false);
  const result = useSignal<{ readonly value: unknown } | undefined>(undefined);
  const words = useSignal<Words | undefined>(undefined);
  const calling = useSignal<AbortController | undefined>(undefined);
  const form = useDrafts(object, member.parameters);
  const call = (event: Event): void => {
    event.preventDefault();
    const args = form.read();
    if (!args) return;
    const control = new AbortController();
    calling.value = control;
    words.value = undefined;
    object
      .run("call", member, args, () => object.remote.call(member.name, args.map((one) => one.value), { signal: control.signal }))
      .then(
        (value) => {
          result.value = { value };
          app.announcement.value = `${member.name} has answered`;
        },
        (error: unknown) => {
          result.value = undefined;
          words.value = wordsOf(error);
        },
      )
      .finally(() => {
        calling.value = undefined;
      });
  };
  const isBusy = calling.value !== undefined;
  const hasForm = member.parameters.length > 0;
  return (
    <MemberCard
      {...props}
      actions={
        <>
          {isPictureType(member.type) && !hasForm ? <button type="button" class="small" aria-label={`Show ${member.name} as a picture, again and again`} onClick={() => { app.show("picture", object, member); }}>Picture</button> : null}
          {hasForm ? <button type="button" class="small" aria-expanded={isOpen.value} aria-label={`Call ${member.name} with…`} onClick={() => { isOpen.value = !isOpen.value; }}>Call…</button> : <button type="button" class="small" disabled={isBusy} aria-label={`Call ${member.name}`} onClick={call}>Call</button>}
          {isBusy ? <button type="button" class="small" onClick={() => { calling.value?.abort(new Error("stopped waiting")); }}>Stop waiting</button> : null}
        </>
      }
    >
      {hasForm && isOpen.value ? (
        <form onSubmit={call} aria-label={`Call ${member.name}`}>
          {form.forms()}
          <button type="submit" class="primary" disabled={isBusy}>{isBusy ? "Waiting…" : `Call ${member.name}`}</button>
        </form>
      ) : null}
      <ErrorWords words={words.value} />
      {result.value ? (
        <div class="result" aria-label={`Result of ${member.name}`}>
          <ValueView definitions={object.device.definitions} type={member.type} value={result.value.value} />
        </div>
      ) : null}
    </MemberCard>
  );
}

