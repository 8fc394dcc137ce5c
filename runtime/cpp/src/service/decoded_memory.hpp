// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "rr/reader.hpp"

namespace rr::service {

class ServerEndpoint;

/// Memory of the lists, maps and structs that one request brings: drawn from the account of its
/// connection while the request is handled, which is while this exists. A small request draws
/// nothing. One that has many of them takes long to read and to free: another thread polls
/// meanwhile.
class DecodedMemory final : public ContainerBudget {
 public:
  explicit DecodedMemory(ServerEndpoint& endpoint) : endpoint_(endpoint) {}
  ~DecodedMemory();
  DecodedMemory(const DecodedMemory&) = delete;
  DecodedMemory& operator=(const DecodedMemory&) = delete;

  [[nodiscard]] bool draw(std::size_t bytes) override;

 private:
  static constexpr std::size_t free_bytes = 4 * 1024;
  static constexpr std::size_t quantum = 16 * 1024;
  static constexpr std::size_t many_bytes = 128 * 1024;

  ServerEndpoint& endpoint_;
  std::size_t bytes_ = 0;
  std::size_t drawn_ = 0;
  bool has_given_way_ = false;
};

}  // namespace rr::service
