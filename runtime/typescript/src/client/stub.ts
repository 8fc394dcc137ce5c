// SPDX-License-Identifier: Apache-2.0
// What generated classes for clients stand on.
import type { ServiceModule } from "../module.js";
import type { MultiDimMemory, ArrayMemory } from "./memory.js";
import type { Pipe } from "./pipe.js";
import type { Callback, EventSource, RemoteObject } from "./remote_object.js";
import { GeneratorCall, type RemoteGenerator } from "./generator.js";
import type { CallOptions } from "./session.js";
import type { Wire } from "./wire.js";

/** A class of generated code for objects of one type. */
export interface StubClass<T extends Stub = Stub> {
  /** Wraps an object of the type. */
  new (object: RemoteObject): T;
  /** The qualified name of the type. */
  readonly rr_type: string;
  /** The definition that declares the type. */
  readonly rr_module: ServiceModule;
}

/** An object of a service as generated code has it. Its own members begin with `rr_`, which no definition's do. */
export abstract class Stub {
  /** @param rr_object - The object itself, for what generated code does not have. */
  constructor(readonly rr_object: RemoteObject) {}

  /** For generated code: gets a property. */
  protected rr_get<T>(name: string, options?: CallOptions): Promise<T> {
    return this.rr_object.get(name, options) as Promise<T>;
  }

  /** For generated code: sets a property. */
  protected rr_set(name: string, value: unknown, options?: CallOptions): Promise<void> {
    return this.rr_object.set(name, value, options);
  }

  /** For generated code: calls a function. */
  protected rr_call<T>(name: string, args: readonly unknown[], options?: CallOptions): Promise<T> {
    return this.rr_object.call(name, args, options) as Promise<T>;
  }

  /** For generated code: calls a generator function that takes nothing. */
  protected rr_generate<R>(name: string, args: readonly unknown[], options?: CallOptions): GeneratorCall<R> {
    return new GeneratorCall(this.rr_open<R, undefined>(name, args, options));
  }

  /** For generated code: calls a generator function. */
  protected rr_open<R, P>(name: string, args: readonly unknown[], options?: CallOptions): Promise<RemoteGenerator<R, P>> {
    return this.rr_object.generate(name, args, options) as Promise<unknown> as Promise<RemoteGenerator<R, P>>;
  }

  /** For generated code: the object at an objref. */
  protected async rr_find<T extends Stub>(name: string, stub: StubClass<T>, index?: number | string): Promise<T> {
    return new stub(await this.rr_object.object(name, index));
  }

  /** For generated code: the object at an objref of any type. */
  protected rr_find_any(name: string, index?: number | string): Promise<RemoteObject> {
    return this.rr_object.object(name, index);
  }

  /** For generated code: an event. */
  protected rr_event<A extends unknown[]>(name: string): EventSource<A> {
    return this.rr_object.event(name) as unknown as EventSource<A>;
  }

  /** For generated code: a callback. */
  protected rr_callback<F>(name: string): Callback<F> {
    return this.rr_object.callback(name) as unknown as Callback<F>;
  }

  /** For generated code: a pipe. */
  protected rr_pipe<T>(name: string): Pipe<T> {
    return this.rr_object.pipe(name) as unknown as Pipe<T>;
  }

  /** For generated code: a wire. */
  protected rr_wire<T>(name: string): Wire<T> {
    return this.rr_object.wire(name) as unknown as Wire<T>;
  }

  /** For generated code: a memory of one dimension. */
  protected rr_array_memory<A extends ArrayLike<unknown>>(name: string): ArrayMemory<A> {
    return this.rr_object.memory(name) as unknown as ArrayMemory<A>;
  }

  /** For generated code: a memory of several dimensions. */
  protected rr_multi_dim_memory<A extends ArrayLike<unknown>>(name: string): MultiDimMemory<A> {
    return this.rr_object.memory(name) as unknown as MultiDimMemory<A>;
  }
}
