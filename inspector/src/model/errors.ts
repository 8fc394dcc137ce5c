// SPDX-License-Identifier: Apache-2.0
// Errors in words.
import { ErrorCode, RRError, VarValue } from "@robdef/runtime";
import { shortName } from "./types.js";

/** What happened, and what a user can do about it. */
export interface Words {
  /** The kind of error, as the protocol or a definition names it. */
  readonly name: string;
  readonly text: string;
  readonly hint?: string;
}

const hints: Readonly<Record<number, string>> = {
  [ErrorCode.AuthenticationError]: "Log in with a user of this service.",
  [ErrorCode.ObjectLockedError]: "Somebody else has locked this object. It can be used once they unlock it.",
  [ErrorCode.PermissionDenied]: "The user that is logged in may not do this.",
  [ErrorCode.ReadOnlyMember]: "This member can only be read.",
  [ErrorCode.WriteOnlyMember]: "This member can only be written.",
  [ErrorCode.RequestTimeout]: "The service did not answer in time. It may still be busy with the call.",
  [ErrorCode.ConnectionError]: "The connection is lost. Connect again.",
  [ErrorCode.NotImplementedError]: "The service declares this member, but has no code for it.",
  [ErrorCode.ValueNotSet]: "The service has not set a value yet.",
  [ErrorCode.ServiceNotFound]: "The node runs, but has no service of this name. Enter host:port alone to see its services.",
  [ErrorCode.ObjectNotFound]: "There is no object at this path or index.",
  [ErrorCode.MemberBusy]: "Something else uses this member now.",
};

/** An error of the runtime or of a service. */
export function wordsOf(error: unknown): Words {
  if (!(error instanceof RRError)) return { name: "Error", text: error instanceof Error ? error.message : String(error) };
  const hint = hints[error.code];
  const parameter = error.parameter instanceof VarValue && (typeof error.parameter.value !== "object") ? ` (${String(error.parameter.value)})` : "";
  const subname = error.subname === "" ? "" : ` [${error.subname}]`;
  return { name: shortName(error.errorName), text: `${error.message}${subname}${parameter}`, ...(hint === undefined ? {} : { hint }) };
}

export function errorText(error: unknown): string {
  const { name, text } = wordsOf(error);
  return `${name}: ${text}`;
}
