// SPDX-License-Identifier: Apache-2.0
// What one object is told to do, a node of service.json, and its state. Functions that drive other members are known
// by their names: fire_<event>, send_<pipe>, close_<pipe>, received_count, send_<wire>, close_<wire>, last_<wire>,
// call_<callback>, release_child; with _later behind it a function does so when it has been answered. An outcome with
// `does` gives such a name to any function.
import {
  makeError,
  RRError,
  ServedObject,
  type Caller,
  type Definitions,
  type GeneratorSource,
  type MemoryContent,
  type Monitor,
  type ObjectHandlers,
  type Service,
} from "../../../runtime/typescript/src/index.node.js";
import type { Member, ValueType } from "../../../runtime/typescript/src/definition/types.js";
import { list, number, object, part, text, type Json, type JsonObject } from "../../../runtime/typescript/test/notation/json.js";
import { jsonOfValue, valueOfJson } from "../../../runtime/typescript/test/notation/values.js";
import { outcomeOfCall, raiseTold } from "./outcomes.js";

const later = "_later";
/** An answer is long gone then. */
const delay = 50;
const notSet = 106;
const invalidArgument = 18;

/** Does what a function is for; told the type that the function is to give, and who calls. */
type Action = (resultType: string, caller: Caller) => Json | Promise<Json>;

export class Script implements ObjectHandlers {
  readonly served: ServedObject;
  readonly monitor?: Monitor;
  private readonly node: JsonObject;
  private readonly actions = new Map<string, Action>();
  private readonly calls = new Map<string, number>();
  private readonly children = new Map<string, ServedObject>();
  private received = 0;
  private service: Service | undefined;

  constructor(
    private readonly definitions: Definitions,
    type: string,
    node: Json,
  ) {
    // Scripts change what they are told.
    this.node = structuredClone(object(node));
    this.served = new ServedObject(definitions, type, this);
    const members = [...this.served.type.members.values()];
    if (members.some(({ nolock }) => nolock)) this.monitor = makeMonitor();
    for (const member of members) this.addMember(member);
  }

  attached(service: Service): void {
    this.service = service;
  }

  private told(kind: string, name: string): Json | undefined {
    return part(part(this.node, kind), name);
  }

  get(property: string): unknown {
    const told = this.told("properties", property);
    const error = part(told, "get_throw");
    if (error !== undefined) raiseTold(this.definitions, error, []);
    const { type } = this.served.member(property, "property");
    return valueOfJson(this.definitions, type, part(told, "value") ?? null);
  }

  set(property: string, value: unknown): void {
    const error = part(this.told("properties", property), "set_throw");
    if (error !== undefined) raiseTold(this.definitions, error, []);
    const { type } = this.served.member(property, "property");
    const properties = object(this.node["properties"] ?? {});
    properties[property] = { value: jsonOfValue(this.definitions, type, value) };
    this.node["properties"] = properties;
  }

  async call(name: string, args: readonly unknown[], caller: Caller): Promise<unknown> {
    const member = this.served.member(name, "function");
    const parameters = jsonOfParameters(this.definitions, member, args);
    const result = await this.outcome(name, parameters, member.type, caller);
    return valueOfJson(this.definitions, member.type, result);
  }

  private async outcome(name: string, parameters: Json[], type: ValueType, caller: Caller): Promise<Json> {
    if (!this.saysWhatItDoes(name)) {
      const done = await this.act(name, parameters, type, caller);
      if (done !== undefined) return done;
    }
    const next = this.nextOutcome(name, parameters);
    const other = part(next, "does");
    if (typeof other === "string") {
      const done = await this.act(other, parameters, type, caller);
      if (done === undefined) throw new Error(`nothing is called ${other}`);
      return done;
    }
    const echo = part(next, "echo");
    return (echo === undefined ? part(next, "return") : parameters[number(echo)]) ?? null;
  }

  /** Whether an outcome says what the function does, whatever its name says. */
  private saysWhatItDoes(name: string): boolean {
    const told = this.told("functions", name);
    return (Array.isArray(told) ? told : [told]).some((outcome) => part(outcome, "does") !== undefined);
  }

  /** Does what a function of this name is for; undefined for a name that says nothing. */
  private async act(name: string, parameters: Json[], type: ValueType, caller: Caller): Promise<Json | undefined> {
    if (name === "release_child") {
      this.service?.release(`${this.service.name}.${text(parameters[0])}`);
      return null;
    }
    const action = this.actions.get(name);
    if (action) return await action(type.text, caller);
    const putOff = name.endsWith(later) ? this.actions.get(name.slice(0, -later.length)) : undefined;
    if (!putOff) return undefined;
    const fired = this.actions.get(`fire_answered_${name.slice(name.indexOf("_") + 1, -later.length)}`);
    this.doLater(name, async () => {
      await putOff("", caller);
      await fired?.("", caller);
    });
    return null;
  }

  private nextOutcome(name: string, parameters: Json[]): Json | undefined {
    const call = this.calls.get(name) ?? 0;
    this.calls.set(name, call + 1);
    const next = outcomeOfCall(this.told("functions", name), call);
    const error = part(next, "throw");
    if (error !== undefined) raiseTold(this.definitions, error, parameters);
    return next;
  }

  private doLater(name: string, what: () => unknown): void {
    const run = async (): Promise<void> => {
      try {
        await what();
      } catch (error) {
        // Whom it was for may have gone.
        if (!(error instanceof RRError)) process.stderr.write(`${name}: ${String(error)}\n`);
      }
    };
    setTimeout(() => void run(), delay);
  }

  generate(name: string, args: readonly unknown[]): GeneratorSource {
    const member = this.served.member(name, "function");
    const steps = this.nextOutcome(name, jsonOfParameters(this.definitions, member, args));
    const values = part(steps, "yield");
    const count = values === undefined ? number(part(steps, "accept") ?? 0) : list(values).length;
    let step = 0;
    return {
      next: () => {
        if (step < count) {
          const value = values === undefined ? null : (list(values)[step] ?? null);
          ++step;
          return { done: false, value: member.generator?.gives ? valueOfJson(this.definitions, member.type, value) : undefined };
        }
        const end = part(steps, "end");
        if (end !== undefined) raiseTold(this.definitions, end, []);
        return { done: true, value: undefined };
      },
    };
  }

  object(objref: string, index: number | string | undefined): ServedObject | null {
    const key = `${objref}[${String(index)}]`;
    const known = this.children.get(key);
    if (known) return known;
    let told = this.told("objrefs", objref);
    if (told === undefined) return null;
    if (index !== undefined) {
      told = part(part(told, "items"), String(index));
      if (told === undefined) throw makeError(invalidArgument, `no object with index ${String(index)}`);
    }
    const { served } = new Script(this.definitions, text(part(told, "type")), part(told, "node") ?? {});
    this.children.set(key, served);
    return served;
  }

  private addMember(member: Member): void {
    switch (member.kind) {
      case "event":
        this.actions.set(`fire_${member.name}`, () => {
          for (const args of list(this.told("events", member.name) ?? [])) this.served.event(member.name).fire(...this.argumentsOf(member, args));
          return null;
        });
        break;
      case "pipe":
        this.addPipe(member);
        break;
      case "wire":
        this.addWire(member);
        break;
      case "callback":
        this.addCallback(member);
        break;
      case "memory": {
        const content = this.told("memories", member.name);
        if (content !== undefined) this.served.memory(member.name).store(valueOfJson(this.definitions, member.type, content) as MemoryContent);
        break;
      }
      default:
    }
  }

  private argumentsOf(member: Member, json: Json): unknown[] {
    return list(json).map((one, i) => {
      const parameter = member.parameters[i];
      if (!parameter) throw new Error(`${member.name} has less parameters`);
      return valueOfJson(this.definitions, parameter.type, one);
    });
  }

  private addPipe({ name, type }: Member): void {
    const pipe = this.served.pipe(name);
    pipe.onConnect((end) => {
      end.onPacket(() => {
        ++this.received;
      });
    });
    this.actions.set("received_count", () => this.received);
    this.actions.set(`send_${name}`, () => {
      for (const end of pipe.ends) {
        for (const entry of list(this.told("pipes", name) ?? [])) {
          end.requestsAcknowledgements = part(entry, "ack") === true;
          end.send(valueOfJson(this.definitions, type, part(entry, "packet") ?? null));
        }
      }
      return null;
    });
    this.actions.set(`close_${name}`, async () => {
      await Promise.all(pipe.ends.map((end) => end.close()));
      return null;
    });
  }

  private addWire({ name, type }: Member): void {
    const wire = this.served.wire(name);
    const scripted = (key: string): unknown => {
      const values = object(this.told("wires", name) ?? {});
      if (!Object.hasOwn(values, key)) throw makeError(notSet, "Value not set");
      return valueOfJson(this.definitions, type, values[key] ?? null);
    };
    const send = (value: unknown): void => {
      for (const end of wire.ends) end.send(value);
    };
    wire.peekIn = () => scripted("peek_in");
    wire.peekOut = () => {
      const newest = wire.tryGet();
      return newest ? newest.value : scripted("peek_out");
    };
    wire.onConnect(() => {
      if (part(this.told("wires", name), "at_connect") !== true) return;
      this.doLater(`${name} at_connect`, () => {
        send(scripted("peek_in"));
      });
    });
    this.actions.set(`send_${name}`, () => {
      for (const value of list(part(this.told("wires", name), "send") ?? [])) send(valueOfJson(this.definitions, type, value));
      return null;
    });
    this.actions.set(`last_${name}`, () => {
      const newest = wire.tryGet();
      if (!newest) throw makeError(notSet, "Value not set");
      return jsonOfValue(this.definitions, type, newest.value);
    });
    this.actions.set(`close_${name}`, async () => {
      await Promise.all(wire.ends.map((end) => end.close()));
      return null;
    });
  }

  /** A function of another type tells the error as a text. */
  private addCallback(member: Member): void {
    this.actions.set(`call_${member.name}`, async (resultType, { client }) => {
      try {
        const args = this.argumentsOf(member, this.told("callbacks", member.name) ?? []);
        return jsonOfValue(this.definitions, member.type, await this.served.callback(member.name).call(client, args));
      } catch (error) {
        if (!(error instanceof RRError) || resultType === member.type.text) throw error;
        return `${error.errorName}: ${error.message}`;
      }
    });
  }
}

function jsonOfParameters(definitions: Definitions, member: Member, args: readonly unknown[]): Json[] {
  return member.parameters.map(({ type }, i) => jsonOfValue(definitions, type, args[i]));
}

function makeMonitor(): Monitor {
  let isHeld = false;
  const waiting: ((entered: boolean) => void)[] = [];
  return {
    enter: (timeout) => {
      if (!isHeld) {
        isHeld = true;
        return Promise.resolve(true);
      }
      return new Promise((resolve) => {
        const timer = setTimeout(() => {
          waiting.splice(waiting.indexOf(enter), 1);
          resolve(false);
        }, timeout);
        const enter = (): void => {
          clearTimeout(timer);
          resolve(true);
        };
        waiting.push(enter);
      });
    },
    exit: () => {
      const next = waiting.shift();
      if (next) next(true);
      else isHeld = false;
    },
  };
}
