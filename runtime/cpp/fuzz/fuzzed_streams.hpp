// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <experimental/fuzzed.hpp>
#include <memory>

namespace rr::fuzz {

/// The object of a service of fuzzed.robdef with pipes, wires, memories, callbacks and generators.
/// It shares `life` while it exists.
std::shared_ptr<::experimental::fuzzed::StreamBoardSkeleton> make_fuzzed_streams(
    std::shared_ptr<const void> life);

}  // namespace rr::fuzz
