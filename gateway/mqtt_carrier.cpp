// SPDX-License-Identifier: Apache-2.0
#include "gateway/mqtt_carrier.hpp"

#include <mosquitto.h>
#include <mqtt_protocol.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <map>
#include <thread>
#include <utility>

#include "gateway/broker_tls.hpp"
#include "gateway/mqtt_properties.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"

namespace rr::gateway {
namespace {

constexpr int qos = 1;
constexpr int refused_from = 0x80;  // reason codes of MQTT 5
constexpr auto farewell_time = std::chrono::seconds(2);
constexpr int loop_time_ms = 100;

constexpr const char* ended_while_tls_began =
    "the broker has ended the connection while TLS began: perhaps it speaks no TLS, or wants a "
    "certificate";
constexpr std::array<BrokerScheme, 2> schemes{{{"mqtt", false, 1883}, {"mqtts", true, 8883}}};

bool is_about_user(int code) {
  return code == MQTT_RC_BAD_USERNAME_OR_PASSWORD || code == MQTT_RC_NOT_AUTHORIZED;
}

struct Destroyed {
  void operator()(mosquitto* client) const { mosquitto_destroy(client); }
};
using Client = std::unique_ptr<mosquitto, Destroyed>;

// Callbacks of the library never take mutex_, which publish() holds while it is in the library.
class MqttCarrier final : public Carrier {
 public:
  MqttCarrier(BrokerOptions broker, const MqttLimits& limits)
      : broker_(std::move(broker)), limits_(limits), place_(place_of(broker_, schemes)) {
    static const int initialized = mosquitto_lib_init();
    static_cast<void>(initialized);
    // A file that cannot be used is reported at once.
    if (place_.is_encrypted) tls_ = std::make_unique<BrokerTls>(broker_, place_.host);
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
      // Ends the library's wait for the broker. Before a farewell the connection is still needed.
      if (farewell.topic.empty() && is_connected_ && client_) mosquitto_disconnect(client_.get());
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }

  Published publish(const Message& message) override {
    const MutexLock lock(mutex_);
    if (!is_connected_ || ends_) return Published::later;
    if (is_full(size_of(message))) {
      wants_room_ = true;
      // It may have been acknowledged since.
      if (is_full(size_of(message))) return Published::later;
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

  [[nodiscard]] std::string url() const override { return broker_.url; }

 private:
  /// A message that the broker has not acknowledged.
  struct Flight {
    std::string topic;
    std::size_t size = 0;
  };

  static std::size_t size_of(const Message& message) {
    return message.topic.size() + message.payload.size();
  }
  [[nodiscard]] bool is_full(std::size_t size) const {
    const std::size_t count = waiting_;
    return count >= limits_.in_flight || (count > 0 && bytes_ + size > limits_.in_flight_bytes);
  }

  Published send(const Message& message) {
    const std::size_t size = size_of(message);
    const MqttProperties properties(message);
    // Before it is acknowledged, which the other thread may see at once.
    ++waiting_;
    bytes_ += size;
    int id = 0;
    int result = 0;
    {
      // The acknowledgement waits until the topic is known. The library calls back with no lock
      // that publishing takes.
      const MutexLock lock(flight_mutex_);
      result = mosquitto_publish_v5(
          client_.get(), &id, message.topic.c_str(), static_cast<int>(message.payload.size()),
          message.payload.data(), qos, message.retained, properties.get());
      if (result == MOSQ_ERR_SUCCESS) flight_[id] = {message.topic, size};
    }
    if (result == MOSQ_ERR_SUCCESS) return Published::taken;
    --waiting_;
    bytes_ -= size;
    const bool is_large = result == MOSQ_ERR_PAYLOAD_SIZE || result == MOSQ_ERR_OVERSIZE_PACKET;
    return is_large ? Published::refused : Published::later;
  }

  void run() {
    auto delay = limits_.retry;
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
        bytes_ = 0;
        const MutexLock flight_lock(flight_mutex_);
        flight_.clear();
      }
      if (ends_) return;
      handler_->on_disconnected(broker_.url + ": " + reason_);
      delay = was_connected_ ? limits_.retry : std::min(delay * 2, limits_.max_retry);
      const MutexLock lock(mutex_);
      changed_.wait_until(mutex_, std::chrono::steady_clock::now() + delay,
                          [this] { return ends_.load(); });
    }
  }

  /// One connection from its beginning to its end.
  void converse() {
    if (!make_client()) return;
    int result = mosquitto_connect_async(client_.get(), place_.host.c_str(), place_.port,
                                         static_cast<int>(limits_.keep_alive.count()));
    if (result == MOSQ_ERR_SUCCESS && !reach_broker()) return;
    while (result == MOSQ_ERR_SUCCESS && !ends_) {
      result = mosquitto_loop(client_.get(), loop_time_ms, 1);
    }
    if (result != MOSQ_ERR_SUCCESS && !is_refused_) reason_ = reason_of(result);
    if (ends_ && is_connected_) say_farewell();
  }

  /// Until TCP is connected: with TLS the library would not notice that it cannot be.
  bool reach_broker() {
    const auto end = std::chrono::steady_clock::now() + limits_.keep_alive;
    while (!ends_ && std::chrono::steady_clock::now() < end) {
      pollfd wanted{mosquitto_socket(client_.get()), POLLOUT, 0};
      if (::poll(&wanted, 1, loop_time_ms) <= 0) continue;
      int error = 0;
      socklen_t size = sizeof error;
      ::getsockopt(wanted.fd, SOL_SOCKET, SO_ERROR, &error, &size);
      // TLS may have taken the error already.
      sockaddr_storage peer{};
      size = sizeof peer;
      if (error == 0 && ::getpeername(wanted.fd, reinterpret_cast<sockaddr*>(&peer), &size) == 0) {
        return true;
      }
      // A broker without TLS may end the connection before it is looked at.
      const bool is_reset = error == ECONNRESET && place_.is_encrypted;
      if (is_reset) {
        reason_ = ended_while_tls_began;
      } else {
        reason_ = error != 0 ? std::strerror(error) : "no server at its port, or it speaks no TLS";
      }
      return false;
    }
    return false;
  }

  [[nodiscard]] std::string reason_of(int result) const {
    if (tls_ && !tls_->trouble().empty()) return tls_->trouble();
    if (!tls_reason_.empty()) return tls_reason_;
    if (result == MOSQ_ERR_TLS && !is_accepted_) {
      return ended_while_tls_began;
    }
    return mosquitto_strerror(result);
  }

  bool make_client() {
    Client client(mosquitto_new(nullptr, true, this));
    if (!client || !prepare_tls(client.get())) return false;
    is_refused_ = false;
    mosquitto_int_option(client.get(), MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V5);
    mosquitto_int_option(client.get(), MOSQ_OPT_TCP_NODELAY, 1);
    mosquitto_int_option(client.get(), MOSQ_OPT_RECEIVE_MAXIMUM, limits_.receive);
    mosquitto_threaded_set(client.get(), true);
    if (!broker_.user.empty()) {
      mosquitto_username_pw_set(client.get(), broker_.user.c_str(), broker_.password.c_str());
    }
    if (!life_.topic.empty()) set_life(client.get());
    mosquitto_connect_v5_callback_set(client.get(), on_connect);
    mosquitto_disconnect_v5_callback_set(client.get(), on_disconnect);
    mosquitto_subscribe_v5_callback_set(client.get(), on_subscribe);
    mosquitto_publish_v5_callback_set(client.get(), on_publish);
    mosquitto_message_v5_callback_set(client.get(), on_message);
    const MutexLock lock(mutex_);
    client_ = std::move(client);
    return true;
  }

  void set_life(mosquitto* client) const {
    MqttProperties properties(life_);
    const int result =
        mosquitto_will_set_v5(client, life_.topic.c_str(), static_cast<int>(life_.payload.size()),
                              life_.payload.data(), qos, life_.retained, properties.get());
    if (result == MOSQ_ERR_SUCCESS) properties.release();  // the library has taken them over
  }

  /// Anew for each connection: certificates run out, and are replaced while this runs.
  bool prepare_tls(mosquitto* client) {
    tls_reason_.clear();
    if (!place_.is_encrypted) return true;
    try {
      tls_ = std::make_unique<BrokerTls>(broker_, place_.host);
    } catch (const Error& error) {
      reason_ = error.message();
      return false;
    }
    // The context as it is: the library would replace the check of certificates by its own.
    mosquitto_int_option(client, MOSQ_OPT_SSL_CTX_WITH_DEFAULTS, 0);
    mosquitto_void_option(client, MOSQ_OPT_SSL_CTX, tls_->context());
    mosquitto_log_callback_set(client, on_log);
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
      self.reason_ = self.refusal(code);
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

  [[nodiscard]] std::string refusal(int code) const {
    const std::string reason = mosquitto_reason_string(code);
    if (!is_about_user(code)) return "the broker refuses the connection: " + reason;
    if (broker_.user.empty()) return "the broker refuses a connection without a user: " + reason;
    return "the broker refuses user `" + broker_.user + "` or the password: " + reason;
  }

  static void on_log(mosquitto*, void* user, int level, const char* text) {
    auto& self = *static_cast<MqttCarrier*>(user);
    if (level == MOSQ_LOG_ERR && self.tls_reason_.empty()) self.tls_reason_ = tls_reason(text);
  }

  void become_connected() {
    was_connected_ = true;
    is_connected_ = true;
    handler_->on_connected();
  }

  static void on_subscribe(mosquitto*, void* user, int, int count, const int* granted,
                           const mosquitto_property*) {
    auto& self = *static_cast<MqttCarrier*>(user);
    const int* const end = granted + count;
    const int* const refused =
        std::find_if(granted, end, [](int code) { return code >= refused_from; });
    if (refused != end) self.handler_->on_refused({"", mosquitto_reason_string(*refused)});
    if (self.subscribing_ > 0 && --self.subscribing_ == 0) self.become_connected();
  }

  /// The message that is acknowledged.
  Flight take_flight(int id) {
    const MutexLock lock(flight_mutex_);
    const auto node = flight_.extract(id);
    return node.empty() ? Flight() : node.mapped();
  }

  static void on_publish(mosquitto*, void* user, int id, int code, const mosquitto_property*) {
    auto& self = *static_cast<MqttCarrier*>(user);
    const Flight flight = self.take_flight(id);
    if (code >= refused_from) {
      self.handler_->on_refused({flight.topic, mosquitto_reason_string(code)});
    }
    self.bytes_ -= flight.size;
    const std::size_t left = --self.waiting_;
    if (left <= self.limits_.in_flight / 2 && self.wants_room_.exchange(false)) {
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

  const BrokerOptions broker_;
  const MqttLimits limits_;
  const BrokerPlace place_;
  CarrierHandler* handler_ = nullptr;
  Message life_;
  Message farewell_;  // written before ends_ is set, read after
  Mutex mutex_ RR_ACQUIRED_BEFORE(filters_mutex_);
  Condition changed_;
  std::atomic<bool> ends_{false};
  std::unique_ptr<BrokerTls> tls_;  // of the carrier's thread; outlives the client
  Client client_;  // written by the carrier's thread, with mutex_; others read it with mutex_
  std::atomic<bool> is_accepted_{false};   // by the broker
  std::atomic<bool> is_connected_{false};  // and it knows the subscriptions
  std::atomic<bool> wants_room_{false};
  std::atomic<std::size_t> waiting_{0};  // messages that are not acknowledged
  std::atomic<std::size_t> bytes_{0};    // of these
  Mutex flight_mutex_;
  // Messages that are not acknowledged, by their ids.
  std::map<int, Flight> flight_ RR_GUARDED_BY(flight_mutex_);
  Mutex filters_mutex_;
  std::vector<std::string> filters_ RR_GUARDED_BY(filters_mutex_);
  // Of the carrier's thread.
  std::string reason_;
  std::string tls_reason_;
  bool is_refused_ = false;
  bool was_connected_ = false;
  int subscribing_ = 0;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<Carrier> make_mqtt_carrier(BrokerOptions broker, const MqttLimits& limits) {
  return std::make_unique<MqttCarrier>(std::move(broker), limits);
}

}  // namespace rr::gateway
