// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace rr::gateway {

/// How a broker is reached: `[broker]` of an export file, or the command line.
struct BrokerOptions {
  std::string url;            ///< `mqtt://host:port`; `mqtts`, `nats` or `tls` in its place
  std::string user{};         ///< empty: none
  std::string password{};     ///< of the user
  std::string authority{};    ///< PEM file of certificate authorities; empty: those of the system
  std::string certificate{};  ///< PEM file with a certificate of this side; empty: none
  std::string key{};          ///< PEM file with its key; empty: in the file of the certificate
  std::string token{};        ///< NATS: in place of user and password; empty: none
  std::string credentials{};  ///< NATS: file with a token and a key of a user; empty: none
  int replicas = 1;           ///< NATS: servers of a cluster that have what is retained
};

/// The parts of a broker's URL.
struct BrokerPlace {
  bool is_encrypted = false;
  std::string host;  ///< a name or an address, without brackets
  int port = 0;
};

/// A scheme and what it means.
struct BrokerScheme {
  std::string_view name;  ///< as `mqtts`
  bool is_encrypted = false;
  int port = 0;  ///< where the URL has none
};

/// Whether the URL of a broker has this scheme.
bool has_scheme(std::string_view url, std::string_view scheme);
/// Reads the URL and checks that files of TLS are not named in vain. Throws rr::Error
/// (invalid_argument) for a URL without one of these schemes and for files without TLS.
BrokerPlace place_of(const BrokerOptions& broker, std::span<const BrokerScheme> schemes);

}  // namespace rr::gateway
