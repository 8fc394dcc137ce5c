// SPDX-License-Identifier: Apache-2.0
import { definitionError } from "./definition_error.js";

/**
 * Walks along one logical line. Every step looks at a character once, so no text takes more than linear
 * time.
 */
export class Scanner {
  position = 0;

  constructor(
    readonly text: string,
    readonly line: number,
  ) {}

  fail(message: string): never {
    throw definitionError(this.line, message);
  }

  get atEnd(): boolean {
    return this.position >= this.text.length;
  }

  peek(): string {
    return this.text.charAt(this.position);
  }

  /** Skips blanks, and says whether there were any. */
  blanks(): boolean {
    const start = this.position;
    while (isBlank(this.peek())) ++this.position;
    return this.position > start;
  }

  needBlanks(): void {
    if (!this.blanks()) this.fail(`expected a blank at "${this.rest().slice(0, 20)}"`);
  }

  take(character: string): boolean {
    if (this.peek() !== character) return false;
    ++this.position;
    return true;
  }

  need(character: string): void {
    if (!this.take(character)) this.fail(`expected "${character}" at "${this.rest().slice(0, 20)}"`);
  }

  /** Letters, digits and underscores; may be empty. */
  word(): string {
    return this.while(isWordCharacter);
  }

  while(test: (character: string) => boolean): string {
    const start = this.position;
    while (!this.atEnd && test(this.peek())) ++this.position;
    return this.text.slice(start, this.position);
  }

  /** A letter, then letters, digits and underscores, but none at the end. */
  name(what: string): string {
    const name = this.word();
    if (!isName(name)) this.fail(`expected the name of ${what}, not "${name || this.rest().slice(0, 20)}"`);
    return name;
  }

  /** Names with dots between them. */
  dotted(what: string): string {
    const parts = [this.name(what)];
    while (this.take(".")) parts.push(this.name(what));
    return parts.join(".");
  }

  rest(): string {
    return this.text.slice(this.position);
  }

  end(): void {
    this.blanks();
    if (!this.atEnd) this.fail(`"${this.rest().slice(0, 40)}" is one too many`);
  }
}

export function isBlank(character: string): boolean {
  return character === " " || character === "\t";
}

export function isDigit(character: string): boolean {
  return character >= "0" && character <= "9" && character.length === 1;
}

function isLetter(character: string): boolean {
  return character.length === 1 && ((character >= "a" && character <= "z") || (character >= "A" && character <= "Z"));
}

export function isWordCharacter(character: string): boolean {
  return isLetter(character) || isDigit(character) || character === "_";
}

export function isName(text: string): boolean {
  return text !== "" && isLetter(text.charAt(0)) && !text.endsWith("_");
}
