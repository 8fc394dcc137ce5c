// SPDX-License-Identifier: Apache-2.0
// Objects of all devices, as a tree that the keyboard walks through.
import type { VNode } from "preact";
import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import type { Member } from "@robdef/runtime";
import type { App } from "../model/app.js";
import type { DeviceObject } from "../model/device.js";
import { errorText } from "../model/errors.js";
import { shortName } from "../model/types.js";

export function Tree({ app }: { app: App }): VNode {
  const list = useRef<HTMLUListElement>(null);
  const onKey = (event: KeyboardEvent): void => {
    const items = [...(list.current?.querySelectorAll<HTMLElement>("[role=treeitem]") ?? [])];
    const at = items.findIndex((one) => one === document.activeElement);
    const current = items[at];
    if (!current) return;
    const expanded = current.getAttribute("aria-expanded");
    const go = (to: HTMLElement | undefined): void => {
      if (!to) return;
      event.preventDefault();
      to.focus();
    };
    if (event.key === "ArrowDown") go(items[at + 1]);
    else if (event.key === "ArrowUp") go(items[at - 1]);
    else if (event.key === "Home") go(items[0]);
    else if (event.key === "End") go(items.at(-1));
    else if (event.key === "ArrowRight" && expanded === "true") go(items[at + 1]);
    else if (event.key === "ArrowLeft" && expanded !== "true") go(items.slice(0, at).reverse().find((one) => Number(one.ariaLevel) < Number(current.ariaLevel)));
    else if ((event.key === "ArrowRight" && expanded === "false") || (event.key === "ArrowLeft" && expanded === "true")) {
      event.preventDefault();
      current.querySelector<HTMLElement>(".twisty")?.click();
    } else if (event.key === "Enter" || event.key === " ") {
      if (event.target !== current) return;
      event.preventDefault();
      current.querySelector<HTMLElement>(".node")?.click();
    }
  };
  const roots = app.devices.value.flatMap((device) => (device.root.value ? [device.root.value] : []));
  if (roots.length === 0) return <p class="empty">Nothing is connected.</p>;
  return (
    <ul role="tree" aria-label="Objects of connected devices" class="tree" ref={list} onKeyDown={onKey}>
      {roots.map((root, i) => (
        <TreeNode key={root.device.url} app={app} object={root} level={1} isFirst={i === 0} />
      ))}
    </ul>
  );
}

function TreeNode({ app, object, level, isFirst }: { app: App; object: DeviceObject; level: number; isFirst: boolean }): VNode {
  const objrefs = object.members.filter((member) => member.kind === "objref");
  const isOpen = useSignal(level === 1);
  const problem = useSignal("");
  const isSelected = app.selected.value === object;
  const probed = useRef(false);
  const open = (): void => {
    if (probed.current) return;
    probed.current = true;
    for (const member of objrefs) {
      object.probe(member).catch((error: unknown) => {
        problem.value = errorText(error);
      });
    }
  };
  if (isOpen.value && object.device.state.value === "open") open();
  const isTabStop = isSelected || (isFirst && !app.selected.value);
  return (
    <li role="none">
      <div role="treeitem" class={`line${isSelected ? " selected" : ""}`} aria-level={level} aria-selected={isSelected} tabIndex={isTabStop ? 0 : -1} {...(objrefs.length > 0 ? { "aria-expanded": isOpen.value } : {})}>
        {objrefs.length > 0 ? (
          <span class="twisty" aria-hidden="true" onClick={() => { isOpen.value = !isOpen.value; }}>{isOpen.value ? "▾" : "▸"}</span>
        ) : (
          <span class="twisty" aria-hidden="true" />
        )}
        <span class="node" onClick={() => { app.selected.value = object; }}>
          <span class="title">{object.title}</span> <span class="type">{shortName(object.type)}</span>
          {object.lock.value === "" ? null : <span class="lock" title={`locked by this ${object.lock.value}`}>locked</span>}
        </span>
      </div>
      {isOpen.value && objrefs.length > 0 ? (
        <ul role="group">
          {problem.value === "" ? null : <li role="none" class="problem">{problem.value}</li>}
          {object.children.value.map((child) => (
            <TreeNode key={child.path} app={app} object={child} level={level + 1} isFirst={false} />
          ))}
        </ul>
      ) : null}
    </li>
  );
}

/** Opens an object whose index only a person knows. */
export function ObjrefCard({ app, object, member }: { app: App; object: DeviceObject; member: Member }): VNode {
  const index = useSignal(member.index === "int32" ? "0" : "");
  const problem = useSignal("");
  const known = object.children.value.filter((child) => child.steps.at(-1)?.objref === member.name);
  const open = (event: Event): void => {
    event.preventDefault();
    const wanted = member.index === "none" ? undefined : member.index === "int32" ? Number(index.value) : index.value;
    if (typeof wanted === "number" && !Number.isInteger(wanted)) {
      problem.value = `"${index.value}" is no whole number`;
      return;
    }
    problem.value = "";
    object.open(member.name, wanted).then(
      (made) => {
        app.selected.value = made;
      },
      (error: unknown) => {
        problem.value = errorText(error);
      },
    );
  };
  return (
    <form class="objref" onSubmit={open} aria-label={`Open ${member.name}`}>
      {known.map((child) => (
        <button key={child.path} type="button" class="link" onClick={() => { app.selected.value = child; }}>{child.title}</button>
      ))}
      {member.index === "none" ? null : (
        <label>
          Index <input type="text" value={index.value} class="short" onInput={(event) => { index.value = event.currentTarget.value; }} />
        </label>
      )}
      {member.index === "none" && known.length > 0 ? null : <button type="submit" class="small">Open</button>}
      {problem.value === "" ? null : <p class="problem" role="alert">{problem.value}</p>}
    </form>
  );
}
