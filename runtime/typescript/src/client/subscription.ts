// SPDX-License-Identifier: Apache-2.0
// A client of one service that is connected again whenever it is lost (07, section 15).
import { AsyncQueue } from "../async_queue.js";
import { ErrorCode, makeError } from "../errors.js";
import { Listeners, type Unsubscribe } from "../listeners.js";
import type { PipeEnd } from "../streams/pipe_end.js";
import type { TimedValue, WireEnd } from "../streams/wire_end.js";
import type { Client } from "./client.js";
import type { RemoteObject } from "./remote_object.js";
import type { Stub } from "./stub.js";

/** How a subscription goes on. */
export interface SubscribeOptions {
  /** Milliseconds from a lost connection, or one that could not be made, to the next attempt. */
  retryDelay?: number;
}

const usualDelay = 2_500;

/** Connects for as long as it is open, and again after each loss. */
export class Subscription<S extends RemoteObject | Stub = RemoteObject> {
  private current: Client<S> | undefined;
  private readonly connectedListeners: Listeners<[Client<S>]>;
  private readonly lostListeners: Listeners<[Client<S>]>;
  private readonly failedListeners: Listeners<[unknown]>;
  private readonly stopping = new AbortController();
  private retry: ReturnType<typeof setTimeout> | undefined;
  private readonly delay: number;

  /** @internal */
  constructor(
    private readonly connect: (signal: AbortSignal) => Promise<Client<S>>,
    options: SubscribeOptions,
    report: (error: unknown) => void,
  ) {
    this.delay = options.retryDelay ?? usualDelay;
    this.connectedListeners = new Listeners(report);
    this.lostListeners = new Listeners(report);
    this.failedListeners = new Listeners(report);
    void this.attempt();
  }

  /** The client now; undefined while there is none. */
  get client(): Client<S> | undefined {
    return this.current;
  }

  /** The client, as soon as there is one. Rejects with the signal's reason, or InvalidOperation once it is closed. */
  async wait(signal?: AbortSignal): Promise<Client<S>> {
    if (this.current) return this.current;
    const queue = new AsyncQueue<Client<S>>(1);
    const stop = this.connectedListeners.add((client) => queue.put(client));
    const end = (): void => {
      queue.end(makeError(ErrorCode.InvalidOperation, "the subscription is closed"));
    };
    this.stopping.signal.addEventListener("abort", end, { once: true });
    if (this.stopping.signal.aborted) end();
    try {
      const client = await queue.next(signal);
      if (!client) throw makeError(ErrorCode.InvalidOperation, "the subscription is closed");
      return client;
    } finally {
      stop();
      this.stopping.signal.removeEventListener("abort", end);
    }
  }

  /** Calls the handler with each client that is connected, and the one that is there. */
  onConnected(handler: (client: Client<S>) => void): Unsubscribe {
    if (this.current) handler(this.current);
    return this.connectedListeners.add(handler);
  }

  /** Calls the handler with each client that has ended; an attempt to connect follows. */
  onLost(handler: (client: Client<S>) => void): Unsubscribe {
    return this.lostListeners.add(handler);
  }

  /** Calls the handler with the reason why an attempt failed; the next one follows. */
  onFailed(handler: (reason: unknown) => void): Unsubscribe {
    return this.failedListeners.add(handler);
  }

  /** Keeps a wire of the root object, or of what `find` gives, connected, and gives its values. */
  onWireValue<T>(wire: string, handler: (value: TimedValue<T>) => void, find = rootOf<S>): Unsubscribe {
    return this.keep(
      async (client) => (await (await find(client)).wire(wire).connect()) as WireEnd<T>,
      (end) => {
        const early = end.tryGet();
        if (early) handler(early);
        end.onValue((value, time) => {
          handler({ value, time });
        });
      },
    );
  }

  /** Keeps an end of a pipe connected, likewise, and gives its packets. */
  onPacket<T>(pipe: string, handler: (packet: T) => void, find = rootOf<S>): Unsubscribe {
    return this.keep(
      async (client) => (await (await find(client)).pipe(pipe).connect()) as PipeEnd<T>,
      (end) => end.onPacket(handler),
    );
  }

  /** Connects something of each client, and again when it is closed while the client stays. */
  private keep<E extends { close(): Promise<void>; onClosed(handler: () => void): Unsubscribe }>(
    open: (client: Client<S>) => Promise<E>,
    use: (end: E) => void,
  ): Unsubscribe {
    let isWanted = true;
    let held: E | undefined;
    const again = (client: Client<S>): void => {
      setTimeout(() => void begin(client), this.delay);
    };
    const begin = async (client: Client<S>): Promise<void> => {
      if (!isWanted || !client.isOpen) return;
      try {
        const end = await open(client);
        held = end;
        // It may have been given up meanwhile.
        if (!(isWanted as boolean)) {
          await end.close();
          return;
        }
        end.onClosed(() => {
          again(client);
        });
        use(end);
      } catch (error) {
        this.failedListeners.call(error);
        again(client);
      }
    };
    const stop = this.onConnected((client) => void begin(client));
    return () => {
      isWanted = false;
      stop();
      held?.close().catch((error: unknown) => {
        this.failedListeners.call(error);
      });
    };
  }

  /** Ends the client, and connects no more. */
  async close(): Promise<void> {
    this.stopping.abort();
    clearTimeout(this.retry);
    const { current } = this;
    this.current = undefined;
    await current?.close();
  }

  private async attempt(): Promise<void> {
    const { signal } = this.stopping;
    try {
      const client = await this.connect(signal);
      if (signal.aborted) {
        await client.close();
        return;
      }
      this.current = client;
      client.onClosed(() => {
        if (this.current !== client) return;
        this.current = undefined;
        this.lostListeners.call(client);
        this.later();
      });
      this.connectedListeners.call(client);
    } catch (error) {
      if (signal.aborted) return;
      this.failedListeners.call(error);
      this.later();
    }
  }

  private later(): void {
    if (this.stopping.signal.aborted) return;
    this.retry = setTimeout(() => void this.attempt(), this.delay);
  }
}

function rootOf<S extends RemoteObject | Stub>(client: Client<S>): Promise<RemoteObject> {
  const root: RemoteObject | Stub = client.root;
  return Promise.resolve("rr_object" in root ? root.rr_object : root);
}
