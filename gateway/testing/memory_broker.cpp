// SPDX-License-Identifier: Apache-2.0
#include "gateway/testing/memory_broker.hpp"

#include <algorithm>
#include <utility>

#include "gateway/topics.hpp"

namespace rr::gateway::testing {

namespace {

const std::set<Traffic> all_traffic{Traffic::messages, Traffic::values};

}  // namespace

struct MemoryBroker::Client {
  Traffic traffic = Traffic::messages;
  CarrierHandler* handler = nullptr;
  Message life;
  std::vector<std::string> filters;
  bool is_connected = false;
  bool is_ending = false;  // the handler does not know yet that the connection has ended
  bool is_stopped = false;
  bool is_called = false;   // its handler runs now
  bool wants_room = false;  // a message was not taken
};

class MemoryBroker::MemoryCarrier final : public Carrier {
 public:
  MemoryCarrier(MemoryBroker& broker, Traffic traffic) : broker_(broker) {
    client_->traffic = traffic;
  }
  ~MemoryCarrier() override { stop({}); }

  void start(CarrierHandler& handler, Message life) override {
    const std::scoped_lock lock(broker_.mutex_);
    client_->handler = &handler;
    client_->life = std::move(life);
    broker_.clients_.push_back(client_);
    broker_.changed_.notify_all();
  }

  void stop(const Message& farewell) override {
    std::unique_lock lock(broker_.mutex_);
    if (std::exchange(client_->is_stopped, true)) return;
    if (client_->is_connected && !farewell.topic.empty()) broker_.route(farewell);
    std::erase(broker_.clients_, client_);
    broker_.changed_.wait(lock, [&] { return !client_->is_called; });
  }

  Published publish(const Message& message) override {
    const std::scoped_lock lock(broker_.mutex_);
    if (!client_->is_connected) return Published::later;
    if (broker_.held_.contains(client_->traffic)) {
      client_->wants_room = true;
      return Published::later;
    }
    if (message.payload.size() > broker_.faults_.largest) return Published::refused;
    if (!broker_.happens(broker_.faults_.dropped)) broker_.route(message);
    return Published::taken;
  }

  void subscribe(const std::string& filter) override {
    const std::scoped_lock lock(broker_.mutex_);
    if (std::ranges::find(client_->filters, filter) == client_->filters.end()) {
      client_->filters.push_back(filter);
    }
    if (!client_->is_connected) return;
    for (const auto& [topic, message] : broker_.retained_) {
      if (topic_matches(filter, topic)) broker_.enqueue(client_, message);
    }
  }

  [[nodiscard]] std::string url() const override { return "memory"; }

 private:
  MemoryBroker& broker_;
  std::shared_ptr<Client> client_ = std::make_shared<Client>();
};

MemoryBroker::MemoryBroker(std::uint32_t seed) : random_(seed), thread_([this] { run(); }) {}

MemoryBroker::~MemoryBroker() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

std::unique_ptr<Carrier> MemoryBroker::carrier(Traffic traffic) {
  return std::make_unique<MemoryCarrier>(*this, traffic);
}

void MemoryBroker::set_faults(const Faults& faults) {
  const std::scoped_lock lock(mutex_);
  faults_ = faults;
}

void MemoryBroker::crash() {
  std::unique_lock lock(mutex_);
  is_up_ = false;
  retained_.clear();
  disconnect(lock, all_traffic, false);
}

void MemoryBroker::restart() {
  const std::scoped_lock lock(mutex_);
  is_up_ = true;
  changed_.notify_all();
}

void MemoryBroker::cut() {
  std::unique_lock lock(mutex_);
  disconnect(lock, all_traffic, true);
}

void MemoryBroker::set_links(bool are_up) {
  std::unique_lock lock(mutex_);
  down_ = are_up ? std::set<Traffic>() : all_traffic;
  changed_.notify_all();
  if (!are_up) disconnect(lock, all_traffic, true);
}

void MemoryBroker::set_links(Traffic traffic, bool are_up) {
  std::unique_lock lock(mutex_);
  if (are_up) {
    down_.erase(traffic);
  } else {
    down_.insert(traffic);
  }
  changed_.notify_all();
  if (!are_up) disconnect(lock, {traffic}, true);
}

void MemoryBroker::hold(Traffic traffic, bool is_held) {
  std::unique_lock lock(mutex_);
  if (is_held) {
    held_.insert(traffic);
    return;
  }
  held_.erase(traffic);
  release(lock);
}

void MemoryBroker::release(std::unique_lock<std::mutex>& lock) {
  for (Delivery& delivery : std::exchange(kept_, {})) queue_.emplace(Clock::now(), delivery);
  changed_.notify_all();
  const auto clients = clients_;
  for (const auto& client : clients) {
    if (held_.contains(client->traffic) || !std::exchange(client->wants_room, false)) continue;
    call(lock, *client, [](CarrierHandler& handler) { handler.on_room(); });
  }
}

/// Without the lock, and one call of a client at a time.
void MemoryBroker::call(std::unique_lock<std::mutex>& lock, Client& client,
                        const Function<void(CarrierHandler&)>& function) {
  changed_.wait(lock, [&] { return !client.is_called; });
  if (client.is_stopped) return;
  client.is_called = true;
  lock.unlock();
  function(*client.handler);
  lock.lock();
  client.is_called = false;
  changed_.notify_all();
}

void MemoryBroker::disconnect(std::unique_lock<std::mutex>& lock, const std::set<Traffic>& traffic,
                              bool publishes_life) {
  const auto is_lost = [&](const Delivery& delivery) {
    return traffic.contains(delivery.client->traffic);
  };
  std::erase_if(queue_, [&](const auto& due) { return is_lost(due.second); });
  std::erase_if(kept_, is_lost);
  const auto clients = clients_;
  for (const auto& client : clients) {
    if (!traffic.contains(client->traffic) || !std::exchange(client->is_connected, false)) continue;
    client->is_ending = true;
    if (publishes_life) route(client->life);
    call(lock, *client, [](CarrierHandler& handler) {
      handler.on_disconnected("the test has ended the connection");
    });
    client->is_ending = false;
  }
}

std::optional<Message> MemoryBroker::retained(const std::string& topic) const {
  const std::scoped_lock lock(mutex_);
  const auto found = retained_.find(topic);
  return found == retained_.end() ? std::nullopt : std::optional(found->second);
}

std::size_t MemoryBroker::published(const std::string& filter) const {
  const std::scoped_lock lock(mutex_);
  std::size_t count = 0;
  for (const auto& [topic, times] : counts_) count += topic_matches(filter, topic) ? times : 0;
  return count;
}

bool MemoryBroker::happens(double share) {
  return std::uniform_real_distribution<double>(0, 1)(random_) < share;
}

void MemoryBroker::route(const Message& message) {
  if (!is_up_ || message.topic.empty()) return;
  ++counts_[message.topic];
  if (message.retained) retained_[message.topic] = message;
  Message live = message;
  live.retained = false;
  for (const auto& client : clients_) {
    const bool fits = std::ranges::any_of(client->filters, [&](const std::string& filter) {
      return topic_matches(filter, message.topic);
    });
    if (!fits || !client->is_connected) continue;
    enqueue(client, live);
    if (happens(faults_.twice)) enqueue(client, live);
  }
}

void MemoryBroker::enqueue(const std::shared_ptr<Client>& client, Message message) {
  const auto longest = static_cast<int>(faults_.delay.count());
  const std::chrono::milliseconds delay(std::uniform_int_distribution<int>(0, longest)(random_));
  queue_.emplace(Clock::now() + delay, Delivery{client, std::move(message)});
  changed_.notify_all();
}

void MemoryBroker::connect_all(std::unique_lock<std::mutex>& lock) {
  const auto clients = clients_;
  for (const auto& client : clients) {
    const bool is_down = !is_up_ || down_.contains(client->traffic);
    if (is_down || client->is_connected || client->is_ending || client->is_stopped ||
        client->is_called)
      continue;
    client->is_connected = true;
    for (const auto& [topic, message] : retained_) {
      for (const std::string& filter : client->filters) {
        if (topic_matches(filter, topic)) enqueue(client, message);
      }
    }
    call(lock, *client, [](CarrierHandler& handler) { handler.on_connected(); });
  }
}

void MemoryBroker::deliver(std::unique_lock<std::mutex>& lock) {
  auto delivery = std::move(queue_.extract(queue_.begin()).mapped());
  Client& client = *delivery.client;
  if (!client.is_connected || client.is_stopped) return;
  if (held_.contains(client.traffic)) {
    kept_.push_back(std::move(delivery));
    return;
  }
  changed_.wait(lock, [&] { return !client.is_called; });
  if (!client.is_connected) return;
  call(lock, client,
       [&](CarrierHandler& handler) { handler.on_message(std::move(delivery.message)); });
}

void MemoryBroker::run() {
  std::unique_lock lock(mutex_);
  while (!ends_) {
    connect_all(lock);
    if (queue_.empty()) {
      changed_.wait_for(lock, std::chrono::milliseconds(10));
    } else if (queue_.begin()->first <= Clock::now()) {
      deliver(lock);
    } else {
      // A copy: the queue may be cleared meanwhile.
      const auto due = queue_.begin()->first;
      changed_.wait_until(lock, due);
    }
  }
}

}  // namespace rr::gateway::testing
