// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/components.hpp"

#include <utility>

#include "rr/error.hpp"

// Declared again to be weak here.
// NOLINTBEGIN(readability-redundant-declaration)
extern "C" {
[[gnu::weak]] extern const rr::channel::TlsComponent rr_component_tls;
[[gnu::weak]] extern const rr::channel::WebComponent rr_component_web;
}
// NOLINTEND(readability-redundant-declaration)

namespace rr::channel {
namespace {

bool has_tls() { return &rr_component_tls != nullptr; }
bool has_web() { return &rr_component_web != nullptr; }

bool asks_for_tls(const TlsOptions& options) {
  return !options.certificate_file.empty() || !options.authority_files.empty() ||
         !options.pins.empty() || options.is_required || options.must_certify_clients;
}

[[noreturn]] void fail_without_tls() {
  throw Error(ErrorCode::invalid_configuration,
              "the options of the node ask for TLS, which this program has not: link robdef::tls");
}

}  // namespace

std::shared_ptr<const Tls> make_tls(const TlsOptions& options, const NodeId& own,
                                    std::shared_ptr<Reactor> reactor,
                                    const std::function<void(LogLevel, std::string_view)>& log) {
  if (has_tls()) return rr_component_tls.make(options, own, std::move(reactor), log);
  if (asks_for_tls(options)) fail_without_tls();
  return nullptr;
}

NodeId certified_id(const TlsOptions& options) {
  if (!has_tls()) fail_without_tls();
  return rr_component_tls.certified_id(options);
}

std::shared_ptr<WebSockets> make_web_sockets(const WebSocketOptions& options,
                                             std::shared_ptr<const Status> status) {
  if (status != nullptr && (!has_web() || !options.is_enabled)) {
    throw Error(ErrorCode::invalid_configuration,
                has_web()
                    ? "metrics are served at the port of web sockets, which are switched off"
                    : "metrics need web sockets, which this program has not: link robdef::web");
  }
  return has_web() ? rr_component_web.make(options, std::move(status)) : nullptr;
}

std::string missing_component(std::string_view scheme) {
  const bool is_web = scheme.ends_with("+ws") || scheme.ends_with("+wss");
  const bool is_encrypted = scheme.starts_with("rrs+") || scheme.ends_with("+wss");
  if (is_web && !has_web()) return "robdef::web";
  if (is_encrypted && !has_tls()) return "robdef::tls";
  return {};
}

}  // namespace rr::channel
