// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
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
  /// What tells one socket file from another. File systems use the number of a removed file again,
  /// at once: so the time of its last change counts, too.
  struct Place {
    std::uint64_t device = 0;
    std::uint64_t number = 0;
    std::int64_t changed = 0;

    bool operator==(const Place&) const = default;
  };
  static std::optional<Place> place_at(const std::string& path);

  std::string path_;
  Descriptor socket_;
  std::optional<Place> place_;
};

}  // namespace rr::platform
