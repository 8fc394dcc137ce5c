// SPDX-License-Identifier: Apache-2.0
import { ErrorCode, makeError } from "./errors.js";

interface Waiter<T> {
  resolve(item: T | undefined): void;
  reject(error: unknown): void;
}

/** Items that wait for who reads them. Ends with what was put before its end still readable. */
export class AsyncQueue<T> {
  private items: T[] = [];
  private start = 0;
  private readonly waiters: Waiter<T>[] = [];
  private ending: { error: Error | undefined } | undefined;

  constructor(private readonly limit = Infinity) {}

  get length(): number {
    return this.items.length - this.start;
  }

  get isEnded(): boolean {
    return this.ending !== undefined;
  }

  /** False, and nothing put, when the queue is full or has ended. */
  put(item: T): boolean {
    if (this.ending) return false;
    const waiter = this.waiters.shift();
    if (waiter) {
      waiter.resolve(item);
      return true;
    }
    if (this.length >= this.limit) return false;
    this.items.push(item);
    return true;
  }

  /** Undefined when there is nothing now. */
  take(): T | undefined {
    if (this.start >= this.items.length) return undefined;
    const item = this.items[this.start++];
    if (this.start > 64 && 2 * this.start > this.items.length) {
      this.items = this.items.slice(this.start);
      this.start = 0;
    }
    return item;
  }

  peek(): T | undefined {
    return this.items[this.start];
  }

  /** The next item; undefined at the end. Rejects with the error that the queue ended with, or the signal's reason. */
  next(signal?: AbortSignal): Promise<T | undefined> {
    if (signal?.aborted) return Promise.reject(signal.reason as Error);
    const item = this.take();
    if (item !== undefined) return Promise.resolve(item);
    if (this.ending) return this.ending.error ? Promise.reject(this.ending.error) : Promise.resolve(undefined);
    return new Promise((resolve, reject) => {
      const finish = (): void => {
        signal?.removeEventListener("abort", abort);
      };
      const waiter: Waiter<T> = {
        resolve: (one) => {
          finish();
          resolve(one);
        },
        reject: (error) => {
          finish();
          reject(error);
        },
      };
      const abort = (): void => {
        const at = this.waiters.indexOf(waiter);
        if (at >= 0) this.waiters.splice(at, 1);
        waiter.reject(signal?.reason);
      };
      signal?.addEventListener("abort", abort, { once: true });
      this.waiters.push(waiter);
    });
  }

  /** Nothing can be put any more. With an error, readers get it once everything is read. */
  end(error?: Error): void {
    if (this.ending) return;
    this.ending = { error };
    for (const waiter of this.waiters.splice(0)) {
      if (error) waiter.reject(error);
      else waiter.resolve(undefined);
    }
  }

  /** Items until the end; or until the loop is left, when `left` is called. */
  async *iterate(signal?: AbortSignal, left?: () => void): AsyncGenerator<T, void, undefined> {
    try {
      for (;;) {
        const item = await this.next(signal);
        if (item === undefined) return;
        yield item;
      }
    } finally {
      left?.();
    }
  }
}

/** The error of readers that are slower than what comes. */
export function overflow(what: string): Error {
  return makeError(ErrorCode.BufferLimitViolation, `${what}: too many wait to be read`);
}
