// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "rr/error.hpp"
#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/connection.hpp"

/// Answers to requests: type plus one, path, member and number repeated (07, section 1).
namespace rr::endpoint {

/// The header of the answer to an entry.
EntryHeader answer_header(const Entry& request, ErrorCode error = ErrorCode::none);

// Whole entries, before what was written so far.
void write_empty_answer(Writer& writer, const Entry& request);
void write_error_answer(Writer& writer, const Entry& request, const Error& error);
/// What a message of one entry may overtake. What begins, ends or changes a session, and the
/// release of a path, keeps its place.
channel::Priority priority_of(EntryType type, bool is_urgent);
/// `return` : uint32 0, as for every capability that is not known.
void write_capability_answer(Writer& writer, const Entry& request);

}  // namespace rr::endpoint
