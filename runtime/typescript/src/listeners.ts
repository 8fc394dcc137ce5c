// SPDX-License-Identifier: Apache-2.0

/** Stops what it was given for. Harmless when called again. */
export type Unsubscribe = () => void;

/** Handlers of one thing that happens. What one of them throws goes to `report`, and disturbs no other. */
export class Listeners<A extends unknown[]> {
  private readonly handlers = new Set<(...args: A) => void>();

  constructor(private readonly report: (error: unknown) => void) {}

  get isEmpty(): boolean {
    return this.handlers.size === 0;
  }

  add(handler: (...args: A) => void): Unsubscribe {
    // Of one's own, so that a handler that is added twice is called twice, and removed once.
    const own = (...args: A): void => {
      handler(...args);
    };
    this.handlers.add(own);
    return () => {
      this.handlers.delete(own);
    };
  }

  clear(): void {
    this.handlers.clear();
  }

  call(...args: A): void {
    for (const handler of [...this.handlers]) {
      try {
        handler(...args);
      } catch (error) {
        this.report(error);
      }
    }
  }
}
