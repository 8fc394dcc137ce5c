// SPDX-License-Identifier: Apache-2.0
import type { Member, MemberKind, ObjectType } from "@robdef/runtime";
import { shortType } from "./types.js";

/** Members in the order of the definition. */
export function membersOf(type: ObjectType): Member[] {
  return [...type.members.values()];
}

/** How people call the kinds, in the order in which pages show them. */
export const kindTitles: readonly (readonly [MemberKind, string])[] = [
  ["property", "Properties"],
  ["function", "Functions"],
  ["wire", "Wires"],
  ["pipe", "Pipes"],
  ["event", "Events"],
  ["callback", "Callbacks"],
  ["memory", "Memories"],
  ["objref", "Objects"],
];

/** The declaration as a definition writes it, with short names of types. */
export function declarationOf(member: Member): string {
  const parameters = member.parameters.map(({ name, type }) => `${shortType(type)} ${name}`);
  if (member.generator?.takes) parameters.push(`${shortType(member.generator.takes)}{generator} step`);
  const result = member.kind === "function" && member.generator?.gives ? `${shortType(member.type)}{generator}` : shortType(member.type);
  switch (member.kind) {
    case "function":
    case "callback":
      return `${result} ${member.name}(${parameters.join(", ")})`;
    case "event":
      return `${member.name}(${parameters.join(", ")})`;
    case "objref":
      return `${member.objectType === "" ? "varobject" : member.objectType.replace(/^.*\./, "")}${member.index === "none" ? "" : `{${member.index}}`} ${member.name}`;
    default:
      return `${result} ${member.name}`;
  }
}

/** `read only`, `write only`, or nothing. */
export function accessText(member: Member): string {
  return member.isReadonly ? "read only" : member.isWriteonly ? "write only" : "";
}

/**
 * The unit that a documentation gives: in brackets, or after "in". Definitions have no other place for it. Empty when
 * there is none that is known.
 */
export function unitIn(doc: string): string {
  const bracket = /[[(]\s*([a-zA-Z%°µ][a-zA-Z0-9%°µ/^*· -]{0,15})\s*[\])]/.exec(doc);
  if (bracket?.[1] && isUnit(bracket[1])) return bracket[1];
  const word = /\b[Ii]n ([a-zA-Z%°µ][a-zA-Z0-9%°µ/^*·]*(?: per [a-zA-Z]+)?)/.exec(doc)?.[1];
  return word !== undefined && isUnit(word) ? (symbols[word.toLowerCase()] ?? word) : "";
}

const symbols: Readonly<Record<string, string>> = {
  metres: "m", meters: "m", millimetres: "mm", millimeters: "mm", radians: "rad", degrees: "°", seconds: "s", milliseconds: "ms", newtons: "N", volts: "V", amperes: "A",
  kelvin: "K", celsius: "°C", hertz: "Hz", pascal: "Pa", watts: "W", percent: "%", kilograms: "kg", lux: "lx",
  "radians per second": "rad/s", "metres per second": "m/s", "meters per second": "m/s", "degrees per second": "°/s",
};
const plainUnits = /^(?:[nµumkMG]?(?:m|g|s|A|K|mol|cd|rad|N|Hz|Pa|W|J|V|F|Ohm|T|lx|l|B)|kg|deg|°|°C|%|min|h|rpm|pixels?|bits?|bytes?)(?:[/·*][nµumkM]?(?:m|s|kg|rad|A|K|min|deg)(?:\^?[23])?)*(?:\^?[23])?$/;

function isUnit(text: string): boolean {
  return Object.hasOwn(symbols, text.toLowerCase()) || plainUnits.test(text);
}
