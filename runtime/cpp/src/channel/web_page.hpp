// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace rr::channel {

/// The page of the inspector, as a node serves it at the port of its web sockets.
class WebPage {
 public:
  /// Reads the file once. One that is compressed by gzip is sent as it is, for browsers to unpack.
  /// Throws rr::Error (invalid_configuration) for a file that cannot be read, is empty or has more
  /// than `most_bytes`.
  explicit WebPage(const std::string& file);

  /// The answer to a request for the page: headers and content.
  [[nodiscard]] const std::string& answer() const { return answer_; }

  /// A connection holds no more of its own answers (layered_carrier.cpp).
  static constexpr std::size_t most_bytes = 1000 * 1000;

 private:
  std::string answer_;
};

/// Whether a host of a URL, with or without a port, names this machine in a way that nobody else
/// can make up: an address, `localhost`, or the machine's name, also with `.local`. Names of the
/// domain name system are none: whoever owns one can let it point here, and a page of theirs would
/// then have the origin of this node.
bool is_own_host(std::string_view host);

}  // namespace rr::channel
