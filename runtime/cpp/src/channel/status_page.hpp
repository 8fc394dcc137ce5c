// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rr::channel {

class Status;

/// A request of HTTP, as far as access to a node's state depends on it.
struct StatusRequest {
  std::string_view method;
  std::string_view path;  ///< without the query
  std::string_view host;
  std::optional<std::string_view> origin{};      ///< of a page; programs send none
  std::optional<std::string_view> fetch_site{};  ///< `Sec-Fetch-Site` of a browser
  std::string_view from;                         ///< the address of the client
  bool may_be_clear = true;                      ///< false: this is without TLS, which is required
};

/// Answer to a request for a node's state: its HTTP status, and all bytes.
struct StatusPage {
  unsigned status = 0;
  std::string bytes;
};

/// The answer to `GET /metrics` and `GET /health`; nothing for another path. A client that may not
/// ask gets 403; a browser's page has to be of an allowed origin, and what asks by a name that this
/// machine has not given itself gets 421.
std::optional<StatusPage> status_page(const Status& status, const StatusRequest& request,
                                      const std::vector<std::string>& allowed_origins);

}  // namespace rr::channel
