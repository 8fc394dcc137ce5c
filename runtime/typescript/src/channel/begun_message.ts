// SPDX-License-Identifier: Apache-2.0
// Finds messages that contradict themselves before they are whole, so that nobody waits for bytes that never come.
import { FormatError } from "../codec/format_error.js";
import { HeaderFlag } from "../codec/message.js";

const smallestHeader = { 2: 64, 4: 12 } as const;
const bothNodes = 32;

/** Numbers from bytes of which some are missing: undefined where they are. */
class BegunReader {
  position = 10;

  constructor(private readonly view: DataView) {}

  skip(length: number): void {
    this.position += length;
  }

  u16(): number | undefined {
    const at = this.position;
    this.position += 2;
    return at + 2 <= this.view.byteLength ? this.view.getUint16(at, true) : undefined;
  }

  u32(): number | undefined {
    const at = this.position;
    this.position += 4;
    return at + 4 <= this.view.byteLength ? this.view.getUint32(at, true) : undefined;
  }

  u8(): number | undefined {
    const at = this.position++;
    return at < this.view.byteLength ? this.view.getUint8(at) : undefined;
  }

  varUint(): number | undefined {
    const first = this.u8();
    if (first === undefined || first < 0xfd) return first;
    if (first === 0xff) throw new FormatError("a number has more than 32 bits");
    return first === 0xfd ? this.u16() : this.u32();
  }
}

/**
 * Looks at the beginning of a message of `size` bytes: true when its header and the size of its first entry are
 * there and fit, false when bytes are missing. Throws {@link FormatError} for what cannot become a message.
 */
export function checkBegun(bytes: Uint8Array, size: number): boolean {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const version = view.getUint16(8, true) === 2 ? 2 : 4;
  const reader = new BegunReader(view);
  const headerSize = version === 2 ? reader.u16() : reader.varUint();
  if (headerSize === undefined) return false;
  if (headerSize < smallestHeader[version] || headerSize > size) throw new FormatError("a header has another size than it says");
  const count = version === 2 ? entries2(reader, headerSize) : entries4(reader, headerSize);
  if (count === undefined) return false;
  if (count === 0) throw new FormatError("a message has no entries");
  reader.position = headerSize;
  const entrySize = version === 2 ? reader.u32() : reader.varUint();
  if (entrySize === undefined) return false;
  const end = headerSize + entrySize;
  if (count === 1 ? end !== size : end > size) throw new FormatError("a message has another size than its entries");
  return true;
}

/** The count of entries of format 2, once the header is known to be as long as it says. */
function entries2(reader: BegunReader, headerSize: number): number | undefined {
  reader.position = 52;
  for (let i = 0; i < 3; ++i) {
    const length = reader.u16();
    if (length === undefined) return undefined;
    reader.skip(length);
    if (reader.position > headerSize) throw new FormatError("a header has another size than it says");
  }
  const count = reader.u16();
  if (count === undefined) return undefined;
  if (reader.position + 4 !== headerSize) throw new FormatError("a header has another size than it says");
  return count;
}

function entries4(reader: BegunReader, headerSize: number): number | undefined {
  const flags = reader.u8();
  if (flags === undefined) return undefined;
  const texts = (count: number): boolean => {
    for (let i = 0; i < count; ++i) {
      const length = reader.varUint();
      if (length === undefined) return false;
      reader.skip(length);
      if (reader.position > headerSize) throw new FormatError("a header has another size than it says");
    }
    return true;
  };
  if (flags & HeaderFlag.routing) {
    reader.skip(bothNodes);
    if (!texts(2)) return undefined;
  }
  if (flags & HeaderFlag.endpoints) {
    if (reader.varUint() === undefined || reader.varUint() === undefined) return undefined;
  }
  if (flags & HeaderFlag.priority) reader.skip(2);
  if (flags & HeaderFlag.meta) {
    if (!texts(1)) return undefined;
    reader.skip(4);
  }
  if (flags & HeaderFlag.stringTable) {
    const strings = reader.varUint();
    if (strings === undefined) return undefined;
    for (let i = 0; i < strings; ++i) {
      if (reader.varUint() === undefined || !texts(1)) return undefined;
    }
  }
  return flags & HeaderFlag.multipleEntries ? reader.varUint() : 1;
}
