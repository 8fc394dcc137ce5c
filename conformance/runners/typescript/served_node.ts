// SPDX-License-Identifier: Apache-2.0
// `serve`: services that do what service.json says.
import { Definitions, PasswordUsers, RRNode, type Service } from "../../../runtime/typescript/src/index.node.js";
import { list, object, part, text, type Json, type JsonObject } from "../../../runtime/typescript/test/notation/json.js";
import { valueOfJson } from "../../../runtime/typescript/test/notation/values.js";
import { nodeOptions } from "./node_settings.js";
import { Script } from "./script.js";

export class ServedNode {
  private node: RRNode | undefined;
  private readonly services = new Map<string, Service>();

  constructor(private readonly definitions: Definitions) {}

  async answer(request: JsonObject): Promise<Json> {
    if (request["do"] === "start") return await this.start(request);
    if (request["do"] !== "close_service") throw new Error(`unknown request ${String(request["do"])}`);
    this.services.get(text(request["service"]))?.close();
    return { done: true };
  }

  async stop(): Promise<void> {
    this.services.clear();
    await this.node?.close();
  }

  private async start(request: JsonObject): Promise<Json> {
    await this.stop();
    this.node = new RRNode(nodeOptions(request));
    const all = list(request["services"]).map(object);
    for (const service of all) this.offer(this.node, service, all);
    return { port: await this.node.listen({ host: "127.0.0.1", port: (part(request, "port") ?? 0) as number }) };
  }

  private offer(node: RRNode, service: JsonObject, all: JsonObject[]): void {
    const given = object(part(service, "attributes") ?? {});
    const any = this.definitions.type("varvalue");
    const attributes = Object.fromEntries(Object.entries(given).map(([name, value]) => [name, valueOfJson(this.definitions, any, value)]));
    const auth = part(service, "auth");
    const users = auth === undefined ? {} : { users: new PasswordUsers(text(part(auth, "password_file"))) };
    const requireUser = part(part(auth, "policies"), "requirevaliduser") === "true";
    const name = text(service["name"]);
    const type = text(service["object"]);
    // Only what the root's definition imports belongs to the service.
    const known = new Definitions(this.definitions.withImports(type.slice(0, type.lastIndexOf("."))).map((one) => one.text));
    const { served } = new Script(known, type, scriptOf(service, all));
    this.services.set(name, node.registerService(name, served, { attributes, ...users, requireUser }));
  }
}

/** The script of a service's root: its own, or "as NAME" for that of another. */
function scriptOf(service: JsonObject, all: readonly JsonObject[]): Json {
  const { node } = service;
  if (typeof node !== "string") return node ?? {};
  const found = all.find((other) => node === `as ${text(other["name"])}`);
  if (!found) throw new Error(`there is no script ${node}`);
  return found["node"] ?? {};
}
