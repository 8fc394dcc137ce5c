// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rr/options.hpp"
#include "rr/reader.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/accept.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/testing/socket_pair.hpp"

namespace rr::testing {

/// Waits until something holds, for some seconds at most; whether it does.
inline bool comes_true(const std::function<bool()>& holds) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

/// A message of one entry, with an element of `size` bytes.
inline std::vector<std::byte> message_of(EntryType type, std::size_t size = 0) {
  Writer writer;
  writer.reset(MessageVersion::v2);
  const std::size_t end = writer.position();
  const std::string filling(size, 'x');
  if (size != 0) writer.string_element("filling", filling);
  writer.entry({.type = type}, size == 0 ? 0 : 1, end);
  writer.message({}, 1);
  return writer.copy();
}

/// What a server's connection gives its messages to: the test says what is done with them.
class TestReceiver final : public channel::Receiver {
 public:
  using Handle = std::function<void(channel::Connection&, const Entry&, const MemoryRef&)>;
  TestReceiver(std::shared_ptr<channel::Connection> connection, Handle handle)
      : connection_(std::move(connection)), handle_(std::move(handle)) {}

  void take_answer(const Message& /*message*/, const Entry& /*entry*/, const MemoryRef& /*owner*/,
                   channel::DeferredCallbacks& /*deferred*/) override {
    const std::lock_guard lock(mutex_);
    if (waiter_ != nullptr) connection_->finish_answered(*std::exchange(waiter_, nullptr));
  }
  void handle(const Message& /*message*/, const Entry& first, const MemoryRef& owner) override {
    if (handle_) handle_(*connection_, first, owner);
    ++handled;
  }
  void lost(const Error& error, channel::DeferredCallbacks& /*deferred*/) override {
    const std::lock_guard lock(mutex_);
    why = error;
    if (waiter_ != nullptr) connection_->finish(*std::exchange(waiter_, nullptr));
  }
  void closed() override {
    handled_when_closed = handled.load();
    is_closed = true;
  }

  /// From the function that handles a message: waits for an answer as a callback's caller does.
  void wait_for_answer() {
    channel::Waiter waiter;
    {
      const std::lock_guard lock(mutex_);
      waiter_ = &waiter;
    }
    const bool has_given_up = connection_->step_out();
    connection_->claim(waiter);
    connection_->wait(waiter, channel::Clock::now() + std::chrono::seconds(20),
                      channel::coarse_now());
    was_answered = waiter.is_done();
    if (has_given_up) connection_->step_in(channel::never);
  }
  [[nodiscard]] ErrorCode code() {
    const std::lock_guard lock(mutex_);
    return why.code();
  }

  std::atomic<unsigned> handled{0};
  std::atomic<unsigned> handled_when_closed{0};
  std::atomic<bool> is_closed{false};
  std::atomic<bool> was_answered{false};
  Error why{ErrorCode::none, ""};

 private:
  const std::shared_ptr<channel::Connection> connection_;
  const Handle handle_;
  std::mutex mutex_;
  channel::Waiter* waiter_ = nullptr;
};

/// The accepting side of a node, without the rest: connections of socket pairs whose messages a
/// test handles.
class Accepting {
 public:
  explicit Accepting(NodeOptions options = {}, TestReceiver::Handle handle = nullptr)
      : handle_(std::move(handle)) {
    options.id = NodeId::random();
    options.log = [this](LogLevel level, std::string_view text) {
      const std::lock_guard lock(mutex_);
      if (level == LogLevel::warning) warnings_.emplace_back(text);
    };
    context_.options = std::make_shared<const NodeOptions>(std::move(options));
    context_.reactor = std::make_shared<channel::Reactor>(8);
    context_.accepted = std::make_shared<channel::Admission>(context_.options);
    context_.pools = channel::make_pools(*context_.options);
    context_.reactor->start();
  }
  ~Accepting() {
    for (const auto& connection : connections_) {
      connection->close(Error(ErrorCode::connection_error, "the test is over"));
    }
    context_.reactor->connections().wait_for_none();
    connections_.clear();
    receivers_.clear();
    context_.reactor->stop();
  }
  Accepting(const Accepting&) = delete;
  Accepting& operator=(const Accepting&) = delete;

  /// The other end of a pair, which the caller keeps.
  channel::Connection& accept(SocketPair& sockets) {
    connections_.push_back(channel::adopt_socket(
        context_, sockets.give_away(), [&](const std::shared_ptr<channel::Connection>& connection) {
          receivers_.push_back(std::make_shared<TestReceiver>(connection, handle_));
          return receivers_.back();
        }));
    return *connections_.back();
  }
  TestReceiver& receiver(std::size_t number = 0) { return *receivers_.at(number); }
  channel::Connection& connection(std::size_t number = 0) { return *connections_.at(number); }
  std::size_t strangers_hold() const { return context_.pools.before_session->held(); }
  std::size_t sessions_hold() const { return context_.pools.sessions->held(); }
  channel::Admission& admission() { return *context_.accepted; }
  std::vector<std::string> warnings() {
    const std::lock_guard lock(mutex_);
    return warnings_;
  }

 private:
  const TestReceiver::Handle handle_;
  std::mutex mutex_;
  std::vector<std::string> warnings_;
  channel::ChannelContext context_;
  std::vector<std::shared_ptr<channel::Connection>> connections_;
  std::vector<std::shared_ptr<TestReceiver>> receivers_;
};

}  // namespace rr::testing
