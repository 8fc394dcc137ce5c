// SPDX-License-Identifier: Apache-2.0
// Events and callbacks: what a service says by itself.
import type { MessageElement } from "../codec/message.js";
import type { Member } from "../definition/types.js";
import { EntryType } from "../entry_type.js";
import { ErrorCode, makeError } from "../errors.js";
import { findElement } from "../value/shapes.js";
import type { CallOptions } from "../client/session.js";
import type { ServedObject } from "./served_object.js";

function pack(object: ServedObject, member: Member, args: readonly unknown[]): MessageElement[] {
  if (args.length !== member.parameters.length) {
    throw makeError(ErrorCode.InvalidArgument, `${member.name} has ${member.parameters.length} parameters, not ${args.length}`);
  }
  return member.parameters.map(({ name, type }, i) => object.packer.value(type, args[i], name));
}

/** An event of an object. */
export class ServedEvent<A extends unknown[] = unknown[]> {
  /** @internal */
  constructor(
    private readonly object: ServedObject,
    private readonly member: Member,
  ) {}

  /** Tells all clients of the service. */
  fire(...args: A): void {
    const elements = pack(this.object, this.member, args);
    for (const [path, service] of this.object.places) {
      for (const session of service.sessions()) {
        if (session.isAuthenticated) session.packet({ type: EntryType.event, path, member: this.member.name, elements });
      }
    }
  }
}

/** A function of a client that the object calls. */
export class ServedCallback<A extends unknown[] = unknown[], R = unknown> {
  /** @internal */
  constructor(
    private readonly object: ServedObject,
    private readonly member: Member,
  ) {}

  /** Calls it at one client; its number is in what handlers are told of their caller. */
  async call(client: number, args: A, options: CallOptions = {}): Promise<R> {
    const { object, member } = this;
    const elements = pack(object, member, args);
    for (const [path, service] of object.places) {
      const session = service.session(client);
      if (!session) continue;
      const answer = await session.callBack({ type: EntryType.callbackCall, path, member: member.name, elements, ...options });
      if (member.type.base.kind === "void") return undefined as R;
      return object.unpacker.value(member.type, findElement(answer.elements, "return")) as R;
    }
    throw makeError(ErrorCode.InvalidEndpoint, `there is no client ${client}`);
  }
}
