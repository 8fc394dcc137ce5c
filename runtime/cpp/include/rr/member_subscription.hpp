// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <compare>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rr/client.hpp"
#include "rr/error.hpp"
#include "rr/function.hpp"
#include "rr/holding.hpp"
#include "rr/node_id.hpp"
#include "rr/stub.hpp"
#include "rr/time_spec.hpp"
#include "rr/visibility.hpp"

/// Members of all services of a subscription, which go on when a service comes back. See
/// rr/subscription.hpp.
namespace rr::subscription {
class Links;
}  // namespace rr::subscription

namespace RR_VISIBLE rr {

/// Which client of a subscription: the node and the name of the service that it is connected to.
struct SubscriptionClientId {
  NodeId node{};          ///< of the service
  std::string service{};  ///< its name
  /// Ordered by node, then by service.
  auto operator<=>(const SubscriptionClientId&) const = default;
};

/// What the three kinds have in common. Copies are handles of the same subscription, which lasts
/// until it is closed or the ServiceSubscription is, whether or not a handle is held. Any
/// thread may use it; nothing blocks but the waiting forms.
class MemberSubscription {
 public:
  /// A handle of nothing.
  MemberSubscription() = default;
  /// For all handles. Functions are not told anything any more, one that runs excepted.
  void close();
  /// False once it or its ServiceSubscription is closed.
  [[nodiscard]] bool is_open() const;
  /// Clients at which the member is connected, or the object found.
  [[nodiscard]] std::vector<SubscriptionClientId> clients() const;
  /// Why it last could not be connected at a client that is still there: member_not_found,
  /// data_type_mismatch for a member of another type, object_not_found, service_error for an object
  /// of a type that the program does not know, ... Nothing when all is well. It is tried again
  /// after the subscription's retry delay.
  [[nodiscard]] std::optional<Error> last_error() const;
  /// Calls `function` for each such failure, those that are there first, one at a time, on a thread
  /// of the node.
  Subscription on_failed(Function<void(const SubscriptionClientId&, const Error&)> function);

  /// For the runtime: ServiceSubscription makes it.
  explicit MemberSubscription(std::shared_ptr<subscription::Links> links);  // internal

 protected:
  /// null for a handle of nothing
  std::shared_ptr<subscription::Links> links_;
};

/// A value from a client.
template <class T>
struct ClientValue {
  T value{};                      ///< as it was sent
  TimeSpec time{};                ///< when it was sent, by the sender's clock
  SubscriptionClientId client{};  ///< who sent it
};

/// A packet from a client.
template <class T>
struct ClientPacket {
  T packet{};                     ///< as it was sent
  SubscriptionClientId client{};  ///< who sent it
};

/// A wire of all services, whatever its values are.
class WireSubscriptionBase : public MemberSubscription {
 public:
  /// For the runtime: ServiceSubscription makes it.
  using MemberSubscription::MemberSubscription;

  /// A value older than this, counted from its arrival, is as none; 0: values never expire, not
  /// even when their client goes.
  void set_lifespan(std::chrono::milliseconds lifespan);

 protected:
  /// A value of any type.
  struct Value {
    std::shared_ptr<const void> value;  ///< null for none
    TimeSpec time;                      ///< when it was sent
    SubscriptionClientId client;        ///< who sent it
  };
  /// What WireSubscription::try_in() stands on.
  Value received() const;
  /// What WireSubscription::all_in() stands on.
  std::vector<Value> all_received() const;
  /// What WireSubscription::wait_in() stands on.
  bool wait_received(std::chrono::milliseconds limit) const;
  /// What WireSubscription::on_in() stands on.
  Subscription on_received(Function<void(const Value&)> function);
  /// What WireSubscription::set_out() stands on.
  std::size_t send_all(const void* value);
  /// Throws rr::Error (value_not_set).
  [[noreturn]] static void throw_no_value();
};

/// A wire of all services of a subscription.
template <class T>
class WireSubscription : public WireSubscriptionBase {
 public:
  using WireSubscriptionBase::WireSubscriptionBase;

  /// The value that has arrived last, from whichever client. Throws rr::Error (value_not_set).
  [[nodiscard]] T in() const {
    auto result = try_in();
    if (!result) throw_no_value();
    return std::move(result->value);
  }
  /// The same with its time and client.
  [[nodiscard]] std::optional<ClientValue<T>> try_in() const {
    const Value newest = received();
    if (!newest.value) return std::nullopt;
    return typed(newest);
  }
  /// The newest value of each connected client that has one.
  [[nodiscard]] std::vector<ClientValue<T>> all_in() const {
    std::vector<ClientValue<T>> result;
    for (const Value& value : all_received()) result.push_back(typed(value));
    return result;
  }
  /// Waits until there is a value. False when there was none in time, or this was closed.
  [[nodiscard]] bool wait_in(std::chrono::milliseconds limit) const { return wait_received(limit); }
  /// Calls `function(value, time, client)` for the newest values that are there and that arrive,
  /// one at a time, on a thread of the node. A slow one misses values of a client, never its
  /// newest.
  template <class Function>
  Subscription on_in(Function function) {
    return on_received([function = std::move(function)](const Value& value) mutable {
      function(*static_cast<const T*>(value.value.get()), value.time, value.client);
    });
  }
  /// Sends a value to all services that are connected now; returns to how many. One that goes
  /// meanwhile is left out. Throws rr::Error (invalid_operation when closed, read_only_member,
  /// data_type_error).
  std::size_t set_out(const T& value) { return send_all(&value); }

 private:
  static ClientValue<T> typed(const Value& value) {
    return {*static_cast<const T*>(value.value.get()), value.time, value.client};
  }
};

/// A pipe of all services, whatever its packets are.
class PipeSubscriptionBase : public MemberSubscription {
 public:
  /// For the runtime: ServiceSubscription makes it.
  using MemberSubscription::MemberSubscription;

  /// Packets that wait to be received.
  [[nodiscard]] std::size_t available() const;
  /// Packets that were lost because as many waited as may.
  [[nodiscard]] std::size_t lost_count() const;
  /// For send(): services with more unacknowledged packets are passed over. 0: packets are not
  /// acknowledged and no endpoint is passed over (the default).
  void set_backlog_limit(std::size_t packets);

 protected:
  /// A packet of any type.
  struct Packet {
    std::shared_ptr<void> value;  ///< null for none
    SubscriptionClientId client;  ///< who sent it
  };
  /// What PipeSubscription::try_receive() stands on.
  Packet take();
  /// What PipeSubscription::receive_for() stands on.
  bool wait(std::chrono::milliseconds limit) const;
  /// What PipeSubscription::on_packet() stands on.
  Subscription on_received(Function<void(Packet)> function);
  /// What PipeSubscription::send() stands on.
  std::size_t send_all(const void* value);
  /// Throws rr::Error (invalid_operation).
  [[noreturn]] static void throw_no_packet();
};

/// A pipe of all services of a subscription: one endpoint at each, whose packets come together
/// here. Those of one client stay in their order. Packets of endpoints that have closed can still
/// be received.
template <class T>
class PipeSubscription : public PipeSubscriptionBase {
 public:
  using PipeSubscriptionBase::PipeSubscriptionBase;

  /// Throws rr::Error (invalid_operation) when none waits.
  ClientPacket<T> receive() {
    auto packet = try_receive();
    if (!packet) throw_no_packet();
    return std::move(*packet);
  }
  /// The packet that has waited longest; nothing when none waits.
  [[nodiscard]] std::optional<ClientPacket<T>> try_receive() {
    Packet packet = take();
    if (!packet.value) return std::nullopt;
    return ClientPacket<T>{std::move(*static_cast<T*>(packet.value.get())),
                           std::move(packet.client)};
  }
  /// Waits for one. Nothing when the time was over, or this closed, before.
  [[nodiscard]] std::optional<ClientPacket<T>> receive_for(std::chrono::milliseconds limit) {
    return wait(limit) ? try_receive() : std::nullopt;
  }
  /// Calls `function(T, client)` for packets, those that wait first, instead of keeping them; one
  /// at a time, on a thread of the node. The newest function counts.
  template <class Function>
  Subscription on_packet(Function function) {  // NOLINTNEXTLINE(performance-*): given away
    return on_received([function = std::move(function)](Packet packet) mutable {
      function(std::move(*static_cast<T*>(packet.value.get())),
               static_cast<const SubscriptionClientId&>(packet.client));
    });
  }
  /// Sends a packet to all services that are connected now; returns to how many. Left out are those
  /// that go meanwhile or whose connection takes no more. Throws rr::Error (invalid_operation when
  /// closed, read_only_member, data_type_error).
  std::size_t send(const T& packet) { return send_all(&packet); }
};

/// An object below the root of the default client. It is looked for when a client comes, so that
/// the forms that do not wait do not ask the service.
class SubObjectSubscription : public MemberSubscription {
 public:
  /// For the runtime: ServiceSubscription makes it.
  using MemberSubscription::MemberSubscription;

  /// Null when there is none, or it has not been found yet. Throws rr::Error (service_error) when
  /// it is no S.
  template <class S>
  [[nodiscard]] std::shared_ptr<S> try_default_client() const {
    return stub_cast<S>(find(type_of_stub<S>()));
  }
  /// Throws rr::Error (connection_error, with the reason) when there is none.
  template <class S>
  [[nodiscard]] std::shared_ptr<S> default_client() const {
    return stub_cast<S>(need(type_of_stub<S>()));
  }
  /// Waits for it. Throws rr::Error: operation_timeout, invalid_operation when this is closed.
  template <class S>
  [[nodiscard]] std::shared_ptr<S> wait_default_client(std::chrono::milliseconds limit) const {
    return stub_cast<S>(wait(type_of_stub<S>(), limit));
  }
  /// void(std::exception_ptr, std::shared_ptr<S>). Defined in rr/async.hpp.
  template <class S, class Token>
  auto async_default_client(std::chrono::milliseconds limit, Token&& token) const;

 private:
  std::shared_ptr<Stub> find(const ObjectType* type) const;
  std::shared_ptr<Stub> need(const ObjectType* type) const;
  std::shared_ptr<Stub> wait(const ObjectType* type, std::chrono::milliseconds limit) const;
  /// The completion's result is a std::shared_ptr<Stub>.
  void start_wait(const ObjectType* type, std::chrono::milliseconds limit,
                  std::unique_ptr<Completion> completion) const;
};

}  // namespace rr
