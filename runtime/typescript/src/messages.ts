// SPDX-License-Identifier: Apache-2.0
// For tools that read messages without being a side of their connection: recordings, analyzers.
export { FormatError } from "./codec/format_error.js";
export { ElementType } from "./codec/element_type.js";
export type { Message, MessageElement, MessageEntry } from "./codec/message.js";
export { readMessage } from "./codec/read_message.js";
export { decodeText } from "./codec/text.js";
export { EntryType } from "./entry_type.js";
export { errorOf } from "./remote_error.js";
export { elementNumber, findElement, optionalElement } from "./value/shapes.js";
export { Unpacker } from "./value/unpack.js";
export { Packer } from "./value/pack.js";
export { timeOf } from "./wire_time.js";
