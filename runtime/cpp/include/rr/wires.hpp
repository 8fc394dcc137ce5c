// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "rr/definition.hpp"
#include "rr/function.hpp"
#include "rr/holding.hpp"
#include "rr/stub.hpp"
#include "rr/timed.hpp"
#include "rr/visibility.hpp"

/// Wires: values of which only the newest counts (07, section 13). The client's "in" is what the
/// service sends, its "out" what it sends itself; the service's side uses the same words.
namespace RR_VISIBLE rr {

class Skeleton;

/// One end of a connected wire, whatever its values are. Copies are handles of the same end, which
/// stays connected until it is closed, its session ends or its object is released, whether or not
/// a handle is held. Any thread may use it.
class WireEnd {
 public:
  /// No end: not to be used.
  WireEnd() = default;
  /// Disconnects. A client waits for the service's answer for at most half a second. Nothing
  /// happens the second time.
  void close();
  /// False once it is closed, by either side, or lost.
  [[nodiscard]] bool is_open() const;
  /// Called once when either side has closed the end, on a thread of the node; at once when
  /// it is closed already.
  void on_closed(Function<void()> function);
  /// On the service's side: number of the client's endpoint in this node. 0 on the client's side.
  [[nodiscard]] std::uint32_t client() const;

  /// For the runtime: what the handles of one end share.
  struct State;  // internal
  /// For the runtime: a handle of an end.
  explicit WireEnd(std::shared_ptr<State> state) : state_(std::move(state)) {}

 protected:
  /// The newest value that has arrived and has not expired; null for none.
  std::shared_ptr<const void> received(TimeSpec& time) const;
  /// Waits until there is one. False when the time was over, or the end closed, before. May be
  /// called anywhere: values arrive while a function of the program runs.
  bool wait_received(std::chrono::milliseconds limit) const;
  /// What TypedWireEnd::set_lifespan() stands on.
  void set_lifespan(std::chrono::milliseconds lifespan);
  /// Calls `function` with the value that is there, and each that arrives and is newer than those
  /// before it, in order, on a thread of the node; a function that is slow misses values, never the
  /// newest.
  Subscription on_received(Function<void(const void*, const TimeSpec&)> function);
  /// Sends; throws rr::Error (invalid_operation when closed, connection_error when the connection
  /// breaks; read_only_member, write_only_member for a direction that the wire does not have;
  /// data_type_error for what may not travel).
  void send(const void* value);
  /// What was sent last; null for nothing yet.
  std::shared_ptr<const void> sent(TimeSpec& time) const;
  /// Throws rr::Error (value_not_set).
  [[noreturn]] static void throw_no_value();  // value_not_set

  /// null for no end
  std::shared_ptr<State> state_;
};

/// What WireConnection and ServedWire have in common: values of a T that arrive and that are sent.
template <class T>
class TypedWireEnd : public WireEnd {
 public:
  /// No end: not to be used.
  TypedWireEnd() = default;
  /// An end whose values are of a T.
  explicit TypedWireEnd(WireEnd end) : WireEnd(std::move(end)) {}

  /// A value older than this, counted from its arrival, is as none; 0: values never expire.
  void set_lifespan(std::chrono::milliseconds lifespan) { WireEnd::set_lifespan(lifespan); }

 protected:
  /// The newest value that has arrived and has not expired; nothing for none.
  std::optional<Timed<T>> try_received() const {
    Timed<T> result;
    const std::shared_ptr<const void> value = received(result.time);
    if (!value) return std::nullopt;
    result.value = *static_cast<const T*>(value.get());
    return result;
  }
  /// The same; throws rr::Error (value_not_set) for none.
  T need_received() const {
    auto result = try_received();
    if (!result) throw_no_value();
    return std::move(result->value);
  }
  /// What was sent last; nothing for nothing yet.
  std::optional<Timed<T>> try_sent() const {
    Timed<T> result;
    const std::shared_ptr<const void> value = sent(result.time);
    if (!value) return std::nullopt;
    result.value = *static_cast<const T*>(value.get());
    return result;
  }
  /// Calls `function(value, time)` for the value that is there and for values that arrive.
  template <class Function>
  Subscription on_value(Function function) {
    return on_received(
        [function = std::move(function)](const void* value, const TimeSpec& time) mutable {
          function(*static_cast<const T*>(value), time);
        });
  }
};

/// A client's end of a wire.
template <class T>
class WireConnection : public TypedWireEnd<T> {
 public:
  using TypedWireEnd<T>::TypedWireEnd;

  /// The newest value from the service. Throws rr::Error (value_not_set) while there is none.
  T in() const { return this->need_received(); }
  /// The newest value from the service, and when it was sent; nothing while there is none.
  [[nodiscard]] std::optional<Timed<T>> try_in() const { return this->try_received(); }
  /// Waits until there is a value. False when there was none in time, or the wire was closed.
  [[nodiscard]] bool wait_in(std::chrono::milliseconds limit) const {
    return this->wait_received(limit);
  }
  /// Calls `function(value, time)` for the value that is there and for values that arrive.
  template <class Function>
  Subscription on_in(Function function) {
    return this->on_value(std::move(function));
  }
  /// Sends a value to the service.
  void set_out(const T& value) { this->send(&value); }
  /// What was sent last; nothing for nothing yet.
  [[nodiscard]] std::optional<Timed<T>> out() const { return this->try_sent(); }
};

/// A service's end of a wire: that of one client.
template <class T>
class ServedWire : public TypedWireEnd<T> {
 public:
  using TypedWireEnd<T>::TypedWireEnd;

  /// Sends a value to this client.
  void set_in(const T& value) { this->send(&value); }
  /// What was sent last; nothing for nothing yet.
  [[nodiscard]] std::optional<Timed<T>> in() const { return this->try_sent(); }
  /// The newest value from this client. Throws rr::Error (value_not_set) while there is none.
  T out() const { return this->need_received(); }
  /// The newest value from this client, and when it was sent; nothing while there is none.
  [[nodiscard]] std::optional<Timed<T>> try_out() const { return this->try_received(); }
  /// Waits until there is a value. False when there was none in time, or the wire was closed.
  [[nodiscard]] bool wait_out(std::chrono::milliseconds limit) const {
    return this->wait_received(limit);
  }
  /// Calls `function(value, time)` for the value that is there and for values that arrive.
  template <class Function>
  Subscription on_out(Function function) {
    return this->on_value(std::move(function));
  }
};

/// A wire of an object on another node, without its type.
class WireMember {
 protected:
  /// A wire of an object.
  WireMember(Stub& stub, const Member& member, const Holding& holding)
      : stub_(&stub), member_(&member), holding_(&holding) {}

  /// What Wire::connect() stands on.
  WireEnd connect_end();
  /// What Wire::peek_in() stands on. Peeks and pokes are requests, and need no connection.
  void peek_in(void* value, TimeSpec& time);
  /// What Wire::peek_out() stands on.
  void peek_out(void* value, TimeSpec& time);
  /// What Wire::poke_out() stands on.
  void poke_out(const void* value);
  /// What the asynchronous templates stand on. The places are in the completion.
  void start_connect(WireEnd* end, std::unique_ptr<Completion> completion);
  /// What async_peek_in() and async_peek_out() stand on.
  void start_peek(bool of_out, void* value, TimeSpec* time, std::unique_ptr<Completion> completion);
  /// What async_poke_out() stands on.
  void start_poke(const void* value, std::unique_ptr<Completion> completion);

  /// the object
  Stub* stub_;
  /// the wire in its definition
  const Member* member_;
  /// how values are kept
  const Holding* holding_;
};

/// A wire of an object on another node: `stub->force()`.
template <class T>
class Wire : public WireMember {
 public:
  /// For generated code: a wire of an object.
  Wire(Stub& stub, const Member& member) : WireMember(stub, member, holding_of<T>) {}

  /// Throws rr::Error: invalid_operation when the client has connected it already.
  WireConnection<T> connect(const CallOptions& options = {}) {
    const CallOptionsScope scope(options);
    return WireConnection<T>(connect_end());
  }
  /// The service's value now. Throws rr::Error (value_not_set, write_only_member, ...).
  Timed<T> peek_in(const CallOptions& options = {}) {
    const CallOptionsScope scope(options);
    Timed<T> result;
    WireMember::peek_in(&result.value, result.time);
    return result;
  }
  /// The value that the service has last received. Throws as above, read_only_member.
  Timed<T> peek_out(const CallOptions& options = {}) {
    const CallOptionsScope scope(options);
    Timed<T> result;
    WireMember::peek_out(&result.value, result.time);
    return result;
  }
  /// Gives the service a value, without a connection. Throws as peek_in(), read_only_member.
  void poke_out(const T& value, const CallOptions& options = {}) {
    const CallOptionsScope scope(options);
    WireMember::poke_out(&value);
  }

  /// As connect(), with a completion token. Signature: void(std::exception_ptr, WireConnection<T>).
  /// This and the following are defined in rr/async.hpp.
  template <class Token>
  auto async_connect(const CallOptions& options, Token&& token);
  /// As above, with the client's time-out.
  template <class Token>
  auto async_connect(Token&& token) {
    return async_connect(CallOptions(), std::forward<Token>(token));
  }
  /// As peek_in(), with a completion token. Signature: void(std::exception_ptr, Timed<T>).
  template <class Token>
  auto async_peek_in(const CallOptions& options, Token&& token) {
    return async_peek(false, options, std::forward<Token>(token));
  }
  /// As above, with the client's time-out.
  template <class Token>
  auto async_peek_in(Token&& token) {
    return async_peek_in(CallOptions(), std::forward<Token>(token));
  }
  /// As peek_out(), with a completion token. Signature: void(std::exception_ptr, Timed<T>).
  template <class Token>
  auto async_peek_out(const CallOptions& options, Token&& token) {
    return async_peek(true, options, std::forward<Token>(token));
  }
  /// As above, with the client's time-out.
  template <class Token>
  auto async_peek_out(Token&& token) {
    return async_peek_out(CallOptions(), std::forward<Token>(token));
  }
  /// As poke_out(), with a completion token. Signature: void(std::exception_ptr).
  template <class Token>
  auto async_poke_out(const T& value, const CallOptions& options, Token&& token);
  /// As above, with the client's time-out.
  template <class Token>
  auto async_poke_out(const T& value, Token&& token) {
    return async_poke_out(value, CallOptions(), std::forward<Token>(token));
  }

 private:
  template <class Token>
  auto async_peek(bool of_out, const CallOptions& options, Token&& token);
};

/// A wire that an object offers, without its type. What is set up here is kept by the object, so a
/// copy, or another handle of the same wire, is the same.
class WireServerBase {
 public:
  /// Number of clients that have connected the wire.
  [[nodiscard]] std::size_t connection_count() const;
  /// Values of clients that are older than this, counted from their arrival, are as none for out();
  /// 0: they never expire.
  void set_lifespan(std::chrono::milliseconds lifespan);

 protected:
  /// For the runtime: what is to be called.
  struct Functions {
    Function<void(WireEnd)> connected;           ///< a client has connected
    Function<std::shared_ptr<void>()> peek_in;   ///< answers peeks of clients
    Function<std::shared_ptr<void>()> peek_out;  ///< answers peeks at what was received
    /// a client has sent or poked a value
    Function<void(const void*, const TimeSpec&, std::uint32_t)> received;
  };
  /// A wire of an object that a service offers.
  WireServerBase(const Skeleton& skeleton, const Member& member, const Holding& holding);
  /// What WireServer::set_in() stands on.
  void send_all(const void* value) const;
  /// What WireServer::out() stands on.
  std::shared_ptr<const void> received(TimeSpec& time) const;
  /// All connected ends.
  [[nodiscard]] std::vector<WireEnd> ends() const;
  /// What WireServer::on_connect() stands on.
  void set_connected(Function<void(WireEnd)> function) const;
  /// What WireServer::on_peek_in() stands on.
  void set_peek_in(Function<std::shared_ptr<void>()> function) const;
  /// What WireServer::on_peek_out() stands on.
  void set_peek_out(Function<std::shared_ptr<void>()> function) const;
  /// What WireServer::on_out() stands on.
  void set_received(Function<void(const void*, const TimeSpec&, std::uint32_t)> function) const;

  /// the object
  const Skeleton* skeleton_;
  /// the wire in its definition
  const Member* member_;
  /// how values are kept
  const Holding* holding_;
};

/// A wire that an object offers: `force()` of its skeleton. Without any of the on_ functions it
/// does what most services want: set_in() goes to all clients, and to each that connects later;
/// out() is the newest value that any client has sent or poked; peeks are answered with these two.
template <class T>
class WireServer : public WireServerBase {
 public:
  /// For generated code: a wire of an object that a service offers.
  WireServer(const Skeleton& skeleton, const Member& member)
      : WireServerBase(skeleton, member, holding_of<T>) {}

  /// Sends a value to all connected clients, encoded once for each message version.
  void set_in(const T& value) const { send_all(&value); }
  /// The newest value from any client that has not expired.
  [[nodiscard]] std::optional<Timed<T>> out() const {
    Timed<T> result;
    const std::shared_ptr<const void> value = received(result.time);
    if (!value) return std::nullopt;
    result.value = *static_cast<const T*>(value.get());
    return result;
  }
  /// One end for each connected client.
  [[nodiscard]] std::vector<ServedWire<T>> connections() const {
    std::vector<ServedWire<T>> result;
    for (WireEnd& end : ends()) result.emplace_back(std::move(end));
    return result;
  }
  /// Calls `function(ServedWire<T>)` for each client that connects, before its answer is sent.
  template <class Function>
  void on_connect(Function function) const {
    set_connected(
        [function = std::move(function)](WireEnd end) { function(ServedWire<T>(std::move(end))); });
  }
  /// Calls `function(value, time, client)` for each value that a client sends or pokes; for pokes
  /// before they are answered. What is sent while the function runs for that client it gets later,
  /// only the newest. For different clients, and for pokes, it may run at the same time.
  template <class Function>
  void on_out(Function function) const {
    set_received([function = std::move(function)](const void* value, const TimeSpec& time,
                                                  std::uint32_t client) {
      function(*static_cast<const T*>(value), time, client);
    });
  }
  /// Answers peeks with what `function()` returns, instead.
  template <class Function>
  void on_peek_in(Function function) const {
    set_peek_in([function = std::move(function)] {
      return std::static_pointer_cast<void>(std::make_shared<T>(function()));
    });
  }
  /// Answers peeks at what clients have sent with what `function()` returns, instead of out().
  template <class Function>
  void on_peek_out(Function function) const {
    set_peek_out([function = std::move(function)] {
      return std::static_pointer_cast<void>(std::make_shared<T>(function()));
    });
  }
};

}  // namespace rr
