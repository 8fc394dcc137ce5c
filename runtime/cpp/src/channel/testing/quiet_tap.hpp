// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "rr/tap.hpp"

namespace rr::testing {

/// A tap that keeps nothing, for tests that look at some of what a tap is told.
class QuietTap : public Tap {
 public:
  std::uint32_t opened(const ConnectionOpened& /*connection*/) override { return 1; }
  void agreed(std::uint32_t /*connection*/, const ConnectionAgreed& /*agreement*/) override {}
  std::uint64_t message(std::uint32_t /*connection*/, Direction /*direction*/,
                        std::span<const Piece> /*message*/) override {
    return 0;
  }
  void replaced(std::uint32_t /*connection*/, std::uint64_t /*message*/) override {}
  void closed(std::uint32_t /*connection*/, ErrorCode /*code*/,
              std::string_view /*reason*/) override {}
  void definition(std::string_view /*text*/) override {}
};

}  // namespace rr::testing
