// SPDX-License-Identifier: Apache-2.0
// Values that are pictures: images of com.robotraconteur.image, records with width, height and data, and blocks of bytes.
import { MultiDimArray, type ValueType } from "@robdef/runtime";

/** A picture as canvases take it, or a file that the browser decodes. */
export type Picture =
  | { readonly kind: "pixels"; readonly width: number; readonly height: number; readonly rgba: Uint8ClampedArray<ArrayBuffer>; readonly about: string }
  | { readonly kind: "file"; readonly mime: string; readonly bytes: Uint8Array<ArrayBuffer>; readonly about: string };

const mostPixels = 64 * 1024 * 1024;

/** Names of com.robotraconteur.image.ImageEncoding by their numbers. */
const encodings: Readonly<Record<number, string>> = {
  0x1000: "rgb888", 0x1001: "rgba8888", 0x1002: "bgr888", 0x1003: "bgra8888", 0x1004: "rgba16_16_16_16", 0x1005: "bgra16_16_16_16",
  0x2000: "mono8", 0x2001: "mono16", 0x2002: "mono32", 0x2003: "mono_f16", 0x2004: "mono_f32", 0x2005: "mono_f64",
  0x3000: "bayer_rggb8888", 0x3001: "bayer_bggr8888", 0x3002: "bayer_gbrg8888", 0x3003: "bayer_grbg8888",
  0x4000: "depth_u16", 0x4001: "depth_i16", 0x4002: "depth_u32", 0x4003: "depth_i32", 0x4004: "depth_u64", 0x4005: "depth_i64", 0x4006: "depth_f32", 0x4007: "depth_f64",
};

/** Whether values of a type can be pictures. */
export function isPictureType(type: ValueType): boolean {
  if (type.container !== "none" || type.base.kind !== "record") return false;
  const { record } = type.base;
  if (type.array.kind === "dims") return /\.PixelRGBA?$/.test(record.name);
  if (record.kind !== "struct" || type.array.kind !== "scalar") return false;
  const has = (name: string): boolean => record.fields.some((field) => field.name === name);
  return has("data") && (has("image_info") || (has("width") && has("height")));
}

type Fields = Readonly<Record<string, unknown>>;

/** The picture that a value is; undefined when it is none, an Error in words when it cannot be shown. */
export function pictureOf(type: ValueType, value: unknown): Picture | Error | undefined {
  if (!isPictureType(type) || typeof value !== "object" || value === null) return undefined;
  if (value instanceof MultiDimArray) return fromPixels(value as MultiDimArray);
  const fields = value as Fields;
  const data = fields.data;
  if (!(data instanceof Uint8Array)) return new Error("the data of the picture are no bytes");
  const info = (fields.image_info ?? null) as Fields | null;
  const file = fileOf(data);
  if (file) return { kind: "file", mime: file, bytes: data.slice(), about: file };
  const source = "image_info" in fields ? info : fields;
  if (!source) return new Error("the picture has no image_info");
  const width = Number(source.width);
  const height = Number(source.height);
  if (!(width > 0 && height > 0 && width * height <= mostPixels)) return new Error(`a picture of ${width} × ${height} cannot be shown`);
  const encoding = typeof source.encoding === "number" ? (encodings[source.encoding] ?? "") : encodingFor(data.length, width * height);
  if (encoding === "") return new Error(`${data.length} bytes are no picture of ${width} × ${height} in an encoding that is known`);
  return decode(encoding, width, height, Number(source.step ?? 0), data);
}

/** Of a record that does not tell: by the bytes of a pixel. */
function encodingFor(bytes: number, pixels: number): string {
  return bytes === pixels ? "mono8" : bytes === 3 * pixels ? "rgb888" : bytes === 4 * pixels ? "rgba8888" : "";
}

/** The kind of file that bytes are, by how they begin. */
function fileOf(data: Uint8Array): string | undefined {
  const begins = (...bytes: number[]): boolean => bytes.every((byte, i) => data[i] === byte);
  if (begins(0xff, 0xd8, 0xff)) return "image/jpeg";
  if (begins(0x89, 0x50, 0x4e, 0x47)) return "image/png";
  if (begins(0x52, 0x49, 0x46, 0x46) && data[8] === 0x57) return "image/webp";
  return begins(0x47, 0x49, 0x46, 0x38) ? "image/gif" : undefined;
}

const bytesOf: Readonly<Record<string, number>> = {
  rgb888: 3, bgr888: 3, rgba8888: 4, bgra8888: 4, rgba16_16_16_16: 8, bgra16_16_16_16: 8, mono8: 1, mono16: 2, mono32: 4, mono_f16: 2, mono_f32: 4, mono_f64: 8,
  bayer_rggb8888: 1, bayer_bggr8888: 1, bayer_gbrg8888: 1, bayer_grbg8888: 1,
  depth_u16: 2, depth_i16: 2, depth_u32: 4, depth_i32: 4, depth_u64: 8, depth_i64: 8, depth_f32: 4, depth_f64: 8,
};

function decode(encoding: string, width: number, height: number, given: number, data: Uint8Array): Picture | Error {
  const size = bytesOf[encoding] ?? 0;
  const step = given >= width * size ? given : width * size;
  if (data.length < step * (height - 1) + width * size) return new Error(`${data.length} bytes are too few for ${width} × ${height} in ${encoding}`);
  const rgba = new Uint8ClampedArray(width * height * 4);
  const about = `${width} × ${height} ${encoding}`;
  if (size === 1 && encoding.startsWith("bayer")) bayer(encoding.slice(6, 10), data, step, width, height, rgba);
  else if (/^(?:rgb|bgr)/.test(encoding)) colors(encoding, size, data, step, width, height, rgba);
  else grays(encoding, size, data, step, width, height, rgba);
  return { kind: "pixels", width, height, rgba, about };
}

function colors(encoding: string, size: number, data: Uint8Array, step: number, width: number, height: number, rgba: Uint8ClampedArray): void {
  const red = encoding.startsWith("rgb") ? 0 : 2;
  // Of 16 bits the upper byte counts: little endian.
  const bytes = size === 8 ? 2 : 1;
  const upper = bytes - 1;
  const hasAlpha = size !== 3;
  for (let y = 0, to = 0; y < height; ++y) {
    for (let x = 0, from = y * step; x < width; ++x, from += size, to += 4) {
      rgba[to] = data[from + red * bytes + upper] ?? 0;
      rgba[to + 1] = data[from + bytes + upper] ?? 0;
      rgba[to + 2] = data[from + (2 - red) * bytes + upper] ?? 0;
      rgba[to + 3] = hasAlpha ? (data[from + 3 * bytes + upper] ?? 0) : 255;
    }
  }
}

/** One number for each pixel: of bytes as they are, of others from the lowest to the highest. */
function grays(encoding: string, size: number, data: Uint8Array, step: number, width: number, height: number, rgba: Uint8ClampedArray): void {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const kind = encoding.replace(/^(?:mono|depth)_?/, "");
  const isFloat = kind.startsWith("f");
  const isSigned = kind.startsWith("i");
  const read = (at: number): number => {
    if (size === 1) return view.getUint8(at);
    if (isFloat) return size === 4 ? view.getFloat32(at, true) : size === 8 ? view.getFloat64(at, true) : half(view.getUint16(at, true));
    if (size === 2) return isSigned ? view.getInt16(at, true) : view.getUint16(at, true);
    if (size === 4) return isSigned ? view.getInt32(at, true) : view.getUint32(at, true);
    return Number(isSigned ? view.getBigInt64(at, true) : view.getBigUint64(at, true));
  };
  const numbers = new Float64Array(width * height);
  let low = Infinity;
  let high = -Infinity;
  for (let y = 0, to = 0; y < height; ++y) {
    for (let x = 0, from = y * step; x < width; ++x, from += size, ++to) {
      const one = read(from);
      numbers[to] = one;
      if (one < low) low = one;
      if (one > high) high = one;
    }
  }
  if (size === 1) [low, high] = [0, 255];
  const scale = high > low ? 255 / (high - low) : 0;
  for (let i = 0; i < numbers.length; ++i) {
    const gray = ((numbers[i] ?? 0) - low) * scale;
    rgba[4 * i] = rgba[4 * i + 1] = rgba[4 * i + 2] = gray;
    rgba[4 * i + 3] = 255;
  }
}

function half(bits: number): number {
  const exponent = (bits >> 10) & 0x1f;
  const fraction = bits & 0x3ff;
  const sign = (bits & 0x8000) === 0 ? 1 : -1;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  return exponent === 31 ? (fraction === 0 ? sign * Infinity : NaN) : sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

/** Each pixel from its block of two by two: half the sharpness, all colors. */
function bayer(order: string, data: Uint8Array, step: number, width: number, height: number, rgba: Uint8ClampedArray): void {
  const at = (x: number, y: number): number => data[Math.min(y, height - 1) * step + Math.min(x, width - 1)] ?? 0;
  for (let y = 0, to = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x, to += 4) {
      const left = x & ~1;
      const top = y & ~1;
      const four = [at(left, top), at(left + 1, top), at(left, top + 1), at(left + 1, top + 1)];
      const sum = [0, 0, 0];
      Array.from(order).forEach((color, i) => {
        const place = color === "r" ? 0 : color === "g" ? 1 : 2;
        sum[place] = (sum[place] ?? 0) + (four[i] ?? 0) / (place === 1 ? 2 : 1);
      });
      rgba[to] = sum[0] ?? 0;
      rgba[to + 1] = sum[1] ?? 0;
      rgba[to + 2] = sum[2] ?? 0;
      rgba[to + 3] = 255;
    }
  }
}

/** PixelRGB and PixelRGBA: rows are the first dimension. */
function fromPixels({ dims, array }: MultiDimArray): Picture | Error {
  const [height = 0, width = 0] = dims;
  if (dims.length !== 2 || width * height > mostPixels) return new Error(`${dims.join(" × ")} pixels are no picture`);
  const rgba = new Uint8ClampedArray(width * height * 4);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const { r = 0, g = 0, b = 0, a = 255 } = array[y + x * height] as Record<string, number>;
      rgba.set([r, g, b, a], (y * width + x) * 4);
    }
  }
  return { kind: "pixels", width, height, rgba, about: `${width} × ${height} pixels` };
}

/** Numbers of a memory as a picture: from dark for the lowest to light for the highest. */
export function grayPicture(width: number, height: number, numbers: ArrayLike<number | bigint>, at: (x: number, y: number) => number): Picture {
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < numbers.length; ++i) {
    const one = Number(numbers[i]);
    if (one < low) low = one;
    if (one > high) high = one;
  }
  const scale = high > low ? 255 / (high - low) : 0;
  const rgba = new Uint8ClampedArray(width * height * 4);
  for (let y = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x) {
      const gray = (Number(numbers[at(x, y)] ?? low) - low) * scale;
      rgba.set([gray, gray, gray, 255], (y * width + x) * 4);
    }
  }
  return { kind: "pixels", width, height, rgba, about: `${width} × ${height}, from ${low} to ${high}` };
}
