// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "rr/node_id.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// Where a service is: `rr+tcp://host:port/?service=name[&nodeid=...][&nodename=...]`, or in the
/// form of 2011 `tcp://host:port/<node>/<service>` (04, section 1).
struct Url {
  std::string scheme;  ///< lower case, without `://`
  std::string host;    ///< name or digits; IPv6 without brackets, with `%scope` if given
  std::uint16_t port =
      0;              ///< the scheme's default when the text has none; 0 for schemes without ports
  std::string path;   ///< from the first `/` to the `?`
  std::string query;  ///< what follows the `?`, as written
  std::string service;    ///< empty when the text names none, as where to listen does
  NodeId node_id;         ///< zero when not given
  std::string node_name;  ///< empty when not given

  /// Throws rr::Error (invalid_argument).
  static Url parse(std::string_view text);
  /// Whether a node may be named so: a letter, then letters, digits, underscores, points and
  /// hyphens; 1024 at most.
  static bool is_node_name(std::string_view text);
};

}  // namespace rr
