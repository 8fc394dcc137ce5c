// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/metrics.hpp"

#include <algorithm>
#include <string_view>

#include "runtime/cpp/src/channel/metrics_text.hpp"
#include "runtime/cpp/src/platform/process.hpp"

namespace rr::channel {
namespace {

constexpr std::array<std::string_view, request_kinds> kind_names{
    "get", "set", "call", "next", "memory", "peek", "connect", "objref", "session"};

// Threads take places in turn; a node has few that are busy at a time.
std::size_t place_of_thread(std::size_t places) {
  static std::atomic<std::size_t> next{0};
  thread_local const std::size_t own = next.fetch_add(1, std::memory_order_relaxed);
  return own % places;
}

void count_up(std::atomic<std::uint64_t>& to, std::uint64_t more) {
  to.fetch_add(more, std::memory_order_release);
}

std::uint64_t get(const std::atomic<std::uint64_t>& from) {
  return from.load(std::memory_order_acquire);
}

// Codes without a name of their own are one.
std::size_t row_of(ErrorCode code) {
  const bool is_known = !error_name(code).empty() || code == ErrorCode::remote_error;
  return static_cast<std::size_t>(is_known ? code : ErrorCode::unknown_error);
}

std::string error_type(std::size_t code) {
  const std::string_view name = error_name(static_cast<ErrorCode>(code));
  if (!name.empty()) return std::string(name);
  return static_cast<ErrorCode>(code) == ErrorCode::remote_error ? "RobotRaconteur.RemoteError"
                                                                 : "RobotRaconteur.UnknownError";
}

}  // namespace

Traffic& Traffic::operator+=(const Traffic& more) {
  messages_received += more.messages_received;
  bytes_received += more.bytes_received;
  messages_sent += more.messages_sent;
  bytes_sent += more.bytes_sent;
  wire_values += more.wire_values;
  values_skipped += more.values_skipped;
  pipe_packets += more.pipe_packets;
  return *this;
}

struct Metrics::Counted {
  std::array<std::array<std::uint64_t, bounds.size() + 1>, request_kinds> buckets{};
  std::array<std::uint64_t, request_kinds> all{};
  std::array<std::uint64_t, request_kinds> errors{};
  std::array<std::uint64_t, request_kinds> nanoseconds{};
};

Metrics::Metrics() = default;

[[gnu::hot]] void Metrics::count_request(RequestKind kind, Clock::duration took, ErrorCode code) {
  const auto nanoseconds =
      static_cast<std::uint64_t>(std::max<std::int64_t>(0, std::chrono::nanoseconds(took).count()));
  std::size_t bucket = 0;
  while (bucket != bounds.size() && nanoseconds > std::uint64_t{bounds[bucket]} * 1000) ++bucket;
  Place& place = places_[place_of_thread(places)];
  const auto row = static_cast<std::size_t>(kind);
  count_up(place.nanoseconds[row], nanoseconds);
  count_up(place.buckets[row][bucket], 1);
  if (code == ErrorCode::none) return;
  count_up(place.errors[row], 1);  // last: see counted()
  count_up(errors_.at(row_of(code)), 1);
}

void Metrics::add(const Metered& connection) {
  const MutexLock lock(mutex_);
  connections_.insert(&connection);
}

void Metrics::remove(const Metered& connection) {
  const MutexLock lock(mutex_);
  if (connections_.erase(&connection) != 0) of_ended_ += connection.sample().traffic;
}

// Errors are read first, as they are counted last: all requests without them never become fewer.
Metrics::Counted Metrics::counted() const {
  Counted sums;
  for (const Place& place : places_) {
    for (std::size_t kind = 0; kind != request_kinds; ++kind) {
      sums.errors[kind] += get(place.errors[kind]);
      for (std::size_t i = 0; i != sums.buckets[kind].size(); ++i) {
        const std::uint64_t count = get(place.buckets[kind][i]);
        sums.buckets[kind][i] += count;
        sums.all[kind] += count;
      }
      sums.nanoseconds[kind] += get(place.nanoseconds[kind]);
    }
  }
  return sums;
}

Traffic Metrics::sum(Open& open, std::uint64_t& queued) const {
  const MutexLock lock(mutex_);
  Traffic traffic = of_ended_;
  for (const Metered* const connection : connections_) {
    const ConnectionSample sample = connection->sample();
    traffic += sample.traffic;
    if (!sample.is_open) continue;
    queued += sample.queued_bytes;
    ++open[{sample.transport, sample.is_server, sample.is_in_session}];
  }
  return traffic;
}

void Metrics::write(MetricsText& text) const {
  write_connections(text);
  write_requests(text);
  write_process(text);
}

// The names that Prometheus has for this.
void Metrics::write_process(MetricsText& text) {
  const platform::ProcessUse use = platform::process_use();
  text.begin({"process_cpu_seconds", "counter", "Processor time of the process.", "seconds"});
  text.sample("_total", {}, std::chrono::duration<double>(use.processor).count());
  text.gauge({"process_resident_memory_bytes", "gauge", "Memory of the process.", "bytes"},
             use.resident);
}

void Metrics::write_connections(MetricsText& text) const {
  Open open;
  std::uint64_t queued = 0;
  const Traffic traffic = sum(open, queued);

  text.begin({"robdef_connections", "gauge", "Open connections."});
  for (const auto& [what, count] : open) {
    const auto& [transport, is_server, is_in_session] = what;
    text.sample("",
                {{"transport", transport},
                 {"role", is_server ? "server" : "client"},
                 {"state", is_in_session ? "session" : "no_session"}},
                std::uint64_t{count});
  }
  text.counter({"robdef_connections_accepted", "counter", "Connections that came in."},
               get(accepted_));
  text.begin({"robdef_connections_refused", "counter",
              "Connections that were refused or closed: too many, or a handshake that failed."});
  text.sample("_total", {{"reason", "limit"}}, get(beyond_limit_));
  text.sample("_total", {{"reason", "handshake"}}, get(failed_handshakes_));

  text.begin({"robdef_messages", "counter", "Messages, heartbeats included."});
  text.sample("_total", {{"direction", "received"}}, traffic.messages_received);
  text.sample("_total", {{"direction", "sent"}}, traffic.messages_sent);
  text.begin({"robdef_message_bytes", "counter", "Bytes of these messages.", "bytes"});
  text.sample("_total", {{"direction", "received"}}, traffic.bytes_received);
  text.sample("_total", {{"direction", "sent"}}, traffic.bytes_sent);
  text.gauge({"robdef_send_queue_bytes", "gauge", "Bytes that wait to be sent.", "bytes"}, queued);

  text.begin({"robdef_wire_values", "counter",
              "Values of wires, once for each receiver; skipped: a newer one left instead."});
  const std::uint64_t skipped = traffic.values_skipped;
  text.sample("_total", {{"outcome", "sent"}},
              traffic.wire_values - std::min(skipped, traffic.wire_values));
  text.sample("_total", {{"outcome", "skipped"}}, skipped);
  text.sample("_total", {{"outcome", "dropped"}}, get(dropped_values_));
  text.begin({"robdef_pipe_packets", "counter",
              "Packets that services have sent, once for each receiver; dropped: it is too slow."});
  text.sample("_total", {{"outcome", "sent"}}, traffic.pipe_packets);
  text.sample("_total", {{"outcome", "dropped"}}, get(dropped_packets_));
}

void Metrics::write_requests(MetricsText& text) const {
  const Counted sums = counted();
  text.begin({"robdef_server_requests", "counter", "Requests that services have answered."});
  for (std::size_t kind = 0; kind != request_kinds; ++kind) {
    const std::uint64_t errors = std::min(sums.errors[kind], sums.all[kind]);
    text.sample("_total", {{"robdef_request", kind_names[kind]}, {"outcome", "ok"}},
                sums.all[kind] - errors);
    text.sample("_total", {{"robdef_request", kind_names[kind]}, {"outcome", "error"}}, errors);
  }
  text.begin({"robdef_server_errors", "counter", "Errors that services have answered with."});
  for (std::size_t code = 0; code != errors_.size(); ++code) {
    const std::uint64_t count = get(errors_[code]);
    if (count != 0) text.sample("_total", {{"error_type", error_type(code)}}, count);
  }
  text.begin({"rpc_server_call_duration_seconds", "histogram",
              "From bringing a request to its handler to the answer.", "seconds"});
  for (std::size_t kind = 0; kind != request_kinds; ++kind) {
    std::uint64_t below = 0;
    for (std::size_t i = 0; i != bounds.size(); ++i) {
      below += sums.buckets[kind][i];
      const std::string bound = MetricsText::seconds_text(std::uint64_t{bounds[i]} * 1000);
      text.sample("_bucket",
                  {{"rpc_system_name", "robot_raconteur"},
                   {"robdef_request", kind_names[kind]},
                   {"le", bound}},
                  below);
    }
    const std::string_view name = kind_names[kind];
    text.sample("_bucket",
                {{"rpc_system_name", "robot_raconteur"}, {"robdef_request", name}, {"le", "+Inf"}},
                sums.all[kind]);
    text.sample("_count", {{"rpc_system_name", "robot_raconteur"}, {"robdef_request", name}},
                sums.all[kind]);
    text.sample("_sum", {{"rpc_system_name", "robot_raconteur"}, {"robdef_request", name}},
                static_cast<double>(sums.nanoseconds[kind]) / 1e9);
  }
  text.begin({"robdef_logins", "counter", "Logins of users."});
  text.sample("_total", {{"outcome", "allowed"}}, get(logins_));
  text.sample("_total", {{"outcome", "refused"}}, get(refused_logins_));
}

}  // namespace rr::channel
