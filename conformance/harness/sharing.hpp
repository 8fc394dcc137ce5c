// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "conformance/harness/stream.hpp"

/// Shared memory of a played connection (docs/reference/shared_memory.md). It is agreed on between
/// the messages of the scenario, which are not changed.
namespace rr::conformance {

/// The harness is the client: it asks for memory once CreateConnection has been answered.
/// std::runtime_error when there is none.
void share_as_client(Stream& stream);
/// The harness is the service: memory is made when the other side asks for it.
void share_as_service(Stream& stream);

}  // namespace rr::conformance
