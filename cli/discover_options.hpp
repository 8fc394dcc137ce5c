// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace robdef {

/// What `discover` is told.
struct DiscoverOptions {
  std::string type;  ///< empty: any
  bool is_once = false;
  bool uses_ipv4 = false;
  std::chrono::milliseconds wait{3'000};  ///< with is_once
  std::vector<std::string> interfaces;    ///< empty: all
  std::uint16_t port = 48653;
};

}  // namespace robdef
