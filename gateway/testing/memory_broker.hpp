// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "gateway/carrier.hpp"
#include "rr/function.hpp"

/// A broker in memory, for tests: it delays, drops, delivers twice and disconnects as it is told.
namespace rr::gateway::testing {

/// Shares of messages, 0 to 1, the longest delay, and the largest payload in bytes.
struct Faults {
  double dropped = 0;
  double twice = 0;
  std::chrono::milliseconds delay{0};
  std::size_t largest = std::size_t{1} << 30U;
};

/// What a connection is for.
enum class Traffic {
  messages,
  values,
};

/// Outlives its carriers.
class MemoryBroker {
 public:
  explicit MemoryBroker(std::uint32_t seed = 1);
  ~MemoryBroker();
  MemoryBroker(const MemoryBroker&) = delete;
  MemoryBroker& operator=(const MemoryBroker&) = delete;

  /// A carrier to this broker that is not started.
  std::unique_ptr<Carrier> carrier(Traffic traffic = Traffic::messages);
  /// Both of a gateway.
  Carriers carriers() { return {carrier(Traffic::messages), carrier(Traffic::values)}; }
  /// From now on.
  void set_faults(const Faults& faults);
  /// Loses all messages under way and all retained ones, and ends all connections. Their lives are
  /// not published: the broker that would is down.
  void crash();
  /// Takes connections again.
  void restart();
  /// Ends all connections as if their links had failed.
  void cut();
  /// cut(), and no connection is made until links are up again.
  void set_links(bool are_up);
  /// The same of the connections for one traffic.
  void set_links(Traffic traffic, bool are_up);
  /// Connections for the traffic carry nothing until they are released, and are not lost by that.
  void hold(Traffic traffic, bool is_held);
  /// What is retained at a topic.
  [[nodiscard]] std::optional<Message> retained(const std::string& topic) const;
  /// Messages that were published to topics that fit the filter.
  [[nodiscard]] std::size_t published(const std::string& filter) const;

 private:
  class MemoryCarrier;
  struct Client;
  using Clock = std::chrono::steady_clock;
  struct Delivery {
    std::shared_ptr<Client> client;
    Message message;
  };

  void run();
  void connect_all(std::unique_lock<std::mutex>& lock);
  void deliver(std::unique_lock<std::mutex>& lock);
  void release(std::unique_lock<std::mutex>& lock);
  void disconnect(std::unique_lock<std::mutex>& lock, const std::set<Traffic>& traffic,
                  bool publishes_life);
  void call(std::unique_lock<std::mutex>& lock, Client& client,
            const Function<void(CarrierHandler&)>& function);
  void route(const Message& message);
  void enqueue(const std::shared_ptr<Client>& client, Message message);
  bool happens(double share);

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::mt19937 random_;
  Faults faults_;
  bool is_up_ = true;
  std::set<Traffic> down_;  // no connections are made
  std::set<Traffic> held_;
  bool ends_ = false;
  std::vector<std::shared_ptr<Client>> clients_;
  std::map<std::string, Message> retained_;
  std::map<std::string, std::size_t> counts_;
  std::multimap<Clock::time_point, Delivery> queue_;
  std::vector<Delivery> kept_;  // for connections that are held
  std::thread thread_;
};

}  // namespace rr::gateway::testing
