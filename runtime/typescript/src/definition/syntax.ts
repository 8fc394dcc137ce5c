// SPDX-License-Identifier: Apache-2.0
// What a definition says, as it is written: nothing looked up.
import type { ArrayForm, Constant, ContainerForm, MemberKind } from "./types.js";

/** A type as it is written. */
export interface WrittenType {
  readonly base: string;
  readonly array: ArrayForm;
  readonly container: ContainerForm | "generator";
}

export interface WrittenMember {
  readonly kind: MemberKind | "field";
  readonly name: string;
  readonly type: WrittenType;
  readonly parameters: readonly { readonly name: string; readonly type: WrittenType }[];
  readonly modifiers: readonly string[];
  readonly doc: string;
  readonly line: number;
}

export interface WrittenBlock {
  readonly kind: "struct" | "pod" | "namedarray" | "object";
  readonly name: string;
  readonly implements: string[];
  readonly members: WrittenMember[];
  readonly constants: Constant[];
  /** Pipes that an old `option pipe NAME unreliable` names. */
  readonly unreliablePipes: Set<string>;
  readonly doc: string;
  readonly line: number;
}

export interface WrittenEnum {
  readonly name: string;
  readonly values: { readonly name: string; readonly value: number; readonly doc: string }[];
  readonly doc: string;
}

/** One text. */
export interface WrittenDefinition {
  name: string;
  readonly text: string;
  /** Numbers of `stdver` or `option version`; empty for none. */
  version: number[];
  readonly doc: string;
  readonly imports: string[];
  /** Short names for qualified ones. */
  readonly aliases: Map<string, string>;
  readonly exceptions: { readonly name: string; readonly doc: string }[];
  readonly constants: Constant[];
  readonly enums: WrittenEnum[];
  readonly blocks: WrittenBlock[];
}
