// SPDX-License-Identifier: Apache-2.0
export { Definitions, ErrorCode } from "@robdef/runtime";
export { makeError as makeErrorForTests } from "../../runtime/typescript/src/errors.js";
export { indexName, makeIndex } from "../../runtime/typescript/src/service/service_index.js";
export type { Service } from "../../runtime/typescript/src/service/service.js";
