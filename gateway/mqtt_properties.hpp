// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mosquitto.h>
#include <mqtt_protocol.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "gateway/carrier.hpp"

namespace rr::gateway {

/// What a message has besides its topic and payload, as the library wants it.
class MqttProperties {
 public:
  explicit MqttProperties(const Message& message) {
    for (const auto& [name, value] : message.properties) {
      mosquitto_property_add_string_pair(&list_, MQTT_PROP_USER_PROPERTY, name.c_str(),
                                         carried(value).c_str());
    }
    if (!message.response_topic.empty()) {
      mosquitto_property_add_string(&list_, MQTT_PROP_RESPONSE_TOPIC,
                                    message.response_topic.c_str());
    }
    if (!message.correlation.empty()) {
      mosquitto_property_add_binary(&list_, MQTT_PROP_CORRELATION_DATA, message.correlation.data(),
                                    static_cast<std::uint16_t>(message.correlation.size()));
    }
    if (message.expiry) {
      mosquitto_property_add_int32(&list_, MQTT_PROP_MESSAGE_EXPIRY_INTERVAL,
                                   static_cast<std::uint32_t>(message.expiry->count()));
    }
  }
  ~MqttProperties() { mosquitto_property_free_all(&list_); }
  MqttProperties(const MqttProperties&) = delete;
  MqttProperties& operator=(const MqttProperties&) = delete;

  [[nodiscard]] mosquitto_property* get() const { return list_; }
  /// They belong to another one now.
  void release() { list_ = nullptr; }

 private:
  /// Texts of MQTT are UTF-8 without zeros, and of limited length; those of errors need not be.
  static std::string carried(std::string text) {
    constexpr std::size_t longest = 16'000;
    if (text.size() > longest) text.resize(longest);
    if (mosquitto_validate_utf8(text.data(), static_cast<int>(text.size())) != MOSQ_ERR_SUCCESS) {
      std::ranges::replace_if(
          text, [](char c) { return c < ' ' || c > '~'; }, '?');
    }
    return text;
  }

  mosquitto_property* list_ = nullptr;
};

/// The reverse.
inline void read_properties(const mosquitto_property* list, Message& message) {
  char* name = nullptr;
  char* value = nullptr;
  const mosquitto_property* at =
      mosquitto_property_read_string_pair(list, MQTT_PROP_USER_PROPERTY, &name, &value, false);
  while (at != nullptr) {
    message.properties.emplace_back(name, value);
    std::free(name);
    std::free(value);
    at = mosquitto_property_read_string_pair(at, MQTT_PROP_USER_PROPERTY, &name, &value, true);
  }
  if (mosquitto_property_read_string(list, MQTT_PROP_RESPONSE_TOPIC, &value, false) != nullptr) {
    message.response_topic = value;
    std::free(value);
  }
  void* data = nullptr;
  std::uint16_t size = 0;
  if (mosquitto_property_read_binary(list, MQTT_PROP_CORRELATION_DATA, &data, &size, false) !=
      nullptr) {
    const auto* const bytes = static_cast<const std::byte*>(data);
    message.correlation.assign(bytes, bytes + size);
    std::free(data);
  }
}

}  // namespace rr::gateway
