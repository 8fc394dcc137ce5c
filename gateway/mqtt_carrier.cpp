// SPDX-License-Identifier: Apache-2.0
#include "gateway/mqtt_carrier.hpp"

#include <mosquitto.h>
#include <mqtt_protocol.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <thread>
#include <utility>

#include "gateway/mqtt_properties.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {
namespace {

constexpr int qos = 1;
constexpr int refused_from = 0x80;  // reason codes of MQTT 5
constexpr auto farewell_time = std::chrono::seconds(2);
constexpr int loop_time_ms = 100;

struct Place {
  std::string host;
  int port = 1883;
};

Place place_of(const std::string& url) {
  constexpr std::string_view scheme = "mqtt://";
  Place place;
  std::string_view rest = url;
  if (rest.starts_with(scheme)) {
    rest.remove_prefix(scheme.size());
    const std::size_t colon = rest.rfind(':');
    place.host = rest.substr(0, colon);
    if (colon == std::string_view::npos) {
      if (!place.host.empty()) return place;
    } else {
      const std::string_view port = rest.substr(colon + 1);
      const char* const end = port.data() + port.size();
      const auto result = std::from_chars(port.data(), end, place.port);
      const bool is_port =
          result.ec == std::errc() && result.ptr == end && place.port > 0 && place.port < 65'536;
      if (!place.host.empty() && is_port) return place;
    }
  }
  throw Error(ErrorCode::invalid_argument, "`" + url + "` is not of the form mqtt://host:port");
}

struct Destroyed {
  void operator()(mosquitto* client) const { mosquitto_destroy(client); }
};
using Client = std::unique_ptr<mosquitto, Destroyed>;

// Callbacks of the library never take mutex_, which publish() holds while it is in the library.
class MqttCarrier final : public Carrier {
 public:
  explicit MqttCarrier(MqttOptions options)
      : options_(std::move(options)), place_(place_of(options_.url)) {
    static const int initialized = mosquitto_lib_init();
    static_cast<void>(initialized);
  }
  ~MqttCarrier() override { stop({}); }

  void start(CarrierHandler& handler, Message life) override {
    handler_ = &handler;
    life_ = std::move(life);
    thread_ = std::thread([this] { run(); });
  }

  void stop(const Message& farewell) override {
    {
      const MutexLock lock(mutex_);
      farewell_ = farewell;
      ends_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  Published publish(const Message& message) override {
    const MutexLock lock(mutex_);
    if (!is_connected_ || ends_) return Published::later;
    if (waiting_ >= options_.in_flight) {
      wants_room_ = true;
      // It may have been acknowledged since.
      if (waiting_ >= options_.in_flight) return Published::later;
    }
    return send(message);
  }

  void subscribe(const std::string& filter) override {
    const MutexLock lock(mutex_);
    {
      const MutexLock filters_lock(filters_mutex_);
      if (std::ranges::find(filters_, filter) != filters_.end()) return;
      filters_.push_back(filter);
    }
    if (is_accepted_ && client_) mosquitto_subscribe(client_.get(), nullptr, filter.c_str(), qos);
  }

  [[nodiscard]] std::string url() const override { return options_.url; }

 private:
  Published send(const Message& message) {
    const MqttProperties properties(message);
    // Before it is acknowledged, which the other thread may see at once.
    ++waiting_;
    const int result = mosquitto_publish_v5(
        client_.get(), nullptr, message.topic.c_str(), static_cast<int>(message.payload.size()),
        message.payload.data(), qos, message.retained, properties.get());
    if (result == MOSQ_ERR_SUCCESS) return Published::taken;
    --waiting_;
    const bool is_large = result == MOSQ_ERR_PAYLOAD_SIZE || result == MOSQ_ERR_OVERSIZE_PACKET;
    return is_large ? Published::refused : Published::later;
  }

  void run() {
    auto delay = options_.retry;
    while (!ends_) {
      reason_ = "the broker does not answer";
      was_connected_ = false;
      converse();
      {
        const MutexLock lock(mutex_);
        is_connected_ = false;
        is_accepted_ = false;
        client_.reset();
        waiting_ = 0;
      }
      if (ends_) return;
      handler_->on_disconnected(options_.url + ": " + reason_);
      delay = was_connected_ ? options_.retry : std::min(delay * 2, options_.max_retry);
      const MutexLock lock(mutex_);
      changed_.wait_until(mutex_, std::chrono::steady_clock::now() + delay,
                          [this] { return ends_.load(); });
    }
  }

  /// One connection from its beginning to its end.
  void converse() {
    if (!make_client()) return;
    int result = mosquitto_connect_async(client_.get(), place_.host.c_str(), place_.port,
                                         static_cast<int>(options_.keep_alive.count()));
    while (result == MOSQ_ERR_SUCCESS && !ends_) {
      result = mosquitto_loop(client_.get(), loop_time_ms, 1);
    }
    if (result != MOSQ_ERR_SUCCESS && !is_refused_) reason_ = mosquitto_strerror(result);
    if (ends_ && is_connected_) say_farewell();
  }

  bool make_client() {
    Client client(mosquitto_new(nullptr, true, this));
    if (!client) return false;
    is_refused_ = false;
    mosquitto_int_option(client.get(), MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V5);
    mosquitto_int_option(client.get(), MOSQ_OPT_TCP_NODELAY, 1);
    mosquitto_threaded_set(client.get(), true);
    if (!options_.user.empty()) {
      mosquitto_username_pw_set(client.get(), options_.user.c_str(), options_.password.c_str());
    }
    mosquitto_will_set_v5(client.get(), life_.topic.c_str(), static_cast<int>(life_.payload.size()),
                          life_.payload.data(), qos, life_.retained, nullptr);
    mosquitto_connect_v5_callback_set(client.get(), on_connect);
    mosquitto_disconnect_v5_callback_set(client.get(), on_disconnect);
    mosquitto_subscribe_v5_callback_set(client.get(), on_subscribe);
    mosquitto_publish_v5_callback_set(client.get(), on_publish);
    mosquitto_message_v5_callback_set(client.get(), on_message);
    const MutexLock lock(mutex_);
    client_ = std::move(client);
    return true;
  }

  void say_farewell() {
    const std::size_t before = waiting_;
    if (!farewell_.topic.empty() && send(farewell_) == Published::taken) {
      const auto end = std::chrono::steady_clock::now() + farewell_time;
      while (waiting_ > before && std::chrono::steady_clock::now() < end) {
        if (mosquitto_loop(client_.get(), loop_time_ms, 1) != MOSQ_ERR_SUCCESS) return;
      }
    }
    mosquitto_disconnect(client_.get());
    mosquitto_loop(client_.get(), loop_time_ms, 1);
  }

  static void on_connect(mosquitto* client, void* user, int code, int, const mosquitto_property*) {
    auto& self = *static_cast<MqttCarrier*>(user);
    if (code != 0) {
      self.is_refused_ = true;
      self.reason_ = mosquitto_reason_string(code);
      return;
    }
    self.is_accepted_ = true;
    std::vector<std::string> filters;
    {
      const MutexLock lock(self.filters_mutex_);
      filters = self.filters_;
    }
    self.subscribing_ = static_cast<int>(filters.size());
    for (const std::string& filter : filters) {
      mosquitto_subscribe(client, nullptr, filter.c_str(), qos);
    }
    if (filters.empty()) self.become_connected();
  }

  void become_connected() {
    was_connected_ = true;
    is_connected_ = true;
    handler_->on_connected();
  }

  static void on_subscribe(mosquitto*, void* user, int, int count, const int* granted,
                           const mosquitto_property*) {
    auto& self = *static_cast<MqttCarrier*>(user);
    if (std::any_of(granted, granted + count, [](int code) { return code >= refused_from; })) {
      self.handler_->on_refused("a subscription");
    }
    if (self.subscribing_ > 0 && --self.subscribing_ == 0) self.become_connected();
  }

  static void on_publish(mosquitto*, void* user, int, int code, const mosquitto_property*) {
    auto& self = *static_cast<MqttCarrier*>(user);
    if (code >= refused_from) {
      self.handler_->on_refused(std::string("a message: ") + mosquitto_reason_string(code));
    }
    const std::size_t left = --self.waiting_;
    if (left <= self.options_.in_flight / 2 && self.wants_room_.exchange(false)) {
      self.handler_->on_room();
    }
  }

  static void on_disconnect(mosquitto*, void* user, int code, const mosquitto_property*) {
    auto& self = *static_cast<MqttCarrier*>(user);
    self.is_connected_ = false;
    if (code >= refused_from) {
      self.is_refused_ = true;
      self.reason_ = mosquitto_reason_string(code);
    }
  }

  static void on_message(mosquitto*, void* user, const mosquitto_message* message,
                         const mosquitto_property* properties) {
    auto& self = *static_cast<MqttCarrier*>(user);
    Message result;
    result.topic = message->topic;
    result.retained = message->retain;
    const auto* const bytes = static_cast<const std::byte*>(message->payload);
    result.payload.assign(bytes, bytes + message->payloadlen);
    read_properties(properties, result);
    self.handler_->on_message(std::move(result));
  }

  const MqttOptions options_;
  const Place place_;
  CarrierHandler* handler_ = nullptr;
  Message life_;
  Message farewell_;  // written before ends_ is set, read after
  Mutex mutex_ RR_ACQUIRED_BEFORE(filters_mutex_);
  Condition changed_;
  std::atomic<bool> ends_{false};
  Client client_;  // written by the carrier's thread, with mutex_; others read it with mutex_
  std::atomic<bool> is_accepted_{false};   // by the broker
  std::atomic<bool> is_connected_{false};  // and it knows the subscriptions
  std::atomic<bool> wants_room_{false};
  std::atomic<std::size_t> waiting_{0};  // messages that are not acknowledged
  Mutex filters_mutex_;
  std::vector<std::string> filters_ RR_GUARDED_BY(filters_mutex_);
  // Of the carrier's thread.
  std::string reason_;
  bool is_refused_ = false;
  bool was_connected_ = false;
  int subscribing_ = 0;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<Carrier> make_mqtt_carrier(MqttOptions options) {
  return std::make_unique<MqttCarrier>(std::move(options));
}

}  // namespace rr::gateway
