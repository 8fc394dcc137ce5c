// SPDX-License-Identifier: Apache-2.0
#include "gateway/server.hpp"

#include <algorithm>
#include <future>
#include <set>
#include <utility>

#include "gateway/far_service.hpp"
#include "gateway/value_handler.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::chrono::milliseconds server_tick{50};

void check_level(const std::string& name) {
  if (is_level_name(name)) return;
  throw Error(ErrorCode::invalid_argument,
              "`" + name + "` is no name: 1 to 64 letters, digits, `_` or `-`");
}

}  // namespace

class Server::Core final : public CarrierHandler {
 public:
  Core(ServerOptions options, Node& node, const Carriers& carriers, Log log)
      : carrier_(*carriers.messages),
        values_(*carriers.values),
        log_(std::move(log)),
        worker_(std::make_shared<Worker>(server_tick, [this] { tick(); })),
        // The broker has the newest values for each new connection.
        value_handler_(*worker_, values_, log_,
                       {.message = [this](const Message& message) { take_value(message); },
                        .connected = [] {},
                        .disconnected = [] {},
                        .room = [] {}}) {
    if (options.user.empty()) options.user = options.reader;
    check_level(options.reader);
    check_level(options.user);
    calls_ = std::make_shared<FarCalls>(
        worker_, outbox_, FarCalls::Options{options.user, options.limit, options.repeat},
        [this] { pump(); });
    const FarStream::Reader reader{options.user, options.reader, calls_->reply_topic()};
    for (const ServedService& service : options.services) {
      check_level(service.address.site);
      check_level(service.address.node);
      check_level(service.address.service);
      services_.push_back(std::make_shared<FarService>(
          service, FarService::Shared{node, *worker_, outbox_, carrier_, values_, calls_, reader,
                                      log_, [this] { pump(); }, options.session_alive}));
    }
    life_.topic = calls_->reply_topic();
  }

  void start() {
    carrier_.subscribe(calls_->reply_topic());
    for (const auto& service : services_) service->start();
    worker_->start();
    carrier_.start(*this, life_);
    values_.start(value_handler_, {});
  }

  void stop() {
    end_sessions();
    const auto values_ended = std::async(std::launch::async, [this] { values_.stop({}); });
    carrier_.stop({});
    values_ended.wait();
    worker_->stop();
    calls_->abort();
    for (const auto& service : services_) service->close();
  }

  void on_message(Message message) override {
    if (!worker_->has_room()) return;
    worker_->post([this, message = std::move(message)] { take(message); });
  }
  void on_connected() override {
    worker_->post([this] {
      is_connected_ = true;
      reason_.clear();
      log_(LogLevel::info, "connected to " + carrier_.url());
      calls_->set_connected(true);
      for (const auto& service : services_) service->reconnected();
      tick();
    });
  }
  void on_disconnected(const std::string& reason) override {
    worker_->post([this, reason] {
      is_connected_ = false;
      refusals_.clear();
      calls_->set_connected(false);
      outbox_.clear();
      if (std::exchange(reason_, reason) != reason) log_(LogLevel::warning, reason);
    });
  }
  void on_room() override {
    worker_->post([this] { pump(); });
  }
  void on_refused(const Refusal& refusal) override {
    worker_->post([this, refusal] {
      if (refusals_.insert(refusal.topic).second) log_(LogLevel::error, refusal.text());
      calls_->deny(refusal);
    });
  }

 private:
  /// As far as the carrier takes the requests now. The robot's gateway ends the others by its
  /// limit.
  void end_sessions() {
    std::promise<void> done;
    worker_->post([&] {
      for (const auto& service : services_) service->end_sessions();
      // Requests are posted as well: this comes after them.
      worker_->post([&] {
        pump();
        done.set_value();
      });
    });
    done.get_future().wait();
  }

  void take(const Message& message) {
    bool is_taken = false;
    for (const auto& service : services_) is_taken = service->take(message) || is_taken;
    if (!is_taken && message.topic == calls_->reply_topic()) calls_->take(message);
    pump();
  }

  void take_value(const Message& message) {
    for (const auto& service : services_) service->take_value(message);
  }

  void pump() {
    if (!is_connected_) return;
    outbox_.pump(carrier_, [this](const Message& message) { calls_->refuse(message); });
  }

  /// Where a request that was not answered has probably failed.
  std::string where(const ServiceAddress& address) const {
    if (!is_connected_) return "no connection to the broker: " + reason_;
    const auto service = std::ranges::find(
        services_, address, [](const auto& each) -> const auto& { return each->address(); });
    return service == services_.end() ? std::string() : (*service)->trouble();
  }

  void tick() {
    if (is_connected_) {
      for (const auto& service : services_) service->tick();
    }
    calls_->tick([this](const ServiceAddress& address) { return where(address); });
    pump();
  }

  Carrier& carrier_;  // for messages
  Carrier& values_;
  Log log_;
  Outbox outbox_;
  const std::shared_ptr<Worker> worker_;
  ValueHandler value_handler_;
  std::shared_ptr<FarCalls> calls_;
  std::vector<std::shared_ptr<FarService>> services_;
  Message life_;
  bool is_connected_ = false;
  std::set<std::string> refusals_;  // topics that were reported for this connection
  std::string reason_ = "not connected yet";
};

Server::Server(ServerOptions options, Node& node, const Carriers& carriers, Log log)
    : core_(std::make_unique<Core>(std::move(options), node, carriers, std::move(log))) {
  core_->start();
}

Server::~Server() { core_->stop(); }

}  // namespace rr::gateway
