// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "rr/definition.hpp"
#include "rr/mutex.hpp"
#include "rr/options.hpp"
#include "rr/registry.hpp"
#include "rr/timer.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/slot_budget.hpp"
#include "runtime/cpp/src/endpoint/found_urls.hpp"
#include "runtime/cpp/src/endpoint/sender_clock.hpp"

namespace rr::channel {
class Status;
}  // namespace rr::channel

namespace rr::endpoint {

/// An endpoint that wants to be looked after every few seconds.
class Attended {
 public:
  virtual ~Attended() = default;
  /// On the watching thread: short, no user code.
  virtual void attend(channel::Time now) = 0;
};

/// What all of a node shares: who it is, its threads, the definitions it knows, its channels.
class Core : public NodeContext, public std::enable_shared_from_this<Core> {
 public:
  explicit Core(NodeOptions options);
  ~Core() override;

  [[nodiscard]] const NodeId& id() const override { return options_->id; }
  [[nodiscard]] const std::string& name() const override { return options_->name; }

  [[nodiscard]] const NodeOptions& options() const { return *options_; }
  [[nodiscard]] channel::Reactor& reactor() const { return *reactor_; }
  [[nodiscard]] channel::ChannelContext context() const {
    return {reactor_, options_, accepted_, pools_, tls_, web_sockets_};
  }
  /// What peers may make this node hold.
  [[nodiscard]] const channel::Pools& pools() const { return pools_; }
  /// The state of the node, for programs that watch it; null: it is not shown.
  [[nodiscard]] const std::shared_ptr<channel::Status>& status() const { return status_; }
  /// Starts the threads unless they run.
  void start() { reactor_->start(); }
  /// Waits for all threads to end. No connection may be left.
  void stop() { reactor_->stop(); }

  void log(LogLevel level, std::string_view text) const override;
  rr::Timer every(std::chrono::nanoseconds period, std::function<void()> work) override;
  rr::Timer after(std::chrono::nanoseconds delay, std::function<void()> work) override;

  /// What the values of wires are stamped with.
  [[nodiscard]] const SenderClock& clock() const { return clock_; }

  /// URLs that the program has from discovery.
  [[nodiscard]] FoundUrls& found_urls() { return found_urls_; }

  /// The memories in which this node publishes wires.
  [[nodiscard]] const std::shared_ptr<channel::SlotBudget>& slot_budget() const {
    return slot_budget_;
  }
  /// The threads of this node that sleep on wires of others; each has a count, and no bytes.
  [[nodiscard]] const std::shared_ptr<channel::SlotBudget>& slot_threads() const {
    return slot_threads_;
  }

  /// Makes a definition and its imports known.
  void add_definition(const Definition& definition);
  /// The same for one that goes with its last owner: it is kept until the node's core goes.
  void keep_definition(std::shared_ptr<const Definition> definition);
  /// What is known now; does not change any more.
  [[nodiscard]] std::shared_ptr<const TypeRegistry> types() const;

  /// A number that no endpoint of this node has.
  std::uint32_t new_endpoint();
  void release_endpoint(std::uint32_t number);

  /// The channel for a scheme. Throws rr::Error (invalid_argument).
  channel::Channel& channel(const std::string& scheme);
  void add_channel(const std::string& scheme, std::shared_ptr<channel::Channel> channel);

  void attend(std::weak_ptr<Attended> endpoint);

 private:
  void make_status();
  void tell_tap(const Definition& definition) const;
  rr::Timer start_timer(std::chrono::nanoseconds delay, std::chrono::nanoseconds period,
                        std::function<void()> work);

  class Rounds;  // the timer of those that are attended

  const SenderClock clock_;
  FoundUrls found_urls_;
  std::shared_ptr<const NodeOptions> options_;
  std::shared_ptr<channel::Reactor> reactor_;
  std::shared_ptr<channel::Admission> accepted_;
  const channel::Pools pools_;
  const std::shared_ptr<channel::SlotBudget> slot_budget_;
  const std::shared_ptr<channel::SlotBudget> slot_threads_;
  std::shared_ptr<const channel::Tls> tls_;
  std::shared_ptr<channel::Status> status_;
  std::shared_ptr<channel::WebSockets> web_sockets_;
  mutable Mutex mutex_;
  std::set<std::shared_ptr<const Definition>> kept_definitions_
      RR_GUARDED_BY(mutex_);  // for types_
  std::shared_ptr<const TypeRegistry> types_ RR_GUARDED_BY(mutex_);
  std::unordered_set<std::uint32_t> endpoints_ RR_GUARDED_BY(mutex_);
  std::map<std::string, std::shared_ptr<channel::Channel>> channels_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<Rounds> rounds_;
};

}  // namespace rr::endpoint
