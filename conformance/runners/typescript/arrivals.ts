// SPDX-License-Identifier: Apache-2.0
import type { Json } from "../../../runtime/typescript/test/notation/json.js";

const limit = 2000;

/** Things that came by themselves. */
export class Arrivals {
  private things: Json[] = [];
  private changed: (() => void) | undefined;

  add(thing: Json): void {
    this.things.push(thing);
    this.changed?.();
  }

  clear(): void {
    this.things = [];
  }

  /** What came, once it is so much, or two seconds later. */
  async wait(count: number): Promise<Json[]> {
    if (this.things.length < count) {
      await new Promise<void>((resolve) => {
        const done = (): void => {
          clearTimeout(timer);
          this.changed = undefined;
          resolve();
        };
        const timer = setTimeout(done, limit);
        this.changed = () => {
          if (this.things.length >= count) done();
        };
      });
    }
    const things = this.things;
    this.things = [];
    return things;
  }
}
