// SPDX-License-Identifier: Apache-2.0
// The object that is looked at.
import type { VNode } from "preact";
import { useSignal } from "@preact/signals";
import type { Member } from "@robdef/runtime";
import type { App } from "../model/app.js";
import type { DeviceObject, LockState } from "../model/device.js";
import { wordsOf, type Words } from "../model/errors.js";
import { placeText } from "../model/history.js";
import { kindTitles } from "../model/members.js";
import { DeviceHead } from "./connect_bar.js";
import { ErrorWords, FunctionCard, MemberCard, PropertyCard, type MemberProps } from "./members.js";
import { MemoryCard } from "./memory_card.js";
import { CallbackCard, EventCard, GeneratorCard, StreamCard } from "./streams.js";
import { ObjrefCard } from "./tree.js";

export function ObjectView({ app, object }: { app: App; object: DeviceObject }): VNode {
  const { device } = object;
  const doc = object.remote.type.doc || (object.steps.length === 0 ? definitionDoc(object) : "");
  const filter = useSignal("");
  const wanted = filter.value.trim().toLowerCase();
  const members = object.members.filter((one) => wanted === "" || one.name.toLowerCase().includes(wanted) || one.doc.toLowerCase().includes(wanted));
  return (
    <div class="object">
      <DeviceHead app={app} device={device} />
      <header class="object-head">
        <h2>{object.title}</h2>
        <code class="type">{object.type}</code>
        {object.steps.length > 0 ? <span class="hint">{placeText(object.steps)}</span> : null}
        <Locks object={object} />
        <label class="live">
          <input type="checkbox" checked={app.live.value} onChange={(event) => { app.live.value = event.currentTarget.checked; }} /> live values
        </label>
        <label>
          <span class="visually-hidden">Filter members</span>
          <input type="search" class="filter" placeholder="Filter members" value={filter.value} onInput={(event) => { filter.value = event.currentTarget.value; }} />
        </label>
      </header>
      {doc === "" ? null : <p class="doc">{doc}</p>}
      {object.members.length === 0 ? <p class="empty">This object has no members.</p> : null}
      {object.members.length > 0 && members.length === 0 ? <p class="empty">No member fits "{filter.value}".</p> : null}
      {kindTitles.map(([kind, title]) => {
        const found = members.filter((member) => member.kind === kind);
        if (found.length === 0) return null;
        return (
          <section key={kind} aria-label={title}>
            <h3>{title}</h3>
            {found.map((member) => (
              <Card key={`${object.path}/${member.name}`} app={app} object={object} member={member} />
            ))}
          </section>
        );
      })}
    </div>
  );
}

function definitionDoc(object: DeviceObject): string {
  return object.device.definitions.find(object.type.replace(/\.[^.]*$/, ""))?.doc ?? "";
}

function Card(props: MemberProps): VNode {
  const { member } = props;
  const Kind = cards[member.kind];
  return member.kind === "function" && member.generator ? <GeneratorCard {...props} /> : <Kind {...props} />;
}

const cards: Readonly<Record<Member["kind"], (props: MemberProps) => VNode>> = {
  property: PropertyCard,
  function: FunctionCard,
  wire: StreamCard,
  pipe: StreamCard,
  event: EventCard,
  callback: CallbackCard,
  memory: MemoryCard,
  objref: (props) => (
    <MemberCard {...props}>
      <ObjrefCard {...props} />
    </MemberCard>
  ),
};

function Locks({ object }: { object: DeviceObject }): VNode {
  const words = useSignal<Words | undefined>(undefined);
  const set = (wanted: LockState): void => {
    object.setLock(wanted).then(
      () => {
        words.value = undefined;
      },
      (error: unknown) => {
        words.value = wordsOf(error);
      },
    );
  };
  const isOpen = object.device.state.value === "open";
  return (
    <span class="locks">
      {object.lock.value === "" ? (
        <>
          <button type="button" class="small" disabled={!isOpen} title="Lock this object and all below it for this session alone" onClick={() => { set("session"); }}>Lock</button>
          {object.device.user.value === "" ? null : <button type="button" class="small" title="Lock it for all sessions of this user" onClick={() => { set("user"); }}>Lock for {object.device.user.value}</button>}
        </>
      ) : (
        <>
          <span class="badge locked">locked by this {object.lock.value}</span>
          <button type="button" class="small" onClick={() => { set(""); }}>Unlock</button>
        </>
      )}
      <ErrorWords words={words.value} />
    </span>
  );
}
