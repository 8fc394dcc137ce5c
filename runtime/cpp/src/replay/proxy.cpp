// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/replay/proxy.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <list>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/cpp/src/channel/socket.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"
#include "runtime/cpp/src/replay/cutter.hpp"
#include "runtime/cpp/src/replay/passing.hpp"
#include "runtime/cpp/src/replay/stream.hpp"

namespace rr::replay {
namespace {

namespace ready = platform::ready;

constexpr std::size_t bytes_at_once = 64 * 1024;

// One direction of a connection. It is read again when all that came before has been passed on.
class Way {
 public:
  Way(int from, int to, Direction direction) : from_(from), to_(to), direction_(direction) {}

  [[nodiscard]] std::uint32_t wants_of(int descriptor) const {
    if (is_done_) return 0;
    const bool has_rest = sent_ != bytes_.size();
    if (descriptor == from_ && !has_rest) return ready::input;
    return descriptor == to_ && has_rest ? ready::room : 0;
  }

  // Once something was found that it wanted.
  void go_on(Tap& tap, std::uint32_t connection) {
    if (sent_ == bytes_.size()) read(tap, connection);
    write();
  }

  [[nodiscard]] bool is_done() const { return is_done_; }
  [[nodiscard]] bool is_broken() const { return is_broken_; }
  [[nodiscard]] bool has_other_bytes() const { return cutter_.is_lost(); }

 private:
  void read(Tap& tap, std::uint32_t connection) {
    sent_ = 0;
    bytes_.resize(bytes_at_once);
    const std::ptrdiff_t size = platform::receive(from_, bytes_, platform::Wait::none);
    bytes_.resize(static_cast<std::size_t>(std::max<std::ptrdiff_t>(size, 0)));
    if (size == platform::nothing_now) return;
    if (size < 0) {
      is_broken_ = is_done_ = true;
    } else if (size == 0) {
      platform::shut_down_sending(to_);
      is_done_ = true;
    } else {
      // First the tap: the other side may answer as soon as it has the bytes.
      cutter_.add(bytes_, [&](std::span<const std::byte> message) {
        tell(tap, connection, direction_, message);
      });
    }
  }

  void write() {
    while (sent_ != bytes_.size()) {
      const std::ptrdiff_t size = platform::send(to_, std::span(bytes_).subspan(sent_));
      if (size == platform::nothing_now) return;
      if (size < 0) {
        is_broken_ = is_done_ = true;
        return;
      }
      sent_ += static_cast<std::size_t>(size);
    }
  }

  const int from_;
  const int to_;
  const Direction direction_;
  Cutter cutter_;
  Bytes bytes_;
  std::size_t sent_ = 0;
  bool is_done_ = false;
  bool is_broken_ = false;
};

}  // namespace

class Proxy::Work {
 public:
  Work(std::shared_ptr<Tap> tap, HostPort service, ProxyOptions options)
      : tap_(std::move(tap)),
        service_(std::move(service)),
        options_(std::move(options)),
        listener_(listening(options_)),
        stop_(make_bell()),
        thread_([this] { accept_all(); }) {}
  ~Work() { stop(); }

  [[nodiscard]] int port() const { return listener_.port(); }

  void stop() {
    stop_.ring();
    if (thread_.joinable()) thread_.join();
  }

 private:
  struct Line {
    std::thread thread;
    std::atomic<bool> is_done{false};
  };

  static platform::Bell make_bell() {
    std::error_code error;
    platform::Bell bell(error);
    if (error) throw Error(ErrorCode::system_resource_error, error.message());
    return bell;
  }

  static Listener listening(const ProxyOptions& options) {
    try {
      return Listener(options.port, options.listens_everywhere);
    } catch (const std::exception& failure) {
      throw Error(ErrorCode::connection_error, failure.what());
    }
  }

  void log(const std::string& text) const {
    if (options_.log) options_.log(text);
  }

  void accept_all() {
    while (wait_for(listener_.descriptor())) {
      auto client = listener_.accept(Milliseconds(0));
      lines_.remove_if([](Line& line) {
        if (!line.is_done) return false;
        line.thread.join();
        return true;
      });
      if (!client) continue;
      Line& line = lines_.emplace_back();
      line.thread = std::thread([this, &line, stream = std::move(*client)]() mutable {
        pass(std::move(stream));
        line.is_done = true;
      });
    }
    for (Line& line : lines_) line.thread.join();
  }

  // False when the end is wanted.
  bool wait_for(int descriptor) const {
    std::array<platform::Awaited, 2> wanted = {
        {{stop_.descriptor(), ready::input}, {descriptor, ready::input}}};
    platform::wait_for_any(wanted, channel::never);
    return wanted[0].found == 0;
  }

  void pass(Stream client) {
    const std::uint32_t number = tap_->opened(
        {.side = TapSide::between,
         .client_url = channel::url_of(platform::remote_address(client.descriptor())),
         .service_url = "rr+tcp://" + host_text() + ":" + std::to_string(service_.port)});
    std::string reason;
    try {
      const Stream service = Stream::connect(service_.host, service_.port);
      reason = pass_all(number, client.descriptor(), service.descriptor());
    } catch (const std::exception& failure) {
      reason = failure.what();
      log("connection " + std::to_string(number) + ": " + reason);
    }
    tap_->closed(number, ErrorCode::connection_error, reason);
  }

  // Until both sides have ended; returns who did it first.
  std::string pass_all(std::uint32_t number, int client, int service) {
    std::array<Way, 2> ways = {Way(client, service, Direction::to_service),
                               Way(service, client, Direction::to_client)};
    std::string reason;
    bool has_warned = false;
    while (!ways[0].is_done() || !ways[1].is_done()) {
      std::array<platform::Awaited, 3> wanted = {
          {{stop_.descriptor(), ready::input}, {client}, {service}}};
      for (const Way& way : ways) {
        for (platform::Awaited& each : wanted) each.wanted |= way.wants_of(each.socket);
      }
      // Nothing is to be told of the end of a side that nothing is wanted of.
      for (platform::Awaited& each : wanted) {
        if (each.wanted == 0) each.socket = -1;
      }
      if (!platform::wait_for_any(wanted, channel::never)) continue;
      if (wanted[0].found != 0) return "the recording ended";
      for (Way& way : ways) {
        if (!way.is_done()) way.go_on(*tap_, number);
        if (way.is_broken()) return reason.empty() ? "the connection broke" : reason;
        if (!has_warned && way.has_other_bytes()) {
          has_warned = true;
          log("connection " + std::to_string(number) +
              ": bytes that are no messages pass by unrecorded");
        }
      }
      if (reason.empty() && ways[0].is_done()) reason = closed_by_client;
      if (reason.empty() && ways[1].is_done()) reason = closed_by_service;
    }
    return reason;
  }

  [[nodiscard]] std::string host_text() const {
    const bool is_v6 = service_.host.find(':') != std::string::npos;
    return is_v6 ? "[" + service_.host + "]" : service_.host;
  }

  const std::shared_ptr<Tap> tap_;
  const HostPort service_;
  const ProxyOptions options_;
  Listener listener_;
  const platform::Bell stop_;
  std::list<Line> lines_;
  std::thread thread_;  // last: it uses the rest
};

Proxy::Proxy(std::shared_ptr<Tap> tap, HostPort service, ProxyOptions options)
    : work_(std::make_unique<Work>(std::move(tap), std::move(service), std::move(options))) {}
Proxy::~Proxy() = default;

int Proxy::port() const { return work_->port(); }
void Proxy::stop() { work_->stop(); }

}  // namespace rr::replay
