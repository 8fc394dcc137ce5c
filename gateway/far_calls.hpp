// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "gateway/carrier.hpp"
#include "gateway/outbox.hpp"
#include "gateway/topics.hpp"
#include "gateway/worker.hpp"
#include "rr/function.hpp"

namespace rr::gateway {

/// What is asked of a robot.
struct FarRequest {
  ServiceAddress address;
  Verb verb = Verb::get;
  std::string path;    ///< of the object
  std::string member;  ///< empty for Verb::object
  Bytes payload{};
  Properties properties{};
  /// The number of the login at this gateway that the request belongs to; 0 for any. See
  /// FarSessions::login_of().
  std::uint64_t login = 0;
};

/// Requests to a robot over a broker: repeated until there is an answer or the time is over. All
/// repetitions of a request have the same id, so that the robot's gateway executes it once.
class FarCalls : public std::enable_shared_from_this<FarCalls> {
 public:
  using Clock = std::chrono::steady_clock;
  /// Called once, on the worker's thread; the exception is null for success.
  using Done = Function<void(std::exception_ptr, Message)>;
  /// How requests are made.
  struct Options {
    std::string user;                         ///< of the broker; a level of topics
    std::chrono::milliseconds limit{10'000};  ///< of each request
    std::chrono::milliseconds repeat{1'000};  ///< from one attempt to the next
  };

  /// `pump` is called when something is to be published, on the worker's thread; it and the outbox
  /// are not used any more when the worker has stopped. Requests that are made then are dropped:
  /// ends of pipes make some when the server has gone, on threads of the node.
  FarCalls(std::shared_ptr<Worker> worker, Outbox& outbox, Options options, Function<void()> pump);

  /// Any thread.
  void request(FarRequest request, Done done);
  /// Waits for the answer. Throws rr::Error. Not on the worker's thread.
  Message wait(FarRequest request);

  // The rest on the worker's thread.

  /// Where answers arrive.
  [[nodiscard]] const std::string& reply_topic() const { return reply_topic_; }
  /// An answer; ignored when nothing waits for it.
  void take(const Message& answer);
  /// A request is too large for the broker.
  void refuse(const Message& request);
  /// The broker does not allow requests to a topic.
  void deny(const Refusal& refusal);
  /// Repeats what waits; without a connection nothing is sent, or kept to be sent later.
  void set_connected(bool is_connected);
  /// Repeats what has waited long enough, and gives up what is too late. `where` says why there may
  /// be no answer from a service; empty when everything seems to be there.
  void tick(const Function<std::string(const ServiceAddress&)>& where);
  /// All that waits fails (operation_aborted).
  void abort();

 private:
  struct Pending {
    ServiceAddress address;
    Message message;
    Done done;
    Clock::time_point end;
    Clock::time_point next;
  };
  using Id = Bytes;
  void begin(Pending pending);
  void send(Pending& pending, Clock::time_point now);
  void finish(const Id& id, const std::exception_ptr& error, Message answer);

  const std::shared_ptr<Worker> worker_;
  Outbox& outbox_;
  Options options_;
  Function<void()> pump_;
  std::string instance_;  // random: no two processes have the same ids
  std::string reply_topic_;
  std::uint64_t last_id_ = 0;
  bool is_connected_ = false;
  std::map<Id, Pending> pending_;
};

}  // namespace rr::gateway
