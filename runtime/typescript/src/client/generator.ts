// SPDX-License-Identifier: Apache-2.0
import type { Member } from "../definition/types.js";
import { EntryType } from "../entry_type.js";
import { ErrorCode, errorName, RRError } from "../errors.js";
import { numberElement, textElement } from "../value/pack.js";
import { findElement } from "../value/shapes.js";
import type { RemoteObject } from "./remote_object.js";
import type { CallOptions } from "./session.js";

/** What `next` gives: a value, or the end. */
export type Step<R> = { done: false; value: R } | { done: true; value: undefined };

/**
 * Values that a service gives, or takes, one step after the other. In a loop `for await` it is closed when the
 * loop is left.
 */
export class RemoteGenerator<R = unknown, P = unknown> implements AsyncIterable<R> {
  private isOver = false;

  /** @internal */
  constructor(
    private readonly object: RemoteObject,
    private readonly member: Member,
    private readonly index: number,
  ) {}

  /** One step. A generator that takes values is given one. Rejects with what the service raises, but for its end. */
  async next(...[parameter, options]: P extends undefined ? [parameter?: undefined, options?: CallOptions] : [parameter: P, options?: CallOptions]): Promise<Step<R>> {
    const { generator, type } = this.member;
    const elements = [numberElement("index", "int32", this.index)];
    if (generator?.takes) elements.push(this.object.packer.value(generator.takes, parameter, "parameter"));
    try {
      const answer = await this.request(elements, 0, options);
      const value = generator?.gives ? this.object.unpacker.value(type, findElement(answer.elements, "return")) : undefined;
      return { done: false, value: value as R };
    } catch (error) {
      if (!(error instanceof RRError)) throw error;
      this.isOver = true;
      if (error.code === ErrorCode.StopIteration) return { done: true, value: undefined };
      throw error;
    }
  }

  /** Tells the service that nothing more is wanted. */
  async close(options?: CallOptions): Promise<void> {
    await this.finish(ErrorCode.StopIteration, "", options);
  }

  /** Tells the service to stop what it does. */
  async abort(options?: CallOptions): Promise<void> {
    await this.finish(ErrorCode.AbortOperation, "Generator abort requested", options);
  }

  private async finish(code: number, message: string, options?: CallOptions): Promise<void> {
    this.isOver = true;
    const elements = [textElement("errorname", errorName(code)), textElement("errorstring", message), numberElement("index", "int32", this.index)];
    await this.request(elements, code, options);
  }

  private request(elements: Parameters<RemoteObject["session"]["request"]>[0]["elements"] & object, error: number, options: CallOptions = {}): ReturnType<RemoteObject["session"]["request"]> {
    const { path, session } = this.object;
    return session.request({ type: EntryType.generatorNext, path, member: this.member.name, elements, error, ...options });
  }

  /** Values until the end. Only of generators that take nothing. */
  async *[Symbol.asyncIterator](): AsyncGenerator<R, void, undefined> {
    const next: () => Promise<Step<R>> = this.next.bind(this);
    try {
      for (;;) {
        const step = await next();
        if (step.done) return;
        yield step.value;
      }
    } finally {
      if (!this.isOver) await this.close();
    }
  }
}

/**
 * A function that generates, while it is being called: awaited it is the generator, and in a loop `for await` its
 * values.
 */
export class GeneratorCall<R = unknown> implements PromiseLike<RemoteGenerator<R, undefined>>, AsyncIterable<R> {
  /** @internal */
  constructor(private readonly opening: Promise<RemoteGenerator<R, undefined>>) {}

  then<A = RemoteGenerator<R, undefined>, B = never>(
    onOpen?: ((generator: RemoteGenerator<R, undefined>) => A | PromiseLike<A>) | null,
    onError?: ((reason: unknown) => B | PromiseLike<B>) | null,
  ): Promise<A | B> {
    return this.opening.then(onOpen, onError);
  }

  /** The values, one after the other: `for await (const value of arm.scan("pan"))`. Each step is a request. */
  async *[Symbol.asyncIterator](): AsyncGenerator<R, void, undefined> {
    yield* await this.opening;
  }
}
