// SPDX-License-Identifier: Apache-2.0
// Times of wire values (07, section 13).
import { ElementType } from "./codec/element_type.js";
import type { MessageElement } from "./codec/message.js";
import { numberElement } from "./value/pack.js";
import { readNumber } from "./value/numbers.js";
import { checkType, findElement } from "./value/shapes.js";
import { compareTimes, type TimeSpec } from "./value/values.js";

const billion = 1_000_000_000n;

/** A clock that never gives the same time twice, nor an earlier one. */
export class WireClock {
  private last: TimeSpec = { seconds: 0n, nanoseconds: 0 };

  now(): TimeSpec {
    const micros = BigInt(Math.round((performance.timeOrigin + performance.now()) * 1000));
    const nanos = micros * 1000n;
    let time: TimeSpec = { seconds: nanos / billion, nanoseconds: Number(nanos % billion) };
    if (compareTimes(time, this.last) <= 0) {
      const next = this.last.nanoseconds + 1;
      time = next < 1e9 ? { ...this.last, nanoseconds: next } : { seconds: this.last.seconds + 1n, nanoseconds: 0 };
    }
    this.last = time;
    return time;
  }
}

export function timeElement(time: TimeSpec): MessageElement {
  const elements = [numberElement("seconds", "int64", time.seconds), numberElement("nanoseconds", "int32", time.nanoseconds)];
  return { name: "packettime", type: ElementType.structure, typeName: "RobotRaconteur.TimeSpec", count: 2, elements };
}

/** The `packettime` of a packet. Throws RRError. */
export function timeOf(elements: readonly MessageElement[]): TimeSpec {
  const time = findElement(elements, "packettime");
  checkType(time, ElementType.structure, "packettime");
  const seconds = findElement(time.elements, "seconds");
  const nanoseconds = findElement(time.elements, "nanoseconds");
  checkType(seconds, ElementType.int64, "seconds");
  checkType(nanoseconds, ElementType.int32, "nanoseconds");
  const none = new Uint8Array(8);
  return {
    seconds: readNumber("int64", seconds.count > 0 ? (seconds.data ?? none) : none) as bigint,
    nanoseconds: readNumber("int32", nanoseconds.count > 0 ? (nanoseconds.data ?? none) : none) as number,
  };
}
