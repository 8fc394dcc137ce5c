// SPDX-License-Identifier: Apache-2.0
// What generated code says about one definition.
import { Definitions } from "./definition/definitions.js";
import { ErrorCode, RRError, type ErrorClass, type ErrorDetails } from "./errors.js";

/** The version of what generated code relies on; code for another one does not load. */
export const stubApi = 2;

/** What may come now or later. */
export type MaybePromise<T> = T | Promise<T>;

/** Throws when generated code was made for another runtime. */
export function checkStubApi(wanted: number): void {
  if (wanted !== stubApi) throw new Error(`made for stub API ${wanted}, this runtime has ${stubApi}; run robdef again`);
}

/** One definition: its text, the modules that it imports, and the classes of its exceptions. */
export class ServiceModule {
  private known: Definitions | undefined;

  constructor(
    /** The definition, exactly as it was compiled. */
    readonly text: string,
    /** The modules of the definitions that it imports. */
    readonly imports: readonly ServiceModule[] = [],
    /** Classes by the qualified names of its exceptions. */
    readonly exceptions: Readonly<Record<string, ErrorClass>> = {},
  ) {}

  /** The definition and all it imports, parsed once. */
  get definitions(): Definitions {
    if (!this.known) {
      const made = new Definitions();
      this.declare(made, new Map());
      this.known = made;
    }
    return this.known;
  }

  /** Adds what it knows, and what its imports know. */
  declare(definitions: Definitions | undefined, classes: Map<string, ErrorClass>, seen = new Set<ServiceModule>()): void {
    if (seen.has(this)) return;
    seen.add(this);
    definitions?.add(this.text);
    for (const [name, one] of Object.entries(this.exceptions)) classes.set(name, one);
    for (const module of this.imports) module.declare(definitions, classes, seen);
  }
}

/** The class of errors for an exception of a definition, by its qualified name. */
export function exceptionClass(name: string): ErrorClass {
  const made = class extends RRError {
    constructor(message: string, details: ErrorDetails = {}) {
      super(ErrorCode.RemoteError, message, { ...details, errorName: name });
      this.name = name.slice(name.lastIndexOf(".") + 1);
    }
  };
  return made;
}
