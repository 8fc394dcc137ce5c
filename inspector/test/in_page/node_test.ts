// SPDX-License-Identifier: Apache-2.0
// `node:test` in a page: keeps the tests, which the driver runs one after the other.
export interface PageTest {
  readonly name: string;
  readonly run: () => unknown;
}

export const pageTests: PageTest[] = [];

export function test(name: string, run: () => unknown): void {
  pageTests.push({ name, run });
}

declare global {
  /** Runs a test; gives what went wrong, or "". */
  function runPageTest(index: number): Promise<string>;
  function namesOfPageTests(): string[];
}

globalThis.namesOfPageTests = () => pageTests.map(({ name }) => name);
globalThis.runPageTest = async (index) => {
  try {
    await pageTests[index]?.run();
    return "";
  } catch (error) {
    return error instanceof Error ? (error.stack ?? error.message) : String(error);
  }
};
