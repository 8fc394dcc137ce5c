// SPDX-License-Identifier: Apache-2.0
export { Definitions, ErrorCode } from "@robdef/runtime";
export { makeError as makeErrorForTests } from "../../runtime/typescript/src/errors.js";
