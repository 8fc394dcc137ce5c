// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>

#include "gateway/broker_options.hpp"
#include "gateway/carrier.hpp"

namespace rr::gateway {

/// How a server of NATS is used.
struct NatsLimits {
  std::size_t in_flight = 256;  ///< messages that the server has not read, at most
  /// Bytes of these, at most; one message may be larger.
  std::size_t in_flight_bytes = std::size_t{16} * 1024 * 1024;
  /// To the next attempt to connect, at first; it doubles up to `max_retry`.
  std::chrono::milliseconds retry{100};
  std::chrono::milliseconds max_retry{3'000};
  std::chrono::seconds keep_alive{10};  ///< after this without an answer the link has failed
  /// Without an answer to what is retained; then the next server is tried.
  std::chrono::milliseconds beginning{20'000};
  std::chrono::milliseconds beat{2'000};     ///< between two beats of a life
  std::chrono::milliseconds silence{7'000};  ///< of a life, after which it is lost
};

/// A carrier to NATS with JetStream: `nats://host`, or `tls://host` with TLS, port 4222. Several
/// servers of a cluster are given with commas between them; each attempt to connect takes the next.
///
/// Retained messages are those of a stream (gateway/kept_stream.hpp), which the first gateway makes
/// that publishes one; the newest of each topic is repeated until the stream has stored it. Their
/// topics are below `rr/`. NATS has no wills: a life whose topic ends with `/$life` and which is
/// retained repeats a beat, and the carriers of readers conclude that it is lost; other lives are
/// not published. Throws rr::Error: invalid_argument for a URL, invalid_configuration for a file,
/// not_implemented_error where the library was not there when this was built.
std::unique_ptr<Carrier> make_nats_carrier(BrokerOptions broker, const NatsLimits& limits = {});

/// Whether the library was there when this was built.
bool has_nats();

}  // namespace rr::gateway
