// SPDX-License-Identifier: Apache-2.0
// The numbers inside of values: what lines a plot of a wire, pipe or property has.
import { millisecondsOf, MultiDimArray, type Complex, type TimeSpec, type ValueType } from "@robdef/runtime";

/** One number of each value, or a row of samples. */
export interface Channel {
  /** As `position.x` or `[3]`; empty for the value itself. */
  readonly label: string;
  readonly get: (value: unknown) => number;
}

type Getter = (value: unknown) => unknown;

/** Rows up to this length are a line for each item; longer ones are samples of one line. */
export const longestRow = 64;
const mostChannels = 256;

/** The lines of values of a type. How long rows are is seen at a value. */
export function channelsOf(type: ValueType, sample: unknown): Channel[] {
  const channels: Channel[] = [];
  collect(type, sample, "", (value) => value, channels, 0);
  return channels;
}

function collect(type: ValueType, sample: unknown, label: string, get: Getter, to: Channel[], depth: number): void {
  if (to.length >= mostChannels || depth > 8 || type.container !== "none" || sample === null || sample === undefined) return;
  const { base, array } = type;
  if (array.kind !== "scalar") {
    const isBlock = array.kind === "dims";
    const row: ArrayLike<unknown> = isBlock ? (sample as MultiDimArray).array : (sample as ArrayLike<unknown>);
    if (row.length > longestRow) return;
    const one: ValueType = { base, array: { kind: "scalar" }, container: "none", text: type.text };
    for (let i = 0; i < row.length; ++i) {
      const item: Getter = isBlock ? (value) => (get(value) as MultiDimArray | undefined)?.array[i] : (value) => (get(value) as ArrayLike<unknown> | undefined)?.[i];
      collect(one, row[i], `${label}[${i}]`, item, to, depth + 1);
    }
    return;
  }
  if (base.kind === "record") {
    for (const field of base.record.fields) {
      const { name } = field;
      const part: Getter = (value) => (get(value) as Readonly<Record<string, unknown>> | undefined)?.[name];
      collect(field.type, (sample as Readonly<Record<string, unknown>>)[name], label === "" ? name : `${label}.${name}`, part, to, depth + 1);
    }
    return;
  }
  if (base.kind === "enum") to.push({ label, get: (value) => numberOf(get(value)) });
  if (base.kind !== "number") return;
  if (base.number === "cdouble" || base.number === "csingle") {
    to.push({ label: `${label}.re`, get: (value) => numberOf((get(value) as Complex | undefined)?.re) });
    to.push({ label: `${label}.im`, get: (value) => numberOf((get(value) as Complex | undefined)?.im) });
  } else to.push({ label, get: (value) => numberOf(get(value)) });
}

function numberOf(value: unknown): number {
  return typeof value === "number" ? value : typeof value === "bigint" ? Number(value) : typeof value === "boolean" ? (value ? 1 : 0) : NaN;
}

/** The samples of a value that is one long row of numbers; undefined for others. */
export function samplesOf(type: ValueType, value: unknown): ArrayLike<number | bigint> | undefined {
  if (type.container !== "none" || type.array.kind !== "array" || type.base.kind !== "number") return undefined;
  const row = value as ArrayLike<number | bigint>;
  return row.length > longestRow && typeof row[0] !== "object" && typeof row[0] !== "boolean" ? row : undefined;
}

/**
 * The device's time inside of a value, in seconds: a TimeSpec2 or DateTimeUTC in a field `ts`, `time` or `timestamp`, or
 * in `data_header`; a TimeSpec3. Undefined when it has none.
 */
export function deviceTime(value: unknown, depth = 0): number | undefined {
  if (typeof value !== "object" || value === null || depth > 3) return undefined;
  const fields = value as Readonly<Record<string, unknown>>;
  for (const name of ["ts", "timestamp", "time", "device_time"]) {
    const found = asTime(fields[name]);
    if (found !== undefined) return found;
  }
  return fields.data_header === undefined ? undefined : deviceTime(fields.data_header, depth + 1);
}

function asTime(value: unknown): number | undefined {
  if (typeof value !== "object" || value === null) return undefined;
  const fields = value as Readonly<Record<string, unknown>>;
  if (typeof fields.seconds === "bigint" && typeof fields.nanoseconds === "number") return millisecondsOf(value as TimeSpec) / 1000;
  return typeof fields.microseconds === "bigint" ? Number(fields.microseconds) / 1e6 : undefined;
}
