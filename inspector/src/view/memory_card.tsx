// SPDX-License-Identifier: Apache-2.0
// Memories: a part at a time, as a table or a picture.
import type { VNode } from "preact";
import { useSignal } from "@preact/signals";
import { ArrayMemory, MultiDimArray, type ValueType } from "@robdef/runtime";
import { DraftReader, draftOf, splitNumbers, type Draft, type Problem } from "../model/draft.js";
import { wordsOf, type Words } from "../model/errors.js";
import { item } from "../model/types.js";
import { grayPicture, type Picture } from "../picture/picture.js";
import { ErrorWords, MemberCard, type MemberProps } from "./members.js";
import { ValueForm } from "./form.js";
import { Matrix, PictureView, ValueView } from "./value_view.js";

const mostItems = 1 << 22;

function numbersIn(text: string): number[] {
  return splitNumbers(text.replaceAll("x", " ").replaceAll("×", " ")).map(Number);
}

export function MemoryCard(props: MemberProps): VNode {
  const { object, member } = props;
  const isRow = member.type.array.kind !== "dims";
  const size = useSignal<readonly number[] | undefined>(undefined);
  const at = useSignal(isRow ? "0" : "0, 0");
  const count = useSignal(isRow ? "100" : "");
  const part = useSignal<unknown>(undefined);
  const words = useSignal<Words | undefined>(undefined);
  const asPicture = useSignal(false);
  const columns = useSignal("");
  const draft = useSignal<Draft | undefined>(undefined);
  const problems = useSignal<readonly Problem[]>([]);
  const isNumbers = member.type.base.kind === "number";

  const attempt = (action: () => Promise<void>): void => {
    words.value = undefined;
    action().catch((error: unknown) => {
      words.value = wordsOf(error);
    });
  };
  const askSize = async (): Promise<readonly number[]> => {
    const memory = object.remote.memory(member.name);
    const found = memory instanceof ArrayMemory ? [await memory.length()] : await memory.dims();
    size.value = found;
    return found;
  };
  const read = async (): Promise<void> => {
    const whole = await askSize();
    const start = numbersIn(at.value);
    const wanted = count.value.trim() === "" ? whole.map((one, i) => one - (start[i] ?? 0)) : numbersIn(count.value);
    const clipped = isRow ? [Math.max(0, Math.min(wanted[0] ?? 0, (whole[0] ?? 0) - (start[0] ?? 0)))] : wanted;
    if (clipped.some((one) => !Number.isInteger(one) || one < 0) || start.some((one) => !Number.isInteger(one))) throw new Error("place and count are whole numbers");
    if (clipped.reduce((all, one) => all * one, 1) > mostItems) throw new Error(`at most ${mostItems} items are read at a time`);
    const memory = object.remote.memory(member.name);
    part.value = await object.run(
      "read",
      member,
      [],
      async (): Promise<unknown> => (memory instanceof ArrayMemory ? await memory.read(start[0] ?? 0, clipped[0] ?? 0) : await memory.read(whole.map((_, i) => start[i] ?? 0), clipped)),
      `${start.join(",")} ${clipped.join(",")}`,
    );
  };
  const write = async (): Promise<void> => {
    const reader = new DraftReader(object.device.definitions);
    const value = draft.value ? reader.value(member.type, draft.value, member.name) : undefined;
    problems.value = reader.problems;
    if (reader.problems.length > 0) return;
    const start = numbersIn(at.value);
    const memory = object.remote.memory(member.name);
    await object.run("write", member, [{ name: member.name, type: member.type, value }], () => (memory instanceof ArrayMemory ? memory.write(start[0] ?? 0, value as ArrayLike<unknown>) : memory.write(start, value as MultiDimArray)), start.join(","));
    draft.value = undefined;
    await read();
  };
  const { value } = part;
  return (
    <MemberCard
      {...props}
      actions={
        <>
          <button type="button" class="small" aria-label={`Read ${member.name}`} onClick={() => { attempt(read); }}>Read</button>
          {member.isReadonly || value === undefined ? null : <button type="button" class="small" aria-label={`Edit what was read of ${member.name}`} onClick={() => { draft.value = draft.value ? undefined : draftOf(member.type, value); }}>Edit</button>}
        </>
      }
    >
      <div class="memory-part">
        <label>
          From <input type="text" class="short" value={at.value} onInput={(event) => { at.value = event.currentTarget.value; }} />
        </label>
        <label>
          Count <input type="text" class="short" value={count.value} placeholder="all" onInput={(event) => { count.value = event.currentTarget.value; }} />
        </label>
        {size.value ? <span class="hint">{size.value.join(" × ")} items</span> : null}
        {isNumbers ? (
          <label>
            <input type="checkbox" checked={asPicture.value} onChange={(event) => { asPicture.value = event.currentTarget.checked; }} /> as a picture
          </label>
        ) : null}
        {isNumbers && isRow ? (
          <label>
            Columns <input type="text" class="short" value={columns.value} placeholder="1" onInput={(event) => { columns.value = event.currentTarget.value; }} />
          </label>
        ) : null}
      </div>
      <ErrorWords words={words.value} />
      {draft.value ? (
        <form aria-label={`Write ${member.name}`} onSubmit={(event) => { event.preventDefault(); attempt(write); }}>
          <ValueForm definitions={object.device.definitions} type={member.type} draft={draft.value} problems={problems.value} where={member.name} label={member.name} onChange={(changed) => { draft.value = changed; }} />
          <button type="submit" class="primary">Write {member.name}</button>
        </form>
      ) : value === undefined ? null : (
        <Part type={member.type} value={value} columns={Number(columns.value) || 0} asPicture={asPicture.value && isNumbers} definitions={object.device.definitions} />
      )}
    </MemberCard>
  );
}

type PartProps = { type: ValueType; value: unknown; columns: number; asPicture: boolean; definitions: MemberProps["object"]["device"]["definitions"] };

function Part({ type, value, columns, asPicture, definitions }: PartProps): VNode {
  if (value instanceof MultiDimArray) {
    if (asPicture) return <PictureView picture={blockPicture(value as MultiDimArray)} label="Memory as a picture" />;
    return <Matrix type={item(type)} value={value as MultiDimArray} />;
  }
  const row = value as ArrayLike<number | bigint>;
  if (columns > 0 && Number.isInteger(columns)) {
    const height = Math.ceil(row.length / columns);
    if (asPicture) return <PictureView picture={grayPicture(columns, height, row, (x, y) => x + y * columns)} label="Memory as a picture" />;
    return <Matrix type={item(type)} value={transposed(row, height, columns)} />;
  }
  if (asPicture) {
    const width = Math.max(1, Math.ceil(Math.sqrt(row.length)));
    return <PictureView picture={grayPicture(width, Math.ceil(row.length / width), row, (x, y) => x + y * width)} label="Memory as a picture" />;
  }
  return <ValueView definitions={definitions} type={type} value={value} />;
}

/** Lines of a row as a matrix, whose first index is that of the line. */
function transposed(row: ArrayLike<number | bigint>, height: number, width: number): MultiDimArray {
  const items = Array.from({ length: height * width }, (_, i) => row[(i % height) * width + Math.floor(i / height)] ?? NaN);
  return new MultiDimArray([height, width], items);
}

/** The first two dimensions: rows and columns. */
function blockPicture({ dims, array }: MultiDimArray): Picture {
  const [height = 1, width = 1] = dims;
  return grayPicture(width, height, array as ArrayLike<number | bigint>, (x, y) => y + x * height);
}
