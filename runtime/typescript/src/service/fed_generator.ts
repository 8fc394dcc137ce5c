// SPDX-License-Identifier: Apache-2.0
// Generators of services: what functions give as sequences, and take as sequences, step by step.
import { ErrorCode, makeError } from "../errors.js";
import type { GeneratorSource } from "./served_object.js";

/** What a function gives one after the other: an async generator, or an array. */
export type Values<R> = AsyncIterable<R> | Iterable<R>;

/** Items that were given and not taken. */
const itemLimit = 1024;

/** The steps of a sequence. */
export function sourceOf<R>(values: Values<R>): GeneratorSource<R> {
  const iterator = Symbol.asyncIterator in values ? values[Symbol.asyncIterator]() : values[Symbol.iterator]();
  return {
    next: () => iterator.next(),
    return: () => iterator.return?.(),
    throw: (error) => (iterator.throw ? iterator.throw(error) : iterator.return?.()),
  };
}

interface Wish<P> {
  resolve: (step: IteratorResult<P, undefined>) => void;
  reject: (reason: unknown) => void;
}

/** Items that a client gives, one with each step. */
class FedItems<P> implements AsyncIterableIterator<P> {
  private readonly waiting: P[] = [];
  private wish: Wish<P> | undefined;
  private end: { error: unknown } | undefined;
  private idle: (() => void)[] = [];

  put(item: P): void {
    const { wish } = this;
    this.wish = undefined;
    if (wish) wish.resolve({ done: false, value: item });
    else if (this.waiting.length < itemLimit) this.waiting.push(item);
    else throw makeError(ErrorCode.OutOfSystemResource, "the generator does not take what it is given");
  }

  /** Nothing more comes; with an error, the one who waits gets it. */
  finish(error?: unknown): void {
    this.end ??= { error };
    const { wish } = this;
    this.wish = undefined;
    if (!wish) return;
    if (error === undefined) wish.resolve({ done: true, value: undefined });
    else wish.reject(error);
  }

  /** Resolves when all items are taken and another one is wanted. */
  allTaken(): Promise<void> {
    if (this.wish) return Promise.resolve();
    return new Promise((resolve) => this.idle.push(resolve));
  }

  next(): Promise<IteratorResult<P, undefined>> {
    if (this.waiting.length > 0) return Promise.resolve({ done: false, value: this.waiting.shift() as P });
    if (this.end?.error !== undefined) return Promise.reject(this.end.error);
    if (this.end) return Promise.resolve({ done: true, value: undefined });
    return new Promise((resolve, reject) => {
      this.wish = { resolve, reject };
      for (const one of this.idle) one();
      this.idle = [];
    });
  }

  return(): Promise<IteratorResult<P, undefined>> {
    this.finish();
    return Promise.resolve({ done: true, value: undefined });
  }

  [Symbol.asyncIterator](): this {
    return this;
  }
}

/** The steps of a function that takes a sequence: each is over when the function wants the next item. */
export function sinkOf<P>(run: (items: AsyncIterable<P>) => unknown): GeneratorSource<undefined, P> {
  const items = new FedItems<P>();
  const over = (async () => {
    await run(items);
    return true;
  })();
  // Told at the next step.
  over.catch(() => undefined);
  const settled = (): Promise<unknown> => over.catch(() => undefined);
  return {
    next: async (item) => {
      items.put(item);
      const isOver = await Promise.race([over, items.allTaken().then(() => false)]);
      return isOver ? { done: true, value: undefined } : { done: false, value: undefined };
    },
    return: () => {
      items.finish();
      return settled();
    },
    throw: (error) => {
      items.finish(error);
      return settled();
    },
  };
}

/** The steps of a function that takes a sequence and gives one: each gives an item and gets one. */
export function filterOf<R, P>(run: (items: AsyncIterable<P>) => Values<R>): GeneratorSource<R, P> {
  const items = new FedItems<P>();
  const source = sourceOf(run(items));
  return {
    next: (item) => {
      items.put(item);
      return source.next(undefined);
    },
    return: () => {
      items.finish();
      return source.return?.();
    },
    throw: (error) => {
      items.finish(error);
      return source.throw?.(error);
    },
  };
}
