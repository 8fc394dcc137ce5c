// SPDX-License-Identifier: Apache-2.0
// `call`: a client that does what the steps of a plan say.
import { setTimeout as sleep } from "node:timers/promises";
import {
  RRError,
  RRNode,
  Definitions,
  type Client,
  type PipeEnd,
  type RemoteGenerator,
  type RemoteObject,
  type WireEnd,
} from "../../../runtime/typescript/src/index.node.js";
import type { Member, ValueType } from "../../../runtime/typescript/src/definition/types.js";
import { escapeIndex } from "../../../runtime/typescript/src/path.js";
import { list, number, object, part, text, type Json, type JsonObject } from "../../../runtime/typescript/test/notation/json.js";
import { jsonOfValue, valueOfJson } from "../../../runtime/typescript/test/notation/values.js";
import { Arrivals } from "./arrivals.js";
import { playMemory } from "./memory_steps.js";
import { nodeOptions } from "./node_settings.js";
import { outcomeOfCall, raiseTold } from "./outcomes.js";

// Numbers of the recorded client's notifications.
const clientClosed = 1;
const pathReleased = 5;

/** A step that this runner cannot play. */
class NotSupported extends Error {}

interface Held {
  object: RemoteObject;
  client: Client;
}

interface HeldEnd<T> {
  end: T;
  type: ValueType;
  definitions: Definitions;
  closing: { isOurs: boolean };
}

interface HeldGenerator {
  generator: RemoteGenerator;
  member: Member;
  definitions: Definitions;
}

export class CallingNode {
  private node: RRNode | undefined;
  private readonly arrivals = new Arrivals();
  private readonly objects = new Map<string, Held>();
  private readonly pipes = new Map<string, HeldEnd<PipeEnd>>();
  private readonly wires = new Map<string, HeldEnd<WireEnd>>();
  private readonly generators = new Map<string, HeldGenerator>();

  async answer(request: JsonObject): Promise<Json> {
    const what = text(request["do"]);
    if (what === "start") {
      await this.stop();
      this.arrivals.clear();
      this.node = new RRNode(nodeOptions(request));
      return { done: true };
    }
    if (what === "stop_node") {
      await this.stop();
      return { done: true };
    }
    try {
      return { result: (await this.play(object(request["step"]))) ?? null };
    } catch (error) {
      if (error instanceof RRError) return { raised: this.raised(error) };
      if (error instanceof NotSupported) return { unsupported: error.message };
      throw error;
    }
  }

  private async stop(): Promise<void> {
    await this.node?.close();
    this.node = undefined;
    for (const one of [this.objects, this.pipes, this.wires, this.generators]) one.clear();
  }

  private raised(error: RRError): JsonObject {
    const json: JsonObject = { code: error.code, name: error.errorName, message: error.message };
    if (error.subname !== "") json["subname"] = error.subname;
    if (error.parameter !== null) {
      const definitions = this.anyDefinitions();
      if (definitions) json["param"] = jsonOfValue(definitions, definitions.type("varvalue"), error.parameter);
    }
    return json;
  }

  private anyDefinitions(): Definitions | undefined {
    return [...this.objects.values()][0]?.object.session.definitions;
  }

  private async play(step: JsonObject): Promise<Json | undefined> {
    const operation = text(step["op"]);
    switch (operation) {
      case "connect":
        return await this.connect(step);
      case "disconnect":
        await this.held(step).client.close();
        return null;
      case "wait":
        return await this.arrivals.wait(number(step["count"]));
      case "drain":
        this.arrivals.clear();
        return null;
      case "sleep":
        await sleep(number(step["ms"]));
        return null;
      case "get":
      case "set":
      case "call":
        return await this.playValue(operation, step);
      case "objref":
        return await this.find(step);
      case "find_object_type": {
        const { object: parent, client } = this.held(step);
        return await client.findObjectType(`${parent.path}.${relativePath(step)}`);
      }
      case "listen":
        this.listen(step);
        return null;
      case "attributes":
        return this.attributes(step);
      case "local_services":
        return await this.localServices(step);
      case "callback_set":
        this.setCallback(step);
        return null;
      default:
    }
    if (operation.startsWith("pipe_")) return await this.playPipe(operation, step);
    if (operation.startsWith("wire_")) return await this.playWire(operation, step);
    if (operation.startsWith("mem_")) return await playMemory(operation, this.held(step).object, step);
    if (operation.startsWith("gen_")) return await this.playGenerator(operation, step);
    return await this.playSession(operation, step);
  }

  private held(step: JsonObject): Held {
    const found = this.objects.get(text(step["obj"]));
    if (!found) throw new Error(`there is no object ${text(step["obj"])}`);
    return found;
  }

  private async connect(step: JsonObject): Promise<Json> {
    const name = text(step["as"]);
    if (!this.node) throw new Error("there is no node");
    const username = part(step, "username");
    const objectType = part(step, "objecttype");
    const client = await this.node.connect(text(step["url"]), {
      ...(username === undefined ? {} : { username: text(username) }),
      ...(objectType === undefined ? {} : { objectType: text(objectType) }),
      credentials: credentialsOf(step),
    });
    client.onClosed(() => {
      this.arrivals.add({ event_type: clientClosed, service: name });
    });
    client.onPathReleased((path) => {
      this.arrivals.add({ event_type: pathReleased, path, service: name });
    });
    this.objects.set(name, { object: client.root, client });
    return { rrtype: client.root.type.name };
  }

  private async find(step: JsonObject): Promise<Json> {
    const { object: parent, client } = this.held(step);
    const member = text(step["member"]);
    const found = await parent.object(member, part(step, "index") as number | string | undefined);
    this.objects.set(text(step["as"]), { object: found, client });
    const declared = parent.member(member).objectType;
    return { rrtype: declared === "" ? found.type.name : declared };
  }

  private async playValue(operation: "get" | "set" | "call", step: JsonObject): Promise<Json> {
    const { object: target } = this.held(step);
    const { definitions } = target.session;
    const name = text(step["member"]);
    if (operation === "call") {
      const member = target.member(name);
      const args = list(step["args"]).map((one, i) => valueOfJson(definitions, needed(member.parameters[i]).type, one));
      return jsonOfValue(definitions, member.type, await target.call(name, args));
    }
    const { type } = target.member(name, "property");
    if (operation === "get") return jsonOfValue(definitions, type, await target.get(name));
    await target.set(name, valueOfJson(definitions, type, step["value"] ?? null));
    return null;
  }

  private listen(step: JsonObject): void {
    const { object: target } = this.held(step);
    const member = target.member(text(step["member"]), "event");
    const name = text(part(step, "as") ?? member.name);
    target.event(member.name).on((...args) => {
      this.arrivals.add({ event: name, args: jsonOfParameters(target.session.definitions, member, args) });
    });
  }

  private attributes(step: JsonObject): Json {
    const { client } = this.held(step);
    const { definitions } = client.session;
    const any = definitions.type("varvalue");
    return Object.fromEntries([...client.attributes].map(([name, value]) => [name, jsonOfValue(definitions, any, value)]));
  }

  private async localServices(step: JsonObject): Promise<Json> {
    const { object: target } = this.held(step);
    const services = (await target.call("GetLocalNodeServices")) as Map<number, { Name: string; RootObjectType: string }>;
    return [...services].map(([index, { Name, RootObjectType }]) => ({ index, name: Name, type: RootObjectType }));
  }

  private setCallback(step: JsonObject): void {
    const { object: target } = this.held(step);
    const { definitions } = target.session;
    const member = target.member(text(step["member"]), "callback");
    const outcomes = part(step, "outcomes");
    let calls = 0;
    target.callback(member.name).set((...args) => {
      const given = jsonOfParameters(definitions, member, args);
      this.arrivals.add({ callback: member.name, args: given });
      const outcome = outcomeOfCall(outcomes, calls++);
      const told = part(outcome, "throw");
      if (told !== undefined) raiseTold(definitions, told, given);
      return valueOfJson(definitions, member.type, part(outcome, "return") ?? null);
    });
  }

  private async playPipe(operation: string, step: JsonObject): Promise<Json> {
    if (operation === "pipe_connect") {
      const { object: target } = this.held(step);
      const member = target.member(text(step["member"]), "pipe");
      const name = text(step["as"]);
      const { definitions } = target.session;
      const end = await target.pipe(member.name).connect({ index: number(part(step, "index") ?? -1), unreliable: member.isUnreliable });
      const closing = { isOurs: false };
      end.onAcknowledged((ack) => {
        this.arrivals.add({ pipe: name, ack });
      });
      end.onClosed(() => {
        if (!closing.isOurs) this.arrivals.add({ pipe: name, closed: true });
      });
      end.onPacket((packet) => {
        this.arrivals.add({ pipe: name, packet: jsonOfValue(definitions, member.type, packet) });
      });
      this.pipes.set(name, { end, type: member.type, definitions, closing });
      return end.index;
    }
    const held = needed(this.pipes.get(text(step["handle"])));
    if (operation === "pipe_send") {
      held.end.requestsAcknowledgements = part(step, "ack") === true;
      const sent = held.end.send(valueOfJson(held.definitions, held.type, step["value"] ?? null));
      return held.end.isUnreliable ? null : sent;
    }
    if (operation !== "pipe_close") throw new NotSupported(`this runner cannot do ${operation}`);
    held.closing.isOurs = true;
    await held.end.close();
    return null;
  }

  private async playWire(operation: string, step: JsonObject): Promise<Json> {
    const handle = part(step, "handle");
    if (handle === undefined) {
      const { object: target } = this.held(step);
      const { definitions } = target.session;
      const { name, type } = target.member(text(step["member"]), "wire");
      const wire = target.wire(name);
      if (operation === "wire_peek_in") return jsonOfValue(definitions, type, (await wire.peekIn()).value);
      if (operation === "wire_peek_out") return jsonOfValue(definitions, type, (await wire.peekOut()).value);
      if (operation === "wire_poke_out") {
        await wire.pokeOut(valueOfJson(definitions, type, step["value"] ?? null));
        return null;
      }
      if (operation !== "wire_connect") throw new NotSupported(`this runner cannot do ${operation}`);
      await this.connectWire(step, target, name, type);
      return null;
    }
    const held = needed(this.wires.get(text(handle)));
    if (operation === "wire_in") return jsonOfValue(held.definitions, held.type, held.end.value);
    if (operation === "wire_set") held.end.send(valueOfJson(held.definitions, held.type, step["value"] ?? null));
    else if (operation === "wire_close") {
      held.closing.isOurs = true;
      await held.end.close();
    } else throw new NotSupported(`this runner cannot do ${operation}`);
    return null;
  }

  private async connectWire(step: JsonObject, target: RemoteObject, member: string, type: ValueType): Promise<void> {
    const name = text(step["as"]);
    const { definitions } = target.session;
    const end = await target.wire(member).connect();
    const closing = { isOurs: false };
    const early = end.tryGet();
    if (early) this.arrivals.add({ wire: name, value: jsonOfValue(definitions, type, early.value) });
    end.onValue((value) => {
      this.arrivals.add({ wire: name, value: jsonOfValue(definitions, type, value) });
    });
    end.onClosed(() => {
      if (!closing.isOurs) this.arrivals.add({ wire: name, closed: true });
    });
    this.wires.set(name, { end, type, definitions, closing });
  }

  private async playGenerator(operation: string, step: JsonObject): Promise<Json> {
    if (operation === "gen_call") {
      const { object: target } = this.held(step);
      const { definitions } = target.session;
      const member = target.member(text(step["member"]), "function");
      const args = list(step["args"]).map((one, i) => valueOfJson(definitions, needed(member.parameters[i]).type, one));
      this.generators.set(text(step["as"]), { generator: await target.generate(member.name, args), member, definitions });
      return null;
    }
    const { generator, member, definitions } = needed(this.generators.get(text(step["handle"])));
    if (operation === "gen_close") await generator.close();
    else if (operation === "gen_abort") await generator.abort();
    else if (operation === "gen_next") {
      const takes = member.generator?.takes;
      const parameter = takes ? valueOfJson(definitions, takes, part(step, "value") ?? null) : undefined;
      const next = await generator.next(parameter);
      if (next.done) return Promise.reject(new RRError(109, ""));
      return jsonOfValue(definitions, member.type, next.value);
    } else throw new NotSupported(`this runner cannot do ${operation}`);
    return null;
  }

  private async playSession(operation: string, step: JsonObject): Promise<Json> {
    const { object: target, client } = this.held(step);
    switch (operation) {
      case "authenticate":
        await client.authenticate(text(step["username"]), credentialsOf(step));
        return "OK";
      case "lock":
        await client.lock(target, part(step, "client") === true ? "session" : "user");
        return "OK";
      case "unlock":
        await client.unlock(target);
        return "OK";
      case "monitor_enter":
        await client.enterMonitor(target, number(step["timeout"]));
        return null;
      case "monitor_exit":
        await client.exitMonitor(target);
        return null;
      default:
        throw new NotSupported(`this runner cannot do ${operation}`);
    }
  }
}

function needed<T>(value: T | undefined): T {
  if (value === undefined) throw new Error("what the step is about is not there");
  return value;
}

function credentialsOf(step: JsonObject): Record<string, unknown> {
  const given = part(step, "credentials");
  const none = new Definitions();
  const values = Object.entries(given === undefined ? {} : object(given));
  return Object.fromEntries(values.map(([name, value]) => [name, valueOfJson(none, none.type("varvalue"), value)]));
}

function jsonOfParameters(definitions: Definitions, member: Member, args: readonly unknown[]): Json[] {
  return member.parameters.map(({ type }, i) => jsonOfValue(definitions, type, args[i]));
}

/** `objref` or `objref[index]`, as a step asks for it. */
function relativePath(step: JsonObject): string {
  const index = part(step, "index");
  const member = text(step["member"]);
  if (index === undefined) return member;
  return `${member}[${escapeIndex(typeof index === "string" ? index : String(number(index)))}]`;
}
