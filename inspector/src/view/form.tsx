// SPDX-License-Identifier: Apache-2.0
// Forms made from types.
import type { ComponentChildren, VNode } from "preact";
import { useId, useMemo } from "preact/hooks";
import type { Definitions, EnumType, ValueType } from "@robdef/runtime";
import { emptyDraft, mayBeNull, rangeOf, splitNumbers, type Draft, type Problem } from "../model/draft.js";
import { isBounded, item, shortType } from "../model/types.js";
import { unitIn } from "../model/members.js";

export interface FormProps {
  readonly definitions: Definitions;
  readonly type: ValueType;
  readonly draft: Draft;
  readonly onChange: (draft: Draft) => void;
  readonly problems: readonly Problem[];
  /** Where the value is in the whole, as problems name it. */
  readonly where: string;
  readonly label: string;
  readonly doc?: string;
}

/** Blocks of up to so many numbers are a grid of fields. */
const mostCells = 64;

/** Fields with longer texts block a browser. */
const mostRowText = 50_000;

/** What a value of a type is entered in. */
export function ValueForm(props: FormProps): VNode {
  const { type, draft, onChange, label } = props;
  if (draft.kind === "null") {
    return (
      <Part {...props}>
        <span class="null">null</span>
        <button type="button" class="small" onClick={() => { onChange(type.base.kind === "any" && type.container === "none" ? { kind: "any", type: "double", value: { kind: "text", text: "0" } } : filled(type)); }}>
          Give {label} a value
        </button>
      </Part>
    );
  }
  if (type.container === "list") return <Items {...props} itemType={item(type)} isFixed={false} />;
  if (type.container !== "none") return <MapItems {...props} />;
  const { base, array } = type;
  if (base.kind === "any") return <Any {...props} />;
  if (array.kind === "dims") return <Block {...props} />;
  if (array.kind === "array") {
    if (base.kind === "number") return <Row {...props} />;
    return <Items {...props} itemType={item(type)} isFixed={isBounded(array) && !array.isMaximum} />;
  }
  switch (base.kind) {
    case "enum":
      return <Choice {...props} choices={base.enum} />;
    case "record":
      return <Fields {...props} />;
    case "number":
      return base.number === "bool" ? <Check {...props} /> : <Line {...props} />;
    default:
      return <TextArea {...props} />;
  }
}

/** Not null, so that something can be entered. */
function filled(type: ValueType): Draft {
  const made = emptyDraft(type);
  return made.kind === "null" ? emptyDraft(type, -8) : made;
}

function problemOf({ problems, where }: FormProps): string {
  return problems.find((one) => one.where === where)?.text ?? "";
}

/** A group with its label, for parts that are several fields. */
function Part(props: FormProps & { children: ComponentChildren }): VNode {
  const { label, type, draft, onChange, doc } = props;
  const problem = problemOf(props);
  return (
    <fieldset class="part">
      <legend>
        {label} <span class="type">{shortType(type)}</span>
        {mayBeNull(type) && draft.kind !== "null" ? (
          <button type="button" class="small quiet" onClick={() => { onChange({ kind: "null" }); }} aria-label={`Make ${label} null`}>
            null
          </button>
        ) : null}
      </legend>
      {doc ? <p class="doc">{doc}</p> : null}
      {props.children}
      {problem === "" ? null : <p class="problem" role="alert">{problem}</p>}
    </fieldset>
  );
}

function hintOf({ type, doc = "" }: FormProps): string {
  const { base } = type;
  const unit = unitIn(doc);
  const range = base.kind === "number" ? rangeOf(base.number) : undefined;
  const words = range && (base.kind !== "number" || !base.number.includes("64")) ? `${range[0]} to ${range[1]}` : "";
  return [unit, words].filter((one) => one !== "").join(", ");
}

/** A label, a field and what is wrong with it. */
function Field(props: FormProps & { render: (id: string, described: string | undefined, isWrong: boolean) => VNode; after?: ComponentChildren }): VNode {
  const id = useId();
  const problem = problemOf(props);
  const hint = hintOf(props);
  const described = [problem === "" ? "" : `${id}-problem`, hint === "" ? "" : `${id}-hint`].filter((one) => one !== "").join(" ");
  return (
    <div class="field">
      <label for={id} title={props.doc || undefined}>
        {props.label} <span class="type">{shortType(props.type)}</span>
      </label>
      <div class="entry">
        {props.render(id, described === "" ? undefined : described, problem !== "")}
        {props.after}
        {hint === "" ? null : <span class="hint" id={`${id}-hint`}>{hint}</span>}
      </div>
      {problem === "" ? null : <p class="problem" id={`${id}-problem`} role="alert">{problem}</p>}
    </div>
  );
}

function textIn(draft: Draft): string {
  return draft.kind === "text" ? draft.text : "";
}

function Line(props: FormProps): VNode {
  const { draft, onChange } = props;
  return (
    <Field
      {...props}
      render={(id, described, isWrong) => (
        <input id={id} type="text" inputMode="decimal" autocomplete="off" spellcheck={false} value={textIn(draft)} aria-describedby={described} aria-invalid={isWrong} onInput={(event) => { onChange({ kind: "text", text: event.currentTarget.value }); }} />
      )}
    />
  );
}

function TextArea(props: FormProps): VNode {
  const { draft, onChange } = props;
  const text = textIn(draft);
  return (
    <Field
      {...props}
      render={(id, described, isWrong) => (
        <textarea id={id} rows={Math.min(8, text.split("\n").length)} spellcheck={false} value={text} aria-describedby={described} aria-invalid={isWrong} onInput={(event) => { onChange({ kind: "text", text: event.currentTarget.value }); }} />
      )}
    />
  );
}

function Check(props: FormProps): VNode {
  const { draft, onChange } = props;
  return (
    <Field
      {...props}
      render={(id, described) => (
        <input id={id} type="checkbox" checked={draft.kind === "bool" && draft.on} aria-describedby={described} onChange={(event) => { onChange({ kind: "bool", on: event.currentTarget.checked }); }} />
      )}
    />
  );
}

function Choice(props: FormProps & { choices: EnumType }): VNode {
  const { draft, onChange, choices } = props;
  const text = textIn(draft);
  const isKnown = choices.values.some((one) => String(one.value) === text);
  return (
    <Field
      {...props}
      render={(id, described, isWrong) => (
        <select id={id} value={text} aria-describedby={described} aria-invalid={isWrong} onChange={(event) => { onChange({ kind: "text", text: event.currentTarget.value }); }}>
          {isKnown ? null : <option value={text}>{text} (no name)</option>}
          {choices.values.map((one) => (
            <option key={one.name} value={String(one.value)} title={one.doc || undefined}>
              {one.name} ({one.value})
            </option>
          ))}
        </select>
      )}
    />
  );
}

function Row(props: FormProps): VNode {
  const { draft, onChange, type } = props;
  const text = textIn(draft);
  const count = useMemo(() => splitNumbers(text).length, [text]);
  const { array } = type;
  if (text.length > mostRowText) {
    return (
      <Part {...props}>
        <span class="hint">{count} numbers, too many to edit here; they stay as they are.</span>{" "}
        <button type="button" class="small" onClick={() => { onChange({ kind: "text", text: "" }); }}>Replace {props.label}</button>
      </Part>
    );
  }
  const wanted = array.kind === "array" && array.length !== undefined ? ` of ${array.isMaximum ? "at most " : ""}${array.length}` : "";
  // Problems of single items are shown with the row.
  const inside = props.problems.filter((one) => one.where.startsWith(`${props.where}[`));
  const problems = inside.length > 0 ? [...props.problems, ...inside.slice(0, 1).map((one) => ({ where: props.where, text: `item ${one.where.slice(props.where.length)}: ${one.text}` }))] : props.problems;
  return (
    <Field
      {...props}
      problems={problems}
      after={<span class="hint">{count}{wanted} {count === 1 ? "number" : "numbers"}</span>}
      render={(id, described, isWrong) => (
        <textarea id={id} class="numbers" rows={Math.min(6, Math.max(1, Math.ceil(text.length / 60)))} spellcheck={false} value={text} aria-describedby={described} aria-invalid={isWrong} placeholder="1, 2, 3" onInput={(event) => { onChange({ kind: "text", text: event.currentTarget.value }); }} />
      )}
    />
  );
}

function Block(props: FormProps): VNode {
  const { draft, onChange, type, label, where, problems } = props;
  const id = useId();
  if (draft.kind !== "block") return <Part {...props}>{null}</Part>;
  const { array, base } = type;
  const dims = array.kind === "dims" ? array.dims : undefined;
  const [rows = 0, columns = 0] = dims ?? [];
  const inside = problems.find((one) => one.where.startsWith(`${where}[`));
  if (dims?.length === 2 && base.kind === "number" && rows * columns <= mostCells) {
    const cells = draft.text.split("\n").map((line) => line.split(",").map((one) => one.trim()));
    const change = (row: number, column: number, text: string): void => {
      const changed = Array.from({ length: rows }, (_, r) => Array.from({ length: columns }, (_, c) => (r === row && c === column ? text.replace(/[,;\n]/g, " ") : (cells[r]?.[c] ?? "0"))).join(", "));
      onChange({ ...draft, text: changed.join("\n") });
    };
    return (
      <Part {...props}>
        <table class="matrix" aria-label={label}>
          <tbody>
            {Array.from({ length: rows }, (_, r) => (
              <tr key={r}>
                {Array.from({ length: columns }, (_, c) => (
                  <td key={c}>
                    <input type="text" inputMode="decimal" aria-label={`${label}, row ${r}, column ${c}`} aria-invalid={problems.some((one) => one.where === `${where}[${r}, ${c}]`)} value={cells[r]?.[c] ?? "0"} onInput={(event) => { change(r, c, event.currentTarget.value); }} />
                  </td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
        {inside ? <p class="problem" role="alert">{inside.where.slice(where.length)}: {inside.text}</p> : null}
      </Part>
    );
  }
  return (
    <Part {...props}>
      {dims ? null : (
        <div class="field">
          <label for={`${id}-dims`}>Dimensions</label>
          <input id={`${id}-dims`} type="text" value={draft.dims} placeholder="2 x 3" onInput={(event) => { onChange({ ...draft, dims: event.currentTarget.value }); }} />
        </div>
      )}
      <div class="field">
        <label for={`${id}-items`}>{base.kind === "number" ? "Numbers: a line for each row; with other than two dimensions the first index fastest" : "Items as JSON, the first index fastest"}</label>
        <textarea id={`${id}-items`} class="numbers" rows={Math.min(12, Math.max(2, draft.text.split("\n").length))} spellcheck={false} value={draft.text} onInput={(event) => { onChange({ ...draft, text: event.currentTarget.value }); }} />
      </div>
      {inside ? <p class="problem" role="alert">{inside.where.slice(where.length)}: {inside.text}</p> : null}
    </Part>
  );
}

function Fields(props: FormProps): VNode {
  const { draft, onChange, type, where } = props;
  const { base } = type;
  if (base.kind !== "record" || draft.kind !== "record") return <Part {...props}>{null}</Part>;
  return (
    <Part {...props}>
      {base.record.fields.map((field) => (
        <ValueForm
          key={field.name}
          definitions={props.definitions}
          type={field.type}
          draft={draft.fields[field.name] ?? emptyDraft(field.type)}
          problems={props.problems}
          where={where === "" ? field.name : `${where}.${field.name}`}
          label={field.name}
          doc={field.doc}
          onChange={(part) => { onChange({ kind: "record", fields: { ...draft.fields, [field.name]: part } }); }}
        />
      ))}
    </Part>
  );
}

function Items(props: FormProps & { itemType: ValueType; isFixed: boolean }): VNode {
  const { draft, onChange, itemType, isFixed, where, label } = props;
  const items = draft.kind === "items" ? draft.items : [];
  const change = (changed: readonly Draft[]): void => { onChange({ kind: "items", items: changed }); };
  return (
    <Part {...props}>
      {items.map((one, i) => (
        <div class="item" key={i}>
          <ValueForm definitions={props.definitions} type={itemType} draft={one} problems={props.problems} where={`${where}[${i}]`} label={`${label}[${i}]`} onChange={(part) => { change(items.map((old, at) => (at === i ? part : old))); }} />
          {isFixed ? null : <button type="button" class="small" aria-label={`Remove ${label}[${i}]`} onClick={() => { change(items.filter((_, at) => at !== i)); }}>Remove</button>}
        </div>
      ))}
      {isFixed ? null : <button type="button" class="small" onClick={() => { change([...items, emptyDraft(itemType)]); }}>Add an item to {label}</button>}
    </Part>
  );
}

function MapItems(props: FormProps): VNode {
  const { draft, onChange, type, where, label } = props;
  const id = useId();
  const items = draft.kind === "map" ? draft.items : [];
  const change = (changed: typeof items): void => { onChange({ kind: "map", items: changed }); };
  const nextKey = (): string => (type.container === "string" ? "" : String(items.reduce((most, one) => Math.max(most, Number(one.key) || 0), -1) + 1));
  return (
    <Part {...props}>
      {items.map((one, i) => {
        const problem = props.problems.find((each) => each.where === `${where}{${i}}`);
        return (
          <div class="item" key={i}>
            <div class="field key">
              <label for={`${id}-${i}`}>Key</label>
              <input id={`${id}-${i}`} type="text" value={one.key} aria-invalid={problem !== undefined} onInput={(event) => { change(items.map((old, at) => (at === i ? { ...old, key: event.currentTarget.value } : old))); }} />
              {problem ? <p class="problem" role="alert">{problem.text}</p> : null}
            </div>
            <ValueForm definitions={props.definitions} type={item(type)} draft={one.value} problems={props.problems} where={`${where}[${one.key}]`} label={`${label}[${one.key}]`} onChange={(part) => { change(items.map((old, at) => (at === i ? { ...old, value: part } : old))); }} />
            <button type="button" class="small" aria-label={`Remove ${label}[${one.key}]`} onClick={() => { change(items.filter((_, at) => at !== i)); }}>Remove</button>
          </div>
        );
      })}
      <button type="button" class="small" onClick={() => { change([...items, { key: nextKey(), value: emptyDraft(item(type)) }]); }}>Add an item to {label}</button>
    </Part>
  );
}

const commonTypes = ["double", "double[]", "int32", "int32[]", "bool[]", "string", "uint8[]", "double[*]", "varvalue{list}", "varvalue{string}", "varvalue{int32}"];

function Any(props: FormProps): VNode {
  const { draft, onChange, definitions, where } = props;
  const id = useId();
  if (draft.kind !== "any") return <Part {...props}>{null}</Part>;
  let inner: ValueType | undefined;
  try {
    inner = definitions.type(draft.type.trim());
  } catch {
    inner = undefined;
  }
  const rename = (type: string): void => {
    let value: Draft = draft.value;
    try {
      value = emptyDraft(definitions.type(type.trim()));
    } catch {
      // Not a type yet.
    }
    onChange({ kind: "any", type, value });
  };
  return (
    <Part {...props}>
      <div class="field">
        <label for={id}>Type of the value</label>
        <input id={id} type="text" list={`${id}-types`} value={draft.type} spellcheck={false} onInput={(event) => { rename(event.currentTarget.value); }} />
        <datalist id={`${id}-types`}>{commonTypes.map((one) => <option key={one} value={one} />)}</datalist>
      </div>
      {inner ? <ValueForm definitions={definitions} type={inner} draft={draft.value} problems={props.problems} where={where} label="value" onChange={(value) => { onChange({ ...draft, value }); }} /> : null}
    </Part>
  );
}
