// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <system_error>

#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::platform {

/// A local socket that listens, and its place in the file system.
class PlacedSocket {
 public:
  /// Makes it; who may connect is as the folder lets in, but for others than the user and its
  /// group. `may_replace`: in place of a socket of this user where nobody listens any more.
  /// Anything else that is there stays: address_in_use. filename_too_long: longest_local_path().
  PlacedSocket(std::string path, bool may_replace, std::error_code& error);
  PlacedSocket(PlacedSocket&&) = default;

  [[nodiscard]] const std::string& path() const { return path_; }
  Descriptor take() { return std::move(socket_); }
  /// Removes the place, unless another node has put its own there since.
  void remove() const;

 private:
  std::string path_;
  Descriptor socket_;
  // The place, so that it is known again.
  std::uint64_t device_ = 0;
  std::uint64_t number_ = 0;
};

}  // namespace rr::platform
