// SPDX-License-Identifier: Apache-2.0
#include <mosquitto.h>
#include <mqtt_protocol.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>

#include "gateway/matrix/probe_broker.hpp"

namespace rr::gateway::matrix {
namespace {

constexpr int keep_alive = 10;  // seconds, as the gateway has it
constexpr int qos = 1;
constexpr int loop_time_ms = 100;
constexpr std::chrono::seconds connect_time{30};
constexpr std::chrono::milliseconds reconnect_time{100};

void check(int result, const char* what) {
  if (result == MOSQ_ERR_SUCCESS) return;
  throw std::runtime_error(std::string(what) + ": " + mosquitto_strerror(result));
}

class MqttProbe final : public ProbeBroker {
 public:
  explicit MqttProbe(const ProbeOptions& options) {
    static const int initialized = mosquitto_lib_init();
    static_cast<void>(initialized);
    client_ = mosquitto_new(nullptr, true, this);
    if (client_ == nullptr) throw std::runtime_error("no client");
    mosquitto_int_option(client_, MOSQ_OPT_PROTOCOL_VERSION, MQTT_PROTOCOL_V5);
    mosquitto_int_option(client_, MOSQ_OPT_TCP_NODELAY, 1);
    if (!options.authority.empty()) {
      check(
          mosquitto_tls_set(client_, options.authority.c_str(), nullptr, nullptr, nullptr, nullptr),
          "TLS");
    }
    if (!options.user.empty()) {
      mosquitto_username_pw_set(client_, options.user.c_str(), options.password.c_str());
    }
    mosquitto_threaded_set(client_, true);
    mosquitto_connect_callback_set(client_, on_connect);
    mosquitto_disconnect_callback_set(client_, on_disconnect);
    mosquitto_subscribe_callback_set(client_, on_subscribe);
    mosquitto_message_callback_set(client_, on_message);
    const std::size_t scheme = options.url.find("://") + 3;
    const std::size_t colon = options.url.rfind(':');
    const std::string host = options.url.substr(scheme, colon - scheme);
    const int port = std::atoi(options.url.c_str() + colon + 1);
    check(mosquitto_connect(client_, host.c_str(), port, keep_alive), "connection");
    thread_ = std::thread([this] { run(); });
    wait_for(is_connected_);
  }
  ~MqttProbe() override {
    is_over_ = true;
    thread_.join();
    mosquitto_destroy(client_);
  }

  void publish(const std::string& topic, const std::string& payload) override {
    if (!is_connected_) return;
    mosquitto_publish(client_, nullptr, ("probe/" + topic).c_str(),
                      static_cast<int>(payload.size()), payload.data(), qos, true);
  }
  void subscribe(Taken taken) override {
    taken_ = std::move(taken);
    wants_all_ = true;
    mosquitto_subscribe(client_, nullptr, "probe/#", qos);
    wait_for(is_subscribed_);
  }

 private:
  static void wait_for(const std::atomic<bool>& state) {
    const auto end = std::chrono::steady_clock::now() + connect_time;
    while (!state) {
      if (std::chrono::steady_clock::now() > end) {
        throw std::runtime_error("the broker does not answer");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  /// The library's own loop ends when TLS fails, as it does when the broker is killed.
  void run() {
    while (!is_over_) {
      if (mosquitto_loop(client_, loop_time_ms, 1) == MOSQ_ERR_SUCCESS) continue;
      is_connected_ = false;
      std::this_thread::sleep_for(reconnect_time);
      mosquitto_reconnect(client_);
    }
  }
  static void on_connect(mosquitto* client, void* user, int code) {
    auto& self = *static_cast<MqttProbe*>(user);
    if (code != 0) return;
    self.is_connected_ = true;
    if (self.wants_all_) mosquitto_subscribe(client, nullptr, "probe/#", qos);
  }
  static void on_disconnect(mosquitto*, void* user, int) {
    static_cast<MqttProbe*>(user)->is_connected_ = false;
  }
  static void on_subscribe(mosquitto*, void* user, int, int, const int*) {
    static_cast<MqttProbe*>(user)->is_subscribed_ = true;
  }
  static void on_message(mosquitto*, void* user, const mosquitto_message* message) {
    static_cast<MqttProbe*>(user)->taken_(std::string(
        static_cast<const char*>(message->payload), static_cast<std::size_t>(message->payloadlen)));
  }

  mosquitto* client_ = nullptr;
  std::atomic<bool> is_connected_{false};
  std::atomic<bool> is_subscribed_{false};
  std::atomic<bool> wants_all_{false};
  std::atomic<bool> is_over_{false};
  Taken taken_;  // set before wants_all_
  std::thread thread_;
};

}  // namespace

std::unique_ptr<ProbeBroker> make_mqtt_probe(const ProbeOptions& options) {
  return std::make_unique<MqttProbe>(options);
}

}  // namespace rr::gateway::matrix
