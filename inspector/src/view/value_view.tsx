// SPDX-License-Identifier: Apache-2.0
// Values as people look at them: short ones as text, records and matrices as tables, pictures as pictures.
import type { VNode } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { MultiDimArray, type Definitions, type ValueType, type VarValue } from "@robdef/runtime";
import { pictureOf, type Picture } from "../picture/picture.js";
import { item, shortType } from "../model/types.js";
import { rounded, valueText } from "../model/value_text.js";

const shortText = 100;
const mostRows = 200;

export function ValueView({ definitions, type, value, unit = "" }: { definitions: Definitions; type: ValueType; value: unknown; unit?: string }): VNode {
  if (value === undefined) return <span class="value none">{type.base.kind === "void" ? "done" : "no value yet"}</span>;
  if (value === null) return <span class="value none">null</span>;
  if (type.base.kind === "any" && type.container === "none") {
    const any = value as VarValue;
    let inner: ValueType | undefined;
    try {
      inner = definitions.type(any.type);
    } catch {
      inner = undefined;
    }
    if (inner && !(inner.base.kind === "any" && inner.container === "none")) return <ValueView definitions={definitions} type={inner} value={any.value} unit={unit} />;
  }
  const picture = pictureOf(type, value);
  if (picture instanceof Error) return <span class="problem">{picture.message}</span>;
  if (picture) return <PictureView picture={picture} label={`Picture, ${picture.about}`} />;
  const text = valueText(type, value, shortText);
  if (text.length < shortText) {
    return (
      <span class="value">
        {text}
        {unit === "" ? "" : ` ${unit}`}
      </span>
    );
  }
  return (
    <details class="value large">
      <summary>{text}</summary>
      <Table definitions={definitions} type={type} value={value} />
    </details>
  );
}

function Table({ definitions, type, value }: { definitions: Definitions; type: ValueType; value: unknown }): VNode {
  const rows: [string, ValueType, unknown][] = [];
  let more = 0;
  const add = (all: Iterable<[string, unknown]>, of: ValueType, count: number): void => {
    for (const [name, one] of all) {
      if (rows.length >= mostRows) break;
      rows.push([name, of, one]);
    }
    more = count - rows.length;
  };
  if (type.container === "list") {
    const list = value as ArrayLike<unknown>;
    add(Array.from({ length: Math.min(list.length, mostRows) }, (_, i): [string, unknown] => [String(i), list[i]]), item(type), list.length);
  } else if (type.container !== "none") {
    const map = value as ReadonlyMap<string | number, unknown>;
    add(Array.from(map, ([key, one]): [string, unknown] => [String(key), one]), item(type), map.size);
  } else if (type.array.kind === "dims") {
    return <Matrix type={item(type)} value={value as MultiDimArray} />;
  } else if (type.array.kind === "array") {
    const row = value as ArrayLike<unknown>;
    add(Array.from({ length: Math.min(row.length, mostRows) }, (_, i): [string, unknown] => [String(i), row[i]]), item(type), row.length);
  } else if (type.base.kind === "record") {
    const fields = value as Readonly<Record<string, unknown>>;
    for (const field of type.base.record.fields) rows.push([field.name, field.type, fields[field.name]]);
  } else {
    return <pre class="text">{typeof value === "string" ? value : valueText(type, value, 100_000)}</pre>;
  }
  return (
    <table class="fields">
      <tbody>
        {rows.map(([name, of, one]) => (
          <tr key={name}>
            <th scope="row" title={shortType(of)}>{name}</th>
            <td>
              <ValueView definitions={definitions} type={of} value={one} />
            </td>
          </tr>
        ))}
        {more > 0 ? (
          <tr>
            <td colSpan={2} class="empty">and {more} more</td>
          </tr>
        ) : null}
      </tbody>
    </table>
  );
}

const mostMatrix = 40;

export function Matrix({ type, value }: { type: ValueType; value: MultiDimArray }): VNode {
  const { dims, array } = value;
  const [rows = 0, columns = 1] = dims;
  if (dims.length > 2) return <p class="empty">{dims.join(" × ")} items: {valueText({ ...type, array: { kind: "array", isMaximum: false } }, array, 2000)}</p>;
  return (
    <div class="scroll">
      <table class="matrix">
        <tbody>
          {Array.from({ length: Math.min(rows, mostMatrix) }, (_, r) => (
            <tr key={r}>
              {Array.from({ length: Math.min(columns, mostMatrix) }, (_, c) => {
                const one: unknown = array[r + c * rows];
                return <td key={c}>{typeof one === "number" ? rounded(one) : valueText(type, one, 40)}</td>;
              })}
            </tr>
          ))}
        </tbody>
      </table>
      {rows > mostMatrix || columns > mostMatrix ? <p class="empty">{rows} × {columns}; the first {mostMatrix} of each are shown</p> : null}
    </div>
  );
}

/** Draws pixels on a canvas; pictures that are files are decoded by the browser. */
export function PictureView({ picture, label }: { picture: Picture; label: string }): VNode {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const to = canvas.current;
    if (to) return drawPicture(to, picture);
    return undefined;
  }, [picture]);
  return (
    <figure class="picture">
      <canvas ref={canvas} role="img" aria-label={label} />
      <figcaption>{picture.about}</figcaption>
    </figure>
  );
}

/** Draws, now or once it is decoded; gives what stops it. */
export function drawPicture(canvas: HTMLCanvasElement, picture: Picture): () => void {
  const context = canvas.getContext("2d");
  let isOver = false;
  const size = (width: number, height: number): void => {
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
  };
  if (picture.kind === "pixels") {
    size(picture.width, picture.height);
    context?.putImageData(new ImageData(picture.rgba, picture.width, picture.height), 0, 0);
  } else {
    createImageBitmap(new Blob([picture.bytes], { type: picture.mime })).then(
      (bitmap) => {
        if (!isOver) {
          size(bitmap.width, bitmap.height);
          context?.drawImage(bitmap, 0, 0);
        }
        bitmap.close();
      },
      () => {
        canvas.setAttribute("aria-label", "a picture that the browser cannot decode");
      },
    );
  }
  return () => {
    isOver = true;
  };
}
