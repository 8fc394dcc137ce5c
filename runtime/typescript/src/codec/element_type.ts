// SPDX-License-Identifier: Apache-2.0

/** Type numbers of message elements (01, section 5). */
export const ElementType = {
  void: 0,
  double: 1,
  single: 2,
  int8: 3,
  uint8: 4,
  int16: 5,
  uint16: 6,
  int32: 7,
  uint32: 8,
  int64: 9,
  uint64: 10,
  string: 11,
  cdouble: 12,
  csingle: 13,
  bool: 14,
  structure: 101,
  intMap: 102,
  stringMap: 103,
  list: 108,
  pod: 109,
  podArray: 110,
  podMultiDimArray: 111,
  namedArrayArray: 115,
  namedArrayMultiDimArray: 116,
  multiDimArray: 117,
} as const;

/** Bytes of one item by type number; undefined for types that hold elements and unknown ones. */
const itemSizes: readonly number[] = [0, 8, 4, 1, 1, 2, 2, 4, 4, 8, 8, 1, 16, 8, 1];

const nestedTypes: ReadonlySet<number> = new Set<number>([
  ElementType.structure,
  ElementType.intMap,
  ElementType.stringMap,
  ElementType.list,
  ElementType.pod,
  ElementType.podArray,
  ElementType.podMultiDimArray,
  ElementType.namedArrayArray,
  ElementType.namedArrayMultiDimArray,
  ElementType.multiDimArray,
]);

/** Bytes of one item of a packed array; undefined when the type is no packed array. */
export function itemSize(type: number): number | undefined {
  return itemSizes[type];
}

/** Whether the payload is a list of elements. */
export function isNested(type: number): boolean {
  return nestedTypes.has(type);
}
