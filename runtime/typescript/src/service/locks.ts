// SPDX-License-Identifier: Apache-2.0
// Who may use which objects of a service (07, section 6).
import type { Member } from "../definition/types.js";
import { ErrorCode, makeError } from "../errors.js";
import { isAtOrBelow } from "../path.js";
import type { Monitor } from "./served_object.js";
import type { User } from "./users.js";

interface Lock {
  readonly username: string;
  /** Of a lock of one session. */
  readonly client: number | undefined;
}

/** What somebody is about to do. */
export interface Access {
  readonly client: number;
  readonly user: User | undefined;
}

/** Locks of a service's objects. */
export class ObjectLocks {
  private readonly locks = new Map<string, Lock>();

  /** Throws ObjectLockedError when another user, or session, has locked the object. */
  check(path: string, member: Member | undefined, isReading: boolean, { client, user }: Access): void {
    if (member?.nolock || (member?.nolockread && isReading)) return;
    for (const [locked, lock] of this.locks) {
      if (!isAtOrBelow(path, locked)) continue;
      const isOwn = lock.username === user?.name && (lock.client === undefined || lock.client === client);
      if (!isOwn) throw makeError(ErrorCode.ObjectLockedError, `Object locked by ${lock.username}`);
    }
  }

  request(path: string, isOfSession: boolean, { client, user }: Access): void {
    if (!user) throw makeError(ErrorCode.AuthenticationError, "User is not authenticated");
    if (!user.privileges.has("objectlock") && !user.privileges.has("objectlockoverride")) {
      throw makeError(ErrorCode.ObjectLockedError, "User does not have object lock privileges");
    }
    for (const locked of this.locks.keys()) {
      if (isAtOrBelow(path, locked) || isAtOrBelow(locked, path)) throw makeError(ErrorCode.ObjectLockedError, "Object already locked");
    }
    this.locks.set(path, { username: user.name, client: isOfSession ? client : undefined });
  }

  release(path: string, { user }: Access): void {
    if (!user) throw makeError(ErrorCode.AuthenticationError, "User is not authenticated");
    const lock = this.locks.get(path);
    if (!lock) {
      if ([...this.locks.keys()].some((locked) => isAtOrBelow(path, locked))) {
        throw makeError(ErrorCode.ObjectLockedError, "Cannot release inherited lock");
      }
      return;
    }
    if (lock.username !== user.name && !user.privileges.has("objectlockoverride")) {
      throw makeError(ErrorCode.ObjectLockedError, `Object locked by ${lock.username}`);
    }
    this.locks.delete(path);
  }

  /** A session has ended; `isLast` when its user, or a user who was logged in in it, has no other one. */
  clientLeft(client: number, isLast: (username: string) => boolean): void {
    for (const [path, lock] of this.locks) {
      if (lock.client === client || (lock.client === undefined && isLast(lock.username))) this.locks.delete(path);
    }
  }

  objectLeft(path: string): void {
    for (const locked of this.locks.keys()) if (isAtOrBelow(locked, path)) this.locks.delete(locked);
  }
}

const enterStep = 5_000;
const refreshTime = 30_000;

interface Turn {
  client: number;
  state: "waiting" | "held";
  entering: Promise<boolean>;
  used: number;
  deadline: number;
}

/** Monitors of a service's objects. */
export class Monitors {
  private readonly turns = new Map<Monitor, Turn>();
  /** Monitors that somebody has held. */
  private readonly known = new WeakSet<Monitor>();

  /** Throws InvalidOperation while another session holds the monitor; else the holder has used it. */
  check(monitor: Monitor | undefined, client: number): void {
    const turn = monitor && this.turns.get(monitor);
    if (!monitor || turn?.state !== "held") return;
    if (Date.now() - turn.used > refreshTime) {
      this.turns.delete(monitor);
      monitor.exit();
      return;
    }
    if (turn.client !== client) throw makeError(ErrorCode.InvalidOperation, "Object is monitor locked");
    turn.used = Date.now();
  }

  async enter(monitor: Monitor | undefined, client: number, timeout: number): Promise<string> {
    if (!monitor) throw makeError(ErrorCode.InvalidArgument, "Object is not monitor lockable");
    if (this.turns.get(monitor)?.client === client) throw makeError(ErrorCode.InvalidOperation, "Already acquiring or acquired monitor lock");
    const deadline = timeout < 0 ? Infinity : Date.now() + timeout;
    this.known.add(monitor);
    const entering = monitor.enter(timeout < 0 ? 0x7fffffff : timeout);
    const turn: Turn = { client, state: "waiting", entering, used: Date.now(), deadline };
    if (!this.turns.has(monitor)) this.turns.set(monitor, turn);
    this.waiting.set(client, { monitor, turn });
    return await this.step(monitor, turn);
  }

  private readonly waiting = new Map<number, { monitor: Monitor; turn: Turn }>();

  async continueEnter(monitor: Monitor | undefined, client: number): Promise<string> {
    const waiting = this.waiting.get(client);
    if (!monitor || waiting?.monitor !== monitor) throw makeError(ErrorCode.InvalidOperation, "Not acquiring monitor lock");
    return await this.step(monitor, waiting.turn);
  }

  private async step(monitor: Monitor, turn: Turn): Promise<string> {
    const isOver = new Promise<undefined>((resolve) => {
      setTimeout(() => {
        resolve(undefined);
      }, Math.max(0, Math.min(enterStep, turn.deadline - Date.now() + 50))).unref();
    });
    const entered = await Promise.race([turn.entering, isOver]);
    if (entered === undefined && Date.now() < turn.deadline) return "Continue";
    this.waiting.delete(turn.client);
    if (entered !== true) {
      if (this.turns.get(monitor) === turn) this.turns.delete(monitor);
      // It may still be had when nobody wants it any more.
      if (entered === undefined) void turn.entering.then((late) => { if (late) monitor.exit(); }, () => undefined);
      throw makeError(ErrorCode.OperationTimeout, "the monitor was in use for too long");
    }
    turn.state = "held";
    turn.used = Date.now();
    this.turns.set(monitor, turn);
    return "OK";
  }

  /** Undefined for an object whose monitor nobody ever held: the answer has no word then. */
  exit(monitor: Monitor | undefined, client: number): string | undefined {
    if (!monitor || !this.known.has(monitor)) return undefined;
    const turn = this.turns.get(monitor);
    if (turn?.client !== client || turn.state !== "held") throw makeError(ErrorCode.InvalidOperation, "Not monitor locked");
    this.turns.delete(monitor);
    monitor.exit();
    return "OK";
  }

  clientLeft(client: number): void {
    const waiting = this.waiting.get(client);
    this.waiting.delete(client);
    if (waiting?.turn.state === "waiting") {
      const { monitor, turn } = waiting;
      if (this.turns.get(monitor) === turn) this.turns.delete(monitor);
      void turn.entering.then((late) => { if (late) monitor.exit(); }, () => undefined);
    }
    for (const [monitor, turn] of this.turns) {
      if (turn.client !== client || turn.state !== "held") continue;
      this.turns.delete(monitor);
      monitor.exit();
    }
  }
}
