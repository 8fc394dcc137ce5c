// SPDX-License-Identifier: Apache-2.0
// What a definition says, as it is written: nothing looked up.
import type { ArrayForm, Constant, ContainerForm, MemberKind } from "./types.js";

/** A type as it is written. */
export interface WrittenType {
  /** A number, `string`, `varvalue`, `void`, or a name. */
  readonly base: string;
  /** How many items. */
  readonly array: ArrayForm;
  /** What the items are in; `generator` for a value that comes step by step. */
  readonly container: ContainerForm | "generator";
}

/** A member of an object, or a field, as it is written. */
export interface WrittenMember {
  /** What it is. */
  readonly kind: MemberKind | "field";
  /** Its name. */
  readonly name: string;
  /** Of the value, the result, packets or items. */
  readonly type: WrittenType;
  /** In their order. */
  readonly parameters: readonly { readonly name: string; readonly type: WrittenType }[];
  /** What stands in brackets. */
  readonly modifiers: readonly string[];
  /** The comments before it. */
  readonly doc: string;
  /** Counted from 1. */
  readonly line: number;
}

/** A struct, pod, namedarray or object, as it is written. */
export interface WrittenBlock {
  /** Which of them. */
  readonly kind: "struct" | "pod" | "namedarray" | "object";
  /** Not qualified. */
  readonly name: string;
  /** Of an object: what its `implements` lines say. */
  readonly implements: string[];
  /** Fields or members, in their order. */
  readonly members: WrittenMember[];
  /** Its own constants. */
  readonly constants: Constant[];
  /** Pipes that an old `option pipe NAME unreliable` names. */
  readonly unreliablePipes: Set<string>;
  /** The comments before it. */
  readonly doc: string;
  /** Counted from 1. */
  readonly line: number;
}

/** An enum, as it is written. */
export interface WrittenEnum {
  /** Not qualified. */
  readonly name: string;
  /** In their order; values that are not written are counted on. */
  readonly values: { readonly name: string; readonly value: number; readonly doc: string }[];
  /** The comments before it. */
  readonly doc: string;
}

/** One text. */
export interface WrittenDefinition {
  /** The name of the service. */
  name: string;
  /** As it was given. */
  readonly text: string;
  /** Numbers of `stdver` or `option version`; empty for none. */
  version: number[];
  /** The comments at its beginning. */
  readonly doc: string;
  /** Names of definitions. */
  readonly imports: string[];
  /** Short names for qualified ones. */
  readonly aliases: Map<string, string>;
  /** Not qualified. */
  readonly exceptions: { readonly name: string; readonly doc: string }[];
  /** Those that no block has. */
  readonly constants: Constant[];
  /** In their order. */
  readonly enums: WrittenEnum[];
  /** Structs, pods, namedarrays and objects, in their order. */
  readonly blocks: WrittenBlock[];
}
