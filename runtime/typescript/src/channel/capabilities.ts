// SPDX-License-Identifier: Apache-2.0
// What both sides of a connection can do (04, section 4.4).

const pageMask = 0xfff00000;
const flagMask = 0x000fffff;
const page2 = 0x02000000;
const page4 = 0x04000000;
const pageStrings = 0x04100000;

const enabled = 0x1;
const combined = 0x2;
const localTable = 0x2;
const standardTable = 0x4;

/** What one side offers the other. Both must want a thing. */
export interface Offer {
  /** The compact message format. */
  format4: boolean;
  /** Codes for frequent strings; needs format 4. */
  stringTable: boolean;
  /** Connecting to a service in one step instead of four. */
  combinedConnect: boolean;
}

/** What a connection uses. */
export interface Terms {
  version: 2 | 4;
  localCodes: boolean;
  standardCodes: boolean;
  combinedConnect: boolean;
}

export const plainTerms: Terms = { version: 2, localCodes: false, standardCodes: false, combinedConnect: false };

/** The codes that a client sends. */
export function offeredCodes(offer: Offer): number[] {
  const basic = offer.combinedConnect ? enabled | combined : enabled;
  const codes = [page2 | basic];
  if (offer.format4) {
    codes.push(page4 | basic);
    if (offer.stringTable) codes.push(pageStrings | enabled | localTable | standardTable);
  }
  return codes;
}

function flagsOf(codes: Iterable<number>, page: number): number | undefined {
  for (const code of codes) {
    if ((code & pageMask) >>> 0 === page) return code & flagMask;
  }
  return undefined;
}

/** What the codes of an answer mean. */
export function termsOf(codes: readonly number[]): Terms {
  const basic2 = flagsOf(codes, page2) ?? enabled;
  const basic4 = flagsOf(codes, page4) ?? 0;
  const is4 = (basic4 & enabled) !== 0;
  const strings = is4 ? (flagsOf(codes, pageStrings) ?? 0) : 0;
  const useStrings = (strings & enabled) !== 0;
  return {
    version: is4 ? 4 : 2,
    localCodes: useStrings && (strings & localTable) !== 0,
    standardCodes: useStrings && (strings & standardTable) !== 0,
    combinedConnect: ((is4 ? basic4 : basic2) & combined) !== 0,
  };
}

/** Whether an answer has nothing but what was offered, and what every answer must have. */
export function isFairAnswer(offered: readonly number[], answered: readonly number[]): boolean {
  const pages = new Set<number>();
  for (const code of answered) {
    const page = (code & pageMask) >>> 0;
    const flags = flagsOf(offered, page);
    if (flags === undefined || pages.has(page) || (code & flagMask & ~flags) !== 0) return false;
    pages.add(page);
  }
  if (((flagsOf(answered, page2) ?? 0) & enabled) === 0) return false;
  return !pages.has(pageStrings) || ((flagsOf(answered, page4) ?? 0) & enabled) !== 0;
}

/** The codes that a service answers with; undefined when the client does not offer what every client must. */
export function answeredCodes(requested: readonly number[], offer: Offer): number[] | undefined {
  const wanted2 = flagsOf(requested, page2);
  if (wanted2 !== undefined && (wanted2 & enabled) === 0) return undefined;
  const basic = offer.combinedConnect ? enabled | combined : enabled;
  const codes = [page2 | ((wanted2 ?? enabled) & basic)];
  const wanted4 = flagsOf(requested, page4) ?? 0;
  if (!offer.format4 || (wanted4 & enabled) === 0) return codes;
  codes.push(page4 | (wanted4 & basic));
  const strings = flagsOf(requested, pageStrings) ?? 0;
  if (offer.stringTable && (strings & enabled) !== 0) codes.push(pageStrings | (strings & (enabled | localTable | standardTable)));
  return codes;
}

const levels: ReadonlyMap<string, number> = new Map([
  ["com.robotraconteur.message.v_max", 4],
  ["com.robotraconteur.v2", 1],
  ["com.robotraconteur.v2.0", 1],
  ["com.robotraconteur.v2.minor", 0],
  ["com.robotraconteur.message.v4", 1],
  ["com.robotraconteur.message.v4.0", 1],
  ["com.robotraconteur.message.v4.minor", 0],
  ["com.robotraconteur.stringtable", 4],
  ["com.robotraconteur.stringtable.v4", 1],
  ["com.robotraconteur.stringtable.v4.0", 1],
  ["com.robotraconteur.stringtable.v4.minor", 0],
]);

/** The level of a capability of the stream (04, section 4.5); 0 for an unknown one. */
export function streamCapability(name: string): number {
  return levels.get(name) ?? 0;
}
