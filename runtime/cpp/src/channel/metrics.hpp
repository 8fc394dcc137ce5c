// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <unordered_set>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::channel {

class MetricsText;

/// A number that one thread at a time adds to, and any thread reads: as cheap as a plain one. Who
/// reads one, and then another that was added to before it, sees that addition.
class Tally {
 public:
  void add(std::uint64_t more) {
    value_.store(value_.load(std::memory_order_relaxed) + more, std::memory_order_release);
  }
  [[nodiscard]] std::uint64_t get() const { return value_.load(std::memory_order_acquire); }

 private:
  std::atomic<std::uint64_t> value_{0};
};

/// What has gone over connections.
struct Traffic {
  std::uint64_t messages_received = 0;
  std::uint64_t bytes_received = 0;
  std::uint64_t messages_sent = 0;
  std::uint64_t bytes_sent = 0;
  std::uint64_t wire_values = 0;     ///< sent by this side
  std::uint64_t values_skipped = 0;  ///< of these: a newer one took their place before they left
  std::uint64_t pipe_packets = 0;    ///< sent by services

  Traffic& operator+=(const Traffic& more);
};

/// A connection as it is now.
struct ConnectionSample {
  bool is_open = false;
  bool is_server = false;
  bool is_in_session = false;
  std::string transport{};       ///< `rr+tcp` and so on
  std::size_t queued_bytes = 0;  ///< wait to be sent
  Traffic traffic{};
};

/// A connection that Metrics asks when it is asked itself.
class Metered {
 public:
  /// On any thread, under the lock of Metrics; takes no other.
  [[nodiscard]] virtual ConnectionSample sample() const = 0;

 protected:
  ~Metered() = default;
};

/// What requests are counted as: kinds of requests, not members, so that there are always as many.
enum class RequestKind : std::uint8_t {
  get,
  set,
  call,
  next,     ///< a step of a generator
  memory,   ///< reading, writing or asking about a memory
  peek,     ///< and poke, of a wire
  connect,  ///< and disconnect: wires and pipes
  objref,   ///< the type of an object
  session,  ///< connecting, definitions, logins, locks, monitors, keep-alives, capabilities
};
inline constexpr std::size_t request_kinds = 9;

/// What a node counts. Much of it is counted where it happens anyway, by one thread at a time, and
/// added up when somebody asks; what several threads count is spread over a few places, so that
/// they do not wait for each other's cache lines. No lock and no allocation where messages pass.
class Metrics {
 public:
  /// Upper bounds of the buckets of latency, in microseconds; the last one is without.
  static constexpr std::array<std::uint32_t, 18> bounds{
      10,     25,     50,     100,     250,     500,     1'000,     2'500,     5'000,
      10'000, 25'000, 50'000, 100'000, 250'000, 500'000, 1'000'000, 2'500'000, 10'000'000};

  Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// A request has been answered: after `took`, with an error unless `code` is none.
  void count_request(RequestKind kind, Clock::duration took, ErrorCode code);
  void count_login(bool is_allowed) { ++(is_allowed ? logins_ : refused_logins_); }
  /// A connection was accepted, was turned away or had to go because there were too many, or has
  /// failed before it could be used (TLS, web sockets, local users).
  void count_accepted() { ++accepted_; }
  void count_beyond_limit() { ++beyond_limit_; }
  void count_failed_handshake() { ++failed_handshakes_; }
  /// A value of a wire, or a packet of a pipe, could not be sent to a client.
  void count_dropped_value() { ++dropped_values_; }
  void count_dropped_packet() { ++dropped_packets_; }

  /// A connection begins. It is asked until remove(), which keeps what it has counted.
  void add(const Metered& connection);
  void remove(const Metered& connection);

  /// Writes all of it.
  void write(MetricsText& text) const;

 private:
  // So many threads add to different places; more share them.
  static constexpr std::size_t places = 8;

  struct alignas(64) Place {
    // By kind and bucket; the last bucket is without a bound.
    std::array<std::array<std::atomic<std::uint64_t>, bounds.size() + 1>, request_kinds> buckets{};
    std::array<std::atomic<std::uint64_t>, request_kinds> errors{};
    std::array<std::atomic<std::uint64_t>, request_kinds> nanoseconds{};
  };
  struct Counted;  // the sums of all places
  using Open = std::map<std::tuple<std::string, bool, bool>, std::size_t>;

  [[nodiscard]] Counted counted() const;
  Traffic sum(Open& open, std::uint64_t& queued) const;
  void write_connections(MetricsText& text) const;
  void write_requests(MetricsText& text) const;
  static void write_process(MetricsText& text);

  std::array<Place, places> places_;
  std::array<std::atomic<std::uint64_t>, 256> errors_{};  // by code
  std::atomic<std::uint64_t> logins_{0};
  std::atomic<std::uint64_t> refused_logins_{0};
  std::atomic<std::uint64_t> accepted_{0};
  std::atomic<std::uint64_t> beyond_limit_{0};
  std::atomic<std::uint64_t> failed_handshakes_{0};
  std::atomic<std::uint64_t> dropped_values_{0};
  std::atomic<std::uint64_t> dropped_packets_{0};

  mutable Mutex mutex_;
  std::unordered_set<const Metered*> connections_ RR_GUARDED_BY(mutex_);
  Traffic of_ended_ RR_GUARDED_BY(mutex_);  // of connections that are no more
};

/// Has a connection asked by the metrics of its node for as long as this exists; null: by nobody.
class Meter {
 public:
  Meter(Metrics* metrics, const Metered& connection) : metrics_(metrics), connection_(connection) {
    if (metrics_ != nullptr) metrics_->add(connection_);
  }
  ~Meter() {
    if (metrics_ != nullptr) metrics_->remove(connection_);
  }
  Meter(const Meter&) = delete;
  Meter& operator=(const Meter&) = delete;

 private:
  Metrics* const metrics_;
  const Metered& connection_;
};

}  // namespace rr::channel
