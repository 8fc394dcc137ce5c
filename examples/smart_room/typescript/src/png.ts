// SPDX-License-Identifier: Apache-2.0
import { writeFileSync } from "node:fs";
import { deflateSync } from "node:zlib";

const signature = Buffer.of(0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a);

/** CRC-32, bit by bit. */
function checksum(data: Uint8Array): number {
  let sum = 0xffffffff;
  for (const one of data) {
    sum ^= one;
    for (let bit = 0; bit < 8; ++bit) sum = (sum >>> 1) ^ ((sum & 1) !== 0 ? 0xedb88320 : 0);
  }
  return ~sum >>> 0;
}

function chunk(type: string, data: Uint8Array): Buffer {
  const body = Buffer.concat([Buffer.from(type, "latin1"), data]);
  const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(data.length);
  sum.writeUInt32BE(checksum(body));
  return Buffer.concat([length, body, sum]);
}

/** Writes a picture of three bytes (red, green, blue) a pixel, rows from the top. Throws RangeError when they do not fit the size. */
export function writePng(path: string, width: number, height: number, rgb: Uint8Array): void {
  if (width <= 0 || height <= 0 || rgb.length !== 3 * width * height) throw new RangeError(`${path}: the picture's data does not fit its size`);
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 2], 8); // bits a channel; red, green, blue
  const rows = Buffer.alloc((3 * width + 1) * height); // each row begins with a 0: as it is
  for (let row = 0; row < height; ++row) rows.set(rgb.subarray(3 * width * row, 3 * width * (row + 1)), (3 * width + 1) * row + 1);
  writeFileSync(path, Buffer.concat([signature, chunk("IHDR", header), chunk("IDAT", deflateSync(rows)), chunk("IEND", new Uint8Array())]));
}
