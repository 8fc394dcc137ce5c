// SPDX-License-Identifier: Apache-2.0
// What a script tells functions and callbacks to do.
import { errorName, makeError, type Definitions } from "../../../runtime/typescript/src/index.node.js";
import { number, object, part, text, type Json } from "../../../runtime/typescript/test/notation/json.js";
import { valueOfJson } from "../../../runtime/typescript/test/notation/values.js";

/** Of several outcomes the one of this call; the last is for all further ones. */
export function outcomeOfCall(outcomes: Json | undefined, call: number): Json | undefined {
  if (!Array.isArray(outcomes) || outcomes.length === 0) return outcomes;
  return outcomes[Math.min(call, outcomes.length - 1)];
}

function withParameters(json: Json | undefined, parameters: Json[]): Json {
  if (typeof json === "string" && /^\$\d$/.test(json)) return parameters[Number(json[1])] ?? null;
  return json ?? null;
}

/** Throws what a `throw` says. */
export function raiseTold(definitions: Definitions, told: Json, parameters: Json[]): never {
  const what = object(told);
  if (part(what, "native") !== undefined) throw new Error(text(withParameters(what["native"], parameters)));
  const code = number(withParameters(what["code"], parameters));
  const textOf = (key: string): string => {
    const json = withParameters(part(what, key), parameters);
    return json === null ? "" : text(json);
  };
  const known = errorName(code);
  const parameter = withParameters(part(what, "param"), parameters);
  throw makeError(code, textOf("message"), {
    errorName: known === "" ? textOf("name") : known,
    subname: textOf("subname"),
    parameter: parameter === null ? null : valueOfJson(definitions, definitions.type("varvalue"), parameter),
  });
}
