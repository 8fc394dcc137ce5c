// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "rr/options.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/layer.hpp"
#include "runtime/cpp/src/channel/web_page.hpp"

namespace rr::channel {

class Status;

/// A client of a node, as far as its answers depend on it.
struct WebClient {
  bool is_encrypted = false;  ///< there is TLS around
  bool must_encrypt = false;  ///< and there has to be
  std::string address{};      ///< as remote_address_of() writes it
};

/// Web sockets around streams (04, sections 2.2 and 2.3), those of one node. Any thread may use it.
/// See components.hpp for who makes one.
class WebSockets {
 public:
  virtual ~WebSockets() = default;

  /// As the client of a URL.
  [[nodiscard]] virtual std::unique_ptr<Layer> make_client(const Url& url) = 0;
  /// For pages of the origins that the options allow, and what says no origin. Where a page is
  /// served, it may connect, too: to the node that served it.
  [[nodiscard]] virtual std::unique_ptr<Layer> make_server(WebClient client) = 0;
  /// Whether what begins with this byte is a request of HTTP, and not something else.
  [[nodiscard]] virtual bool is_request(std::byte first) const = 0;
};

/// The page that options name; null for none. Throws rr::Error (invalid_configuration).
std::shared_ptr<const WebPage> served_page(const WebSocketOptions& options);

/// The origins that options allow.
std::vector<std::string> allowed_origins(const WebSocketOptions& options);

/// Whether a page of an origin may connect: compared without regard to case and with the scheme's
/// default port filled in; `*.` stands for any host below, and what ends in `://` for all of that
/// scheme (04, section 2.2).
bool is_allowed_origin(std::string_view origin, const std::vector<std::string>& allowed);

}  // namespace rr::channel
