// SPDX-License-Identifier: Apache-2.0
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { list, object, part, text, type Json, type JsonObject } from "./json.js";

/** Recorded folders of the conformance suite; where they are is told by the build. */
export class Captures {
  readonly blobs: JsonObject;

  constructor(readonly folder: string) {
    try {
      this.blobs = object(this.read("blobs.json"));
    } catch {
      this.blobs = {};
    }
  }

  static recorded(): Captures {
    const folder = process.env["ROBDEF_CAPTURES_DIR"];
    if (!folder) throw new Error("ROBDEF_CAPTURES_DIR does not say where conformance/captures is");
    return new Captures(folder);
  }

  read(name: string): Json {
    return JSON.parse(readFileSync(join(this.folder, name), "utf8")) as Json;
  }

  scenarios(): { name: string; scenario: JsonObject }[] {
    return readdirSync(join(this.folder, "scenarios"))
      .filter((name) => name.endsWith(".json"))
      .sort()
      .map((name) => ({ name, scenario: object(this.read(join("scenarios", name))) }));
  }

  definitions(): string[] {
    return readdirSync(join(this.folder, "robdef"))
      .filter((name) => name.endsWith(".robdef"))
      .sort()
      .map((name) => readFileSync(join(this.folder, "robdef", name), "utf8"));
  }

  /** Hex with what stands in braces for more of it. */
  hex(short: string): string {
    return short.replace(/\{([^}]*)\}/g, (_, inner: string) => {
      const repeated = /^([0-9a-f]{2})\*(\d+)$/.exec(inner);
      if (repeated) return (repeated[1] ?? "").repeat(Number(repeated[2]));
      const blob = part(this.blobs, inner);
      if (blob === undefined) throw new Error(`there is no blob ${inner}`);
      return Buffer.from(text(blob), "utf8").toString("hex");
    });
  }

  /** A text that is wholly the name of a blob stands for it; names of nodes for their ids. */
  whole(json: Json, nodes: JsonObject): Json {
    if (Array.isArray(json)) return json.map((item) => this.whole(item, nodes));
    if (json !== null && typeof json === "object") {
      return Object.fromEntries(
        Object.entries(json)
          .filter(([key]) => !/^(entry_type_name|.*_label|error_name)$/.test(key))
          .map(([key, value]) => [key, key.endsWith("_node_id") ? this.id(value, nodes) : this.whole(value, nodes)]),
      );
    }
    const blob = typeof json === "string" ? /^\{([^}]*)\}$/.exec(json) : null;
    return blob ? (part(this.blobs, blob[1] ?? "") ?? json) : json;
  }

  private id(value: Json, nodes: JsonObject): Json {
    if (value === "any") return "00000000-0000-0000-0000-000000000000";
    const node = typeof value === "string" ? part(nodes, value) : undefined;
    return node === undefined ? value : object(node)["id"] ?? value;
  }

  frames(scenario: JsonObject): JsonObject[] {
    return list(scenario["frames"] ?? scenario["web_socket_frames"]).map(object);
  }
}
