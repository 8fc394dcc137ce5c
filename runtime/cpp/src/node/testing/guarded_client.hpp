// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/time_spec.hpp"
#include "rr/type.hpp"
#include "rr/varvalue.hpp"
#include "runtime/cpp/src/endpoint/pipe_packets.hpp"
#include "runtime/cpp/src/node/testing/guarded.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"

namespace rr::testing {

constexpr std::uint16_t code(ErrorCode error) { return static_cast<std::uint16_t>(error); }

inline constexpr std::uint16_t refused = code(ErrorCode::authentication_error);

template <class T>
RawClient::Elements element(std::string name, T value) {
  return [name = std::move(name), value = std::move(value)](Writer& writer) {
    type_of<T>.write(writer, name, &value);
    return 1U;
  };
}

/// A client of a Guarded that says what a test wants.
class GuardedClient {
 public:
  /// Not connected.
  explicit GuardedClient(GuardedService& service) : raw_(service.node) {}
  GuardedClient(GuardedService& service, const std::string& user) : raw_(service.node, "guarded") {
    if (!user.empty()) log_in(user);
  }

  RawClient& raw() { return raw_; }

  std::uint16_t log_in(const std::string& user, const std::string& password) {
    const auto elements = [&](Writer& writer) {
      const VarStringMap credentials{{"password", password}};
      type_of<VarStringMap>.write(writer, "credentials", &credentials);
      type_of<std::string>.write(writer, "username", &user);
      return 2U;
    };
    return ask(EntryType::client_session_op_req, "guarded", "AuthenticateUser", elements);
  }
  std::uint16_t log_in(const std::string& user) { return log_in(user, user); }
  std::uint16_t log_out() { return operation("LogoutUser"); }
  std::uint16_t operation(const std::string& name, const std::string& path = "guarded",
                          const RawClient::Elements& elements = nullptr) {
    return ask(EntryType::client_session_op_req, path, name, elements);
  }

  /// Sends a request; the code of its answer. What comes before that is kept in `passed`.
  std::uint16_t ask(EntryType type, const std::string& path, const std::string& member,
                    const RawClient::Elements& elements = nullptr) {
    return answer(type, path, member, elements).error;
  }
  RawClient::Answer answer(EntryType type, const std::string& path, const std::string& member,
                           const RawClient::Elements& elements = nullptr) {
    const RawClient::Request request{type, path, member, elements, ++last_id_};
    raw_.send({&request, 1});
    while (true) {
      auto next = raw_.receive();
      if (!next) throw Error(ErrorCode::connection_error, "no answer");
      const bool is_answer =
          next->id == last_id_ && static_cast<std::uint16_t>(next->type) % 2 == 0;
      if (is_answer) return std::move(*next);
      passed.push_back(std::move(*next));
    }
  }
  /// All that has come until a request that is always answered is.
  std::vector<EntryType> settle() {
    ask(EntryType::client_keep_alive_req, "guarded", "");
    std::vector<EntryType> types;
    for (const RawClient::Answer& each : passed) types.push_back(each.type);
    passed.clear();
    return types;
  }

  std::uint16_t connect_wire(const std::string& path = "guarded") {
    return ask(EntryType::wire_connect_req, path, "level");
  }
  /// The index of the endpoint.
  std::int32_t connect_pipe(const std::string& path = "guarded") {
    return answer(EntryType::pipe_connect_req, path, "samples", element<std::int32_t>("index", -1))
        .value_of<std::int32_t>("index");
  }
  /// Its number.
  std::int32_t open_generator(const std::string& path = "guarded") {
    return answer(EntryType::function_call_req, path, "count").value_of<std::int32_t>("index");
  }
  std::uint16_t step(std::int32_t index, const std::string& path = "guarded",
                     const std::string& member = "count") {
    return ask(EntryType::generator_next_req, path, member, element("index", index));
  }

  static RawClient::Elements wire_value(std::int64_t seconds) {
    return [seconds](Writer& writer) {
      const double value = 1.5;
      const TimeSpec time{.seconds = seconds, .nanoseconds = 0};
      type_of<double>.write(writer, "packet", &value);
      type_of<TimeSpec>.write(writer, "packettime", &time);
      return 2U;
    };
  }
  static RawClient::Elements pipe_packet(std::int32_t index, std::uint32_t number) {
    return [index, number](Writer& writer) {
      const double value = 1.5;
      endpoint::write_packet(writer, std::to_string(index), number, false,
                             [&] { type_of<double>.write(writer, "packet", &value); });
      return 1U;
    };
  }

  std::vector<RawClient::Answer> passed;

 private:
  RawClient raw_;
  std::uint32_t last_id_ = 100;
};

}  // namespace rr::testing
