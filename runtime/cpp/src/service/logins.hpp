// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "rr/options.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/channel/time.hpp"

namespace rr::service {

/// Checks who logs in to the services of a node, on threads that do nothing else: hashing a
/// password takes long, and what the program does for it may take longer. They are made when they
/// are needed and end when they have had nothing to do for some seconds.
///
/// Attempts wait for a thread, and after failures for their delay. When too many wait, addresses
/// get equal shares of the queue: what does not fit is refused. Addresses take turns.
class Logins {
 public:
  /// What is to be checked, and who is told.
  struct Request {
    std::string address;                  ///< of the client (Connection::remote_address())
    std::string user;                     ///< the name that it gives
    unsigned failures = 0;                ///< of its connection, so far
    std::function<User()> check{};        ///< on a thread of the logins; throws for a refusal
    std::function<void()> on_finished{};  ///< once, on any thread, under no lock
  };
  /// One attempt. What it has come to is set before `on_finished` is called.
  struct Attempt {
    explicit Attempt(Request what) : request(std::move(what)) {}
    Request request;
    channel::Time added = channel::Clock::now();
    std::shared_ptr<const User> user;  ///< null: refused
    std::exception_ptr refusal;
  };
  using Log = std::function<void(LogLevel, std::string_view)>;

  /// `idle_time`: a thread without work ends after it.
  Logins(const LoginOptions& options, Log log,
         channel::Milliseconds idle_time = std::chrono::seconds(10));
  /// As stop().
  ~Logins();
  Logins(const Logins&) = delete;
  Logins& operator=(const Logins&) = delete;

  /// Always ends in on_finished(), which may come before this returns.
  std::shared_ptr<Attempt> add(Request request);
  /// Its client has gone: it ends at once unless a thread has begun with it.
  void cancel(const std::shared_ptr<Attempt>& attempt);
  /// Refuses what waits and what comes.
  void refuse_all();
  /// The same, and waits for the threads unless it is called by one.
  void stop();
  [[nodiscard]] bool is_own_thread() const;

  /// So long an attempt waits after this many failures of its connection and of its address.
  static channel::Milliseconds delay(const LoginOptions& options, unsigned of_connection,
                                     unsigned of_address);

 private:
  struct State;
  const std::shared_ptr<State> state_;  // the threads' too
};

/// A name from the network as it may stand in a log: printable and short.
std::string printable_name(std::string_view name);

}  // namespace rr::service
