// SPDX-License-Identifier: Apache-2.0
import { createHash, timingSafeEqual } from "node:crypto";
import { ErrorCode, makeError } from "../errors.js";
import { NodeId } from "../node_id.js";
import { VarValue } from "../value/values.js";

/** Who has logged in. */
export interface User {
  /** By which the user has logged in. */
  readonly name: string;
  /** Such as `objectlock`, `objectlockoverride`. */
  readonly privileges: ReadonlySet<string>;
}

/** Knows users. */
export interface Users {
  /** Rejects with AuthenticationError. Credentials are VarValues. */
  authenticate(username: string, credentials: ReadonlyMap<string, unknown>, node: NodeId): User | Promise<User>;
}

interface Account extends User {
  readonly md5: string;
  readonly nodes: readonly NodeId[];
}

/**
 * Users from a password file: on each line a name, the MD5 of the password in lower-case hexadecimal digits, and
 * privileges with commas between them, or `_` for none; perhaps the ids of the nodes that may log in.
 */
export class PasswordUsers implements Users {
  private readonly accounts = new Map<string, Account>();

  /** Throws InvalidConfiguration for a line that is none. */
  constructor(text: string) {
    text.split("\n").forEach((line, i) => {
      const trimmed = line.trim();
      if (trimmed === "" || trimmed.startsWith("#")) return;
      const [name = "", md5 = "", privileges = "_", nodes = ""] = trimmed.split(/\s+/);
      if (!/^[0-9a-fA-F]{32}$/.test(md5)) throw makeError(ErrorCode.InvalidConfiguration, `line ${i + 1} of the password file is not well-formed`);
      this.accounts.set(name, {
        name,
        md5: md5.toLowerCase(),
        privileges: new Set(privileges === "_" ? [] : privileges.split(",")),
        nodes: nodes === "" ? [] : nodes.split(",").map((node) => NodeId.parse(node)),
      });
    });
  }

  authenticate(username: string, credentials: ReadonlyMap<string, unknown>, node: NodeId): User {
    const given = credentials.get("password");
    const password: unknown = given instanceof VarValue ? (given.value as unknown) : given;
    if (typeof password !== "string") throw makeError(ErrorCode.AuthenticationError, "Password not supplied in credentials");
    const account = this.accounts.get(username);
    const digest = createHash("md5").update(password, "utf8").digest("hex");
    // As long for an unknown user as for a known one.
    const isRight = timingSafeEqual(Buffer.from(digest), Buffer.from(account?.md5 ?? "0".repeat(32)));
    const isHere = !account || account.nodes.length === 0 || account.nodes.some((one) => one.equals(node));
    if (!account || !isRight || !isHere) throw makeError(ErrorCode.AuthenticationError, "Invalid username or password");
    return account;
  }
}
