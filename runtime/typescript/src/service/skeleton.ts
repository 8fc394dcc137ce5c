// SPDX-License-Identifier: Apache-2.0
// What generated classes for services stand on.
import { ErrorCode, makeError } from "../errors.js";
import type { MaybePromise, ServiceModule } from "../module.js";
import { filterOf, sinkOf, sourceOf, type Values } from "./fed_generator.js";
import type { ServedCallback, ServedEvent } from "./served_calls.js";
import type { MemoryContent, ServedMemory } from "./served_memory.js";
import { ServedObject, type Caller, type GeneratorSource, type Monitor, type ObjectHandlers } from "./served_object.js";
import type { ServedPipe } from "./served_pipe.js";
import type { ServedWire } from "./served_wire.js";
import type { Service } from "./service.js";

/** What a class that is served may have besides the methods for its members. */
export interface Servant {
  /** For objects that clients take in turns. */
  rr_monitor?: Monitor;
  /** Called when a service offers the object at a path. */
  rr_attached?(service: Service, path: string): void;
  /** Called when no service offers it any more. */
  rr_detached?(): void;
}

/** The methods of `S` that serve one member. */
export interface MemberMethods<S> {
  /** As the definition calls it. */
  readonly member: string;
  /** Of a property: gives its value; of an objref: gives the object. */
  readonly get?: keyof S & string;
  /** Of a property: takes its value. */
  readonly set?: keyof S & string;
  /** Of a function or generator. */
  readonly call?: keyof S & string;
  /** Of an objref: what serves an object that is no skeleton. */
  readonly skeleton?: () => new (servant: never) => Skeleton;
}

/** The methods of `S`. */
export type MethodTable<S> = readonly MemberMethods<S>[];

type AnyMethods = MemberMethods<never>;
type Method = (...args: unknown[]) => unknown;
type Bindable = Servant & { rr_bind?(skeleton: Skeleton): void };

/** An object is offered by one skeleton of a class, however often an objref gives it. */
const skeletons = new WeakMap<object, Map<unknown, Skeleton>>();

/**
 * Serves an object of the program, a method for each member. Generated classes extend it; their own members begin
 * with `rr_`, which no definition's do.
 */
export abstract class Skeleton {
  /** What the runtime offers. */
  readonly rr_served: ServedObject;
  private readonly rr_methods: ReadonlyMap<string, AnyMethods>;

  /** Generated classes say their module, their type, and what they call the methods. */
  constructor(module: ServiceModule, type: string, private readonly rr_servant: Servant, methods: MethodTable<never>) {
    this.rr_methods = new Map(methods.map((one) => [one.member, one]));
    this.rr_served = new ServedObject(module.definitions, type, this.rr_handlers());
    (rr_servant as Bindable).rr_bind?.(this);
  }

  private rr_handlers(): ObjectHandlers {
    const servant = this.rr_servant;
    return {
      get: (property, caller) => this.rr_method(property, "get")(caller),
      set: (property, value, caller) => this.rr_method(property, "set")(value, caller),
      call: (name, args, caller) => this.rr_method(name, "call")(...args, caller),
      generate: (name, args, caller) => this.rr_generator(name, args, caller),
      object: (objref, index) => this.rr_object(objref, index),
      get monitor() {
        return servant.rr_monitor as Monitor;
      },
      attached: (service, path) => {
        servant.rr_attached?.(service, path);
      },
      detached: () => {
        servant.rr_detached?.();
      },
    };
  }

  private rr_method(member: string, verb: "get" | "set" | "call"): Method {
    const name = this.rr_methods.get(member)?.[verb];
    const found = name === undefined ? undefined : (this.rr_servant as unknown as Record<string, unknown>)[name];
    if (typeof found !== "function") throw makeError(ErrorCode.NotImplementedError, `${member} is not implemented`);
    return found.bind(this.rr_servant) as Method;
  }

  private rr_generator(name: string, args: readonly unknown[], caller: Caller): MaybePromise<GeneratorSource> {
    const method = this.rr_method(name, "call");
    const { generator } = this.rr_served.member(name, "function");
    if (!generator?.takes) return Promise.resolve(method(...args, caller)).then((values) => sourceOf(values as Values<unknown>));
    const run = (items: AsyncIterable<unknown>): unknown => method(...args, items, caller);
    return generator.gives ? filterOf(run as (items: AsyncIterable<unknown>) => Values<unknown>) : sinkOf(run);
  }

  private async rr_object(objref: string, index: number | string | undefined): Promise<ServedObject | null> {
    const found = await this.rr_method(objref, "get")(...(index === undefined ? [] : [index]));
    if (found === null || found === undefined) return null;
    if (found instanceof Skeleton) return found.rr_served;
    const made = this.rr_methods.get(objref)?.skeleton?.();
    if (!made || typeof found !== "object") throw makeError(ErrorCode.InternalError, `${objref} gave no object`);
    return skeletonOf(found, made as unknown as new (servant: object) => Skeleton).rr_served;
  }

  /** For generated code: an event. */
  protected rr_event<A extends unknown[]>(name: string): ServedEvent<A> {
    return this.rr_served.event(name);
  }

  /** For generated code: a callback. */
  protected rr_callback<A extends unknown[], R>(name: string): ServedCallback<A, R> {
    return this.rr_served.callback(name) as unknown as ServedCallback<A, R>;
  }

  /** For generated code: a pipe. */
  protected rr_pipe<T>(name: string): ServedPipe<T> {
    return this.rr_served.pipe(name) as unknown as ServedPipe<T>;
  }

  /** For generated code: a wire. */
  protected rr_wire<T>(name: string): ServedWire<T> {
    return this.rr_served.wire(name) as unknown as ServedWire<T>;
  }

  /** For generated code: a memory. */
  protected rr_memory<C extends MemoryContent>(name: string): ServedMemory<C> {
    return this.rr_served.memory(name);
  }
}

function skeletonOf(servant: object, made: new (servant: object) => Skeleton): Skeleton {
  const known = skeletons.get(servant) ?? new Map<unknown, Skeleton>();
  skeletons.set(servant, known);
  const skeleton = known.get(made) ?? new made(servant);
  known.set(made, skeleton);
  return skeleton;
}

export type { Caller };
