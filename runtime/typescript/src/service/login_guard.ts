// SPDX-License-Identifier: Apache-2.0
// Slows down who guesses passwords.
import type { Connection } from "../channel/connection.js";

const firstDelay = 250;
const longestDelay = 8_000;
const memory = 300_000;
const freeFailures = 3;
const mostFailures = 5;
const mostAddresses = 4096;

interface Failures {
  count: number;
  last: number;
}

export class LoginGuard {
  private readonly byAddress = new Map<string, Failures>();
  private readonly byConnection = new WeakMap<Connection, number>();

  /** Tries once; waits before when attempts have failed. After several of one connection that is closed. */
  async attempt<T>(connection: Connection, authenticate: () => Promise<T>): Promise<T> {
    const delay = this.delay(connection);
    if (delay > 0) await new Promise((resolve) => setTimeout(resolve, delay));
    try {
      return await authenticate();
    } catch (error) {
      this.failed(connection);
      throw error;
    }
  }

  private delay(connection: Connection): number {
    const ofConnection = this.byConnection.get(connection) ?? 0;
    const known = this.byAddress.get(connection.remoteAddress);
    const ofAddress = known && Date.now() - known.last < memory ? known.count - freeFailures : 0;
    const failures = Math.max(ofConnection, ofAddress);
    return failures > 0 ? Math.min(longestDelay, firstDelay * 2 ** (failures - 1)) : 0;
  }

  private failed(connection: Connection): void {
    const { remoteAddress } = connection;
    const known = this.byAddress.get(remoteAddress);
    const now = Date.now();
    this.byAddress.delete(remoteAddress);
    this.byAddress.set(remoteAddress, { count: known && now - known.last < memory ? known.count + 1 : 1, last: now });
    const [oldest] = this.byAddress.keys();
    if (this.byAddress.size > mostAddresses && oldest !== undefined) this.byAddress.delete(oldest);
    const count = (this.byConnection.get(connection) ?? 0) + 1;
    this.byConnection.set(connection, count);
    if (count >= mostFailures) setTimeout(() => {
      connection.close("logging in has failed too often");
    }, 100);
  }
}
