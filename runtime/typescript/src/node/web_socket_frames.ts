// SPDX-License-Identifier: Apache-2.0
// Frames of web sockets (RFC 6455) in both roles, over a stream of bytes.
import { randomBytes } from "../random.js";
import type { ByteStream, StreamEvents } from "../channel/stream.js";

const opcode = { continuation: 0, text: 1, binary: 2, close: 8, ping: 9, pong: 10 } as const;
const largestPayload = 65535;
const largestControl = 125;
/** Answers to pings that nobody reads may wait so much. */
const pongLimit = 1024 * 1024;

/** Applies a mask in place; `offset` is how many bytes of the payload were before. */
export function applyMask(bytes: Uint8Array, mask: Uint8Array, offset = 0): void {
  for (let i = 0; i < bytes.length; ++i) bytes[i] = (bytes[i] ?? 0) ^ (mask[(i + offset) & 3] ?? 0);
}

/** The payloads of binary frames of an inner stream as a stream. */
export class WebSocketFrames implements ByteStream {
  readonly remoteAddress: string;
  readonly localAddress: string;
  private head = new Uint8Array(0);
  /** Of the data frame whose payload comes. */
  private left = 0;
  private mask: Uint8Array | undefined;
  private maskOffset = 0;
  private isBinaryOpen = false;
  private isClosed = false;

  constructor(
    private readonly inner: ByteStream,
    private readonly isClient: boolean,
  ) {
    this.remoteAddress = inner.remoteAddress;
    this.localAddress = inner.localAddress ?? "";
  }

  get waiting(): number {
    return this.inner.waiting;
  }

  start(events: StreamEvents): void {
    this.inner.start({
      data: (bytes) => {
        const problem = this.isClosed ? undefined : this.receive(bytes, events);
        if (problem !== undefined) this.fail(problem, events);
      },
      closed: (reason) => {
        if (this.isClosed) return;
        this.isClosed = true;
        events.closed(reason);
      },
      drained: () => {
        events.drained();
      },
    });
  }

  private fail(problem: string, events: StreamEvents): void {
    this.isClosed = true;
    this.inner.close();
    events.closed(new Error(problem));
  }

  /** Undefined while all is well, else what is wrong. */
  private receive(bytes: Uint8Array, events: StreamEvents): string | undefined {
    let rest = bytes;
    while (rest.length > 0 && !this.isClosed) {
      if (this.left > 0) {
        const part = rest.subarray(0, this.left);
        rest = rest.subarray(part.length);
        this.deliver(part, events);
        continue;
      }
      const all = this.head.length > 0 ? concat(this.head, rest) : rest;
      const frame = parseHead(all);
      if (frame === undefined) {
        this.head = all.slice();
        return undefined;
      }
      const problem = this.begin(frame, all);
      if (problem !== undefined) return problem;
      if (frame.opcode < opcode.close) {
        this.head = new Uint8Array(0);
        rest = all.subarray(frame.size);
        continue;
      }
      if (all.length < frame.size + frame.length) {
        this.head = all.slice();
        return undefined;
      }
      const payload = all.slice(frame.size, frame.size + frame.length);
      if (frame.mask) applyMask(payload, frame.mask);
      const ending = this.control(frame.opcode, payload);
      if (ending !== undefined) return ending;
      this.head = new Uint8Array(0);
      rest = all.subarray(frame.size + frame.length);
    }
    return undefined;
  }

  private deliver(part: Uint8Array, events: StreamEvents): void {
    const payload = this.mask ? part.slice() : part;
    if (this.mask) applyMask(payload, this.mask, this.maskOffset);
    this.maskOffset += part.length;
    this.left -= part.length;
    events.data(payload);
  }

  private begin(frame: FrameHead, all: Uint8Array): string | undefined {
    if (((all[0] ?? 0) & 0x70) !== 0) return "a frame has reserved bits";
    // Clients mask, servers do not.
    if ((frame.mask !== undefined) === this.isClient) return "a frame is masked by the wrong side";
    if (frame.opcode >= opcode.close) {
      if (!frame.isFinal || frame.length > largestControl) return "a control frame is too long";
      return undefined;
    }
    if (frame.opcode === opcode.continuation ? !this.isBinaryOpen : this.isBinaryOpen || frame.opcode !== opcode.binary) {
      return "a frame has no binary data";
    }
    this.isBinaryOpen = !frame.isFinal;
    this.left = frame.length;
    this.mask = frame.mask;
    this.maskOffset = 0;
    return undefined;
  }

  private control(kind: number, payload: Uint8Array): string | undefined {
    if (kind === opcode.close) {
      this.sendFrame(opcode.close, [payload.subarray(0, 2)], Math.min(payload.length, 2));
      return "the web socket was closed by the other side";
    }
    if (kind === opcode.ping) {
      if (this.inner.waiting > pongLimit) return "pings are answered and not read";
      this.sendFrame(opcode.pong, [payload], payload.length);
      return undefined;
    }
    return kind === opcode.pong ? undefined : `a frame has the unknown kind ${kind}`;
  }

  send(pieces: readonly Uint8Array[]): void {
    if (this.isClosed) return;
    let frame: Uint8Array[] = [];
    let size = 0;
    for (const piece of pieces) {
      for (let at = 0; at < piece.length; ) {
        const part = piece.subarray(at, at + largestPayload - size);
        frame.push(part);
        size += part.length;
        at += part.length;
        if (size < largestPayload) continue;
        this.sendFrame(opcode.binary, frame, size);
        frame = [];
        size = 0;
      }
    }
    if (size > 0) this.sendFrame(opcode.binary, frame, size);
  }

  private sendFrame(kind: number, parts: readonly Uint8Array[], length: number): void {
    const head = [0x80 | kind, (this.isClient ? 0x80 : 0) | (length < 126 ? length : 126)];
    if (length >= 126) head.push(length >> 8, length & 0xff);
    if (!this.isClient) {
      this.inner.send([Uint8Array.from(head), ...parts]);
      return;
    }
    const mask = randomBytes(4);
    const whole = new Uint8Array(head.length + 4 + length);
    whole.set(head);
    whole.set(mask, head.length);
    let at = head.length + 4;
    const start = at;
    for (const part of parts) {
      whole.set(part, at);
      at += part.length;
    }
    applyMask(whole.subarray(start), mask);
    this.inner.send([whole]);
  }

  pause(): void {
    this.inner.pause();
  }

  resume(): void {
    this.inner.resume();
  }

  close(): void {
    this.inner.close();
  }

  destroy(): void {
    this.inner.destroy();
  }
}

interface FrameHead {
  isFinal: boolean;
  opcode: number;
  length: number;
  mask: Uint8Array | undefined;
  /** Bytes of the head itself. */
  size: number;
}

/** Undefined while bytes are missing. */
function parseHead(bytes: Uint8Array): FrameHead | undefined {
  if (bytes.length < 2) return undefined;
  const first = bytes[0] ?? 0;
  const second = bytes[1] ?? 0;
  const short = second & 0x7f;
  const lengthSize = short === 126 ? 2 : short === 127 ? 8 : 0;
  const maskSize = second & 0x80 ? 4 : 0;
  const size = 2 + lengthSize + maskSize;
  if (bytes.length < size) return undefined;
  let length = lengthSize === 0 ? short : 0;
  for (let i = 0; i < lengthSize; ++i) length = length * 256 + (bytes[2 + i] ?? 0);
  const mask = maskSize ? bytes.slice(size - 4, size) : undefined;
  return { isFinal: (first & 0x80) !== 0, opcode: first & 0x0f, length, mask, size };
}

function concat(a: Uint8Array, b: Uint8Array): Uint8Array {
  const all = new Uint8Array(a.length + b.length);
  all.set(a);
  all.set(b, a.length);
  return all;
}
