// SPDX-License-Identifier: Apache-2.0
// What a program has only when it is linked with it. This file is the list.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "rr/node_id.hpp"
#include "rr/options.hpp"

namespace rr::channel {

class Reactor;
class Status;
class Tls;
class WebSockets;

/// What the library robdef_tls brings.
struct TlsComponent {
  std::shared_ptr<const Tls> (*make)(const TlsOptions& options, const NodeId& own,
                                     std::shared_ptr<Reactor> reactor,
                                     const std::function<void(LogLevel, std::string_view)>& log);
  NodeId (*certified_id)(const TlsOptions& options);
};
/// What the library robdef_web brings.
struct WebComponent {
  std::shared_ptr<WebSockets> (*make)(const WebSocketOptions& options,
                                      std::shared_ptr<const Status> status);
};

/// Null without the component. Throws rr::Error (invalid_configuration) when a certificate cannot
/// be used, is of another node than `own`, or when the options ask for TLS that is not there.
std::shared_ptr<const Tls> make_tls(const TlsOptions& options, const NodeId& own,
                                    std::shared_ptr<Reactor> reactor,
                                    const std::function<void(LogLevel, std::string_view)>& log);
/// The node that the certificate of the options is of. Throws rr::Error (invalid_configuration).
NodeId certified_id(const TlsOptions& options);

/// Null without the component. `status`: the state that the node shows at its ports; null: none.
/// Throws rr::Error (invalid_configuration) for options that need what is not there.
std::shared_ptr<WebSockets> make_web_sockets(const WebSocketOptions& options,
                                             std::shared_ptr<const Status> status = nullptr);

/// What URLs of a scheme need that this program is not linked with: `robdef::tls`. Empty: nothing.
std::string missing_component(std::string_view scheme);

}  // namespace rr::channel

// The core refers to them weakly (components.cpp), so that it links without a component: `-u
// SYMBOL` makes the linker include it. Their definitions are not weak: linkers for Windows find
// none that are.
extern "C" {
[[gnu::visibility("default")]] extern const rr::channel::TlsComponent rr_component_tls;
[[gnu::visibility("default")]] extern const rr::channel::WebComponent rr_component_web;
}
