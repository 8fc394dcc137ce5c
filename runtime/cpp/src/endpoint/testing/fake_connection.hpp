// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/connection.hpp"

namespace rr::testing {

/// A connection without a network: keeps what is sent, and waits as the test says.
class FakeConnection : public channel::Connection {
 public:
  using Bytes = std::vector<std::byte>;

  explicit FakeConnection(MessageVersion version = MessageVersion::v4) { version_ = version; }

  std::vector<Bytes> sent;                  ///< in whichever way
  std::vector<channel::Newest> newest;      ///< of those of which only the newest counts
  int expected = 0;                         ///< calls of expect()
  int nudged = 0;                           ///< calls of nudge()
  int resigned = 0;                         ///< calls of resign()
  bool has_room = true;                     ///< what has_sent() and wait_sent() say
  std::optional<Error> refusal;             ///< what sending throws
  std::function<void()> on_wait = nullptr;  ///< instead of waiting

  void set_remote(const NodeId& node, std::string name) {
    remote_node_ = node;
    remote_name_ = std::move(name);
  }
  void set_combine(bool may_combine) { may_combine_ = may_combine; }

  [[nodiscard]] std::string local_url() const override { return "rr+tcp://127.0.0.1:1"; }
  [[nodiscard]] ChannelTraits traits() const override { return {}; }
  void check_size(const Writer& /*message*/) const override {}
  using Connection::reply;
  using Connection::send;
  void send(Writer& message, channel::Time /*now*/, channel::Priority /*priority*/) override {
    keep(message);
  }
  void send_call(Writer& message, channel::Time /*now*/, channel::Priority /*priority*/) override {
    keep(message);
  }
  void send_newest(Writer& message, const channel::Newest& what, channel::Time /*now*/) override {
    keep(message);
    newest.push_back(what);
  }
  void stream(Writer& message) override { keep(message); }
  bool wait_sent(std::size_t /*bytes*/, channel::Time /*deadline*/) override { return has_room; }
  [[nodiscard]] bool has_sent(std::size_t /*bytes*/) const override { return has_room; }
  void reply(Writer& message, channel::Priority /*priority*/) override { keep(message); }
  void claim(channel::Waiter& /*waiter*/) override {}
  void wait(channel::Waiter& /*waiter*/, channel::Time /*deadline*/,
            channel::Time /*now*/) override {
    if (on_wait) on_wait();
  }
  void resign(channel::Waiter& /*waiter*/) override { ++resigned; }
  void finish(channel::Waiter& waiter) override { waiter.state |= channel::Waiter::done; }
  void finish_answered(channel::Waiter& waiter) override { finish(waiter); }
  void expect() override { ++expected; }
  void nudge() override { ++nudged; }
  bool step_out() override { return false; }
  bool step_in(channel::Time /*deadline*/) override { return true; }
  void await_strand() override {}
  void close(const Error& why) override { why_ = why; }
  void close_after(channel::Milliseconds /*delay*/) override {}
  [[nodiscard]] bool is_closed() const override { return why_.has_value(); }

 private:
  void keep(Writer& message) {
    if (refusal) throw Error(*refusal);
    sent.push_back(message.copy());
  }

  std::optional<Error> why_;
};

}  // namespace rr::testing
