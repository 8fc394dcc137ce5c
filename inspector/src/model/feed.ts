// SPDX-License-Identifier: Apache-2.0
// Values of a member over time: a wire, a pipe, or a property that is asked again and again. Everything that shows the
// same member shares one feed, since a client has one connection to a wire.
import { signal } from "@preact/signals";
import { millisecondsOf, type Member, type PipeEnd, type WireEnd } from "@robdef/runtime";
import type { DeviceObject } from "./device.js";
import { errorText } from "./errors.js";
import { deviceTime } from "../plot/channels.js";

/** Seconds since 1970: the device's time where the value or the wire has one, else the time of arrival. */
export type FeedListener = (value: unknown, seconds: number) => void;

export type FeedState = "connecting" | "open" | "closed" | "failed";

const shownPeriod = 100;

export class Feed {
  readonly state = signal<FeedState>("connecting");
  readonly problem = signal("");
  /** The newest value, at most ten times a second: for what people read. */
  readonly shown = signal<{ readonly value: unknown; readonly seconds: number } | undefined>(undefined);
  /** Values a second, counted over the last second. */
  readonly rate = signal(0);
  last: { value: unknown; seconds: number } | undefined;
  /** Where the times are from. */
  timeSource: "device" | "arrival" = "arrival";
  private readonly listeners = new Set<FeedListener>();
  private uses = 0;
  private count = 0;
  private timer: ReturnType<typeof setInterval> | undefined;
  private stop: () => Promise<void> = () => Promise.resolve();
  private counted = 0;
  private countedAt = performance.now();
  wireEnd: WireEnd | undefined;
  pipeEnd: PipeEnd | undefined;

  constructor(
    readonly object: DeviceObject,
    readonly member: Member,
    private readonly ended: () => void,
    private readonly period = 250,
  ) {}

  get key(): string {
    return feedKey(this.object, this.member.name);
  }

  /** Begins with the first user, ends with the last. Gives what ends the use. */
  use(listener?: FeedListener): () => void {
    if (this.uses++ === 0) void this.begin();
    if (listener) this.listeners.add(listener);
    let isOver = false;
    return () => {
      if (isOver) return;
      isOver = true;
      if (listener) this.listeners.delete(listener);
      if (--this.uses === 0) void this.end();
    };
  }

  private async begin(): Promise<void> {
    this.state.value = "connecting";
    this.timer = setInterval(() => {
      this.show();
    }, shownPeriod);
    try {
      await this.object.run("watch", this.member, [], () => this.connect());
      if (this.uses === 0) await this.end();
      else this.state.value = "open";
    } catch (error) {
      this.fail(errorText(error));
    }
  }

  private fail(why: string): void {
    this.problem.value = why;
    this.state.value = "failed";
    this.ended();
  }

  private async connect(): Promise<void> {
    const { object, member } = this;
    const { remote } = object;
    if (member.kind === "wire") {
      const end = await remote.wire(member.name).connect();
      this.wireEnd = end;
      this.timeSource = "device";
      end.onValue((value, time) => {
        this.take(value, millisecondsOf(time) / 1000);
      });
      // What came before this handler was there.
      const now = end.tryGet();
      if (now) this.take(now.value, millisecondsOf(now.time) / 1000);
      end.onClosed(() => {
        this.closed();
      });
      this.stop = () => end.close();
    } else if (member.kind === "pipe") {
      const end = await remote.pipe(member.name).connect();
      this.pipeEnd = end;
      end.onPacket((value) => {
        this.arrived(value);
      });
      end.onClosed(() => {
        this.closed();
      });
      this.stop = () => end.close();
    } else {
      await this.poll();
    }
  }

  private async poll(): Promise<void> {
    let isOver = false;
    const { remote } = this.object;
    const next = async (): Promise<void> => {
      const begin = performance.now();
      this.arrived(this.member.kind === "function" ? await remote.call(this.member.name) : await remote.get(this.member.name));
      const took = performance.now() - begin;
      if (!isOver) {
        setTimeout(
          () => {
            if (!isOver) next().catch((error: unknown) => {
              this.fail(errorText(error));
            });
          },
          Math.max(this.period - took, took, 10),
        );
      }
    };
    this.stop = () => {
      isOver = true;
      return Promise.resolve();
    };
    await next();
  }

  private arrived(value: unknown): void {
    const inside = deviceTime(value);
    this.timeSource = inside === undefined ? "arrival" : "device";
    this.take(value, inside ?? (performance.timeOrigin + performance.now()) / 1000);
  }

  private take(value: unknown, seconds: number): void {
    this.last = { value, seconds };
    ++this.count;
    for (const listener of this.listeners) listener(value, seconds);
  }

  private show(): void {
    if (this.last !== undefined && this.last !== this.shown.peek()) this.shown.value = this.last;
    const now = performance.now();
    if (now - this.countedAt < 1000) return;
    this.rate.value = ((this.count - this.counted) * 1000) / (now - this.countedAt);
    this.counted = this.count;
    this.countedAt = now;
  }

  private closed(): void {
    if (this.state.value === "closed") return;
    clearInterval(this.timer);
    this.state.value = "closed";
    this.ended();
  }

  private async end(): Promise<void> {
    clearInterval(this.timer);
    const { state } = this;
    const wasOpen = state.value !== "failed";
    state.value = "closed";
    this.ended();
    try {
      if (wasOpen) await this.stop();
    } catch {
      // The session may have ended already.
    }
  }
}

export function feedKey(object: DeviceObject, member: string): string {
  return `${object.device.url}\n${object.path}\n${member}`;
}

/** The feeds that are in use. */
export class Feeds {
  private readonly known = new Map<string, Feed>();

  of(object: DeviceObject, member: Member): Feed {
    const key = feedKey(object, member.name);
    const found = this.known.get(key);
    if (found && found.object.remote === object.remote) return found;
    const made: Feed = new Feed(object, member, () => {
      if (this.known.get(key) === made) this.known.delete(key);
    });
    this.known.set(key, made);
    return made;
  }
}
