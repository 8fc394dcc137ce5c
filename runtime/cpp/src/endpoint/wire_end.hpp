// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/wires.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/synchronization.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/endpoint/newest_value.hpp"
#include "runtime/cpp/src/endpoint/sender_clock.hpp"
#include "runtime/cpp/src/endpoint/subscription.hpp"

namespace rr {
namespace channel {

struct SlotValue;

}  // namespace channel
namespace endpoint {

template <class End>
struct NewestSteps;

}  // namespace endpoint

/// One end of a wire, of either side. Its owner, a session or a service's endpoint, hands it what
/// arrives, and ends it.
///
/// Functions of the program are called by work that is posted while there is something to tell:
/// it goes on until every function has seen the newest value, so that one that is slow misses
/// values and holds up nothing else. Nothing of the program runs under the lock.
///
/// Large because what comes, what is sent and what is told to the program meet in one lock, and the
/// two sides differ in a few functions of each.
struct WireEnd::State : std::enable_shared_from_this<WireEnd::State> {
 public:
  State(std::shared_ptr<endpoint::Core> core, std::string path, const Member& member);
  virtual ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const Member& member() const { return member_; }

  // What handles do; see WireEnd.
  virtual void close() = 0;
  [[nodiscard]] virtual std::uint32_t client() const { return 0; }
  [[nodiscard]] bool is_open() const { return phase_ == Phase::open; }
  void on_closed(Function<void()> function);
  std::shared_ptr<const void> received(TimeSpec& time);
  bool wait_received(std::chrono::milliseconds limit);
  void set_lifespan(std::chrono::milliseconds lifespan);
  Subscription on_received(Function<void(const void*, const TimeSpec&)> function);
  /// Calls `function` with what is wrong when a value came that has another type than the member,
  /// on a thread of the node; at once when one has come already. One function, while it is open.
  void on_refused(std::function<void(const Error&)> function);
  void send(const void* value);
  std::shared_ptr<const void> sent(TimeSpec& time) const;

  // What owners do. None runs code of the program; what could not be posted is left in `deferred`.
  /// Both sides know of the connection. Values are taken before that already.
  void open();
  /// A packet has come. What does not count is dropped, and so is a large value of a client that
  /// makes this node hold too much.
  void take(const Message& message, const Entry& entry, const MemoryRef& owner,
            const TypeRegistry& types, channel::DeferredCallbacks& deferred);
  /// The connection has ended. Nothing happens the second time.
  void finish(channel::DeferredCallbacks& deferred);

 protected:
  enum class Phase : std::uint8_t { connecting, open, closing, closed };

  [[nodiscard]] endpoint::Core& core() const { return *core_; }
  /// False when somebody else closes it or has closed it. finish() is to follow.
  bool begin_close();
  /// finish() for a thread of the program.
  void finish_now();
  /// A value that cannot be read.
  void refuse(const std::exception& why, channel::DeferredCallbacks& deferred);
  /// A value that was read from a slot: the elements of a packet in format 4. What does not count
  /// is dropped. `tells_here`: this thread of the node calls the functions of the program, else
  /// another one does.
  void take_slot(const channel::SlotValue& slot, const TypeRegistry& types, bool tells_here);
  /// Whether threads or functions of the program wait for values.
  [[nodiscard]] bool is_awaited() const;
  /// Keeps what is being sent as what was sent last.
  void keep_sent(std::shared_ptr<const void> value, endpoint::SenderTime time);

  // What the two sides do in their own ways.
  [[nodiscard]] virtual channel::Connection& connection() const = 0;
  /// Throws rr::Error when the program may not send in this direction.
  virtual void check_sending() const = 0;
  virtual endpoint::SenderTime draw_time() = 0;
  /// Sends a packet whose elements the writer holds. Throws rr::Error.
  virtual void transmit(Writer& writer, const channel::Newest& newest) = 0;
  /// To be called before a value is given to the program: takes a newer one, where they do not come
  /// by themselves. Under no lock.
  virtual void look() {}
  /// is_awaited() has come true, or may be about to. Under no lock.
  virtual void on_awaited() {}
  /// The value that was sent to all, this end included, and its time; null for none.
  [[nodiscard]] virtual std::shared_ptr<const void> sent_to_all(
      endpoint::SenderTime& /*time*/) const {
    return nullptr;
  }
  /// A value has been taken. Under the lock.
  virtual void on_taken(const std::shared_ptr<const void>& /*value*/, const TimeSpec& /*time*/) {}
  /// Whether tell() is to be called.
  [[nodiscard]] virtual bool has_listener() const { return false; }
  /// As functions of the program are called: with the newest value.
  virtual void tell(const void* /*value*/, const TimeSpec& /*time*/) {}
  /// Once, while it ends.
  virtual void leave() {}
  /// Once, when nothing will be told any more.
  virtual void release() {}

  // Set by the constructors of the two sides.
  std::uint64_t stream_ = 0;
  bool may_receive_ = true;

 private:
  using Sync = channel::Synchronization;
  using Steps = endpoint::NewestSteps<State>;
  friend Steps;
  class Listener;

  // Telling the program (wire_end_calls.cpp)
  [[nodiscard]] bool must_start_telling() RR_REQUIRES(mutex_);
  [[nodiscard]] bool has_to_tell() const RR_REQUIRES(mutex_);
  void start_telling();
  void tell_all();
  bool next_turn(std::shared_ptr<const void>& value, TimeSpec& time, bool& tells_side,
                 std::vector<Function<void()>>& closed,
                 std::vector<std::shared_ptr<Listener>>& gone);
  template <class Call>
  void guard(const Call& call) const;
  [[nodiscard]] bool is_ending() const {
    return phase_ == Phase::closing || phase_ == Phase::closed;
  }

  const std::shared_ptr<endpoint::Core> core_;
  const std::string path_;
  const Member& member_;
  std::atomic<Phase> phase_{Phase::connecting};  // written under mutex_

  mutable Mutex mutex_;
  mutable Condition arrived_;
  endpoint::NewestValue in_ RR_GUARDED_BY(mutex_);
  channel::Charge charge_
      RR_GUARDED_BY(mutex_);  // for that value, if it is a large one of a client
  std::uint64_t sequence_ RR_GUARDED_BY(mutex_) = 0;               // counts values that were taken
  unsigned waiting_ RR_GUARDED_BY(mutex_) = 0;                     // threads in wait_received()
  std::shared_ptr<void> own_sent_ RR_GUARDED_BY(mutex_);           // copied into by send()
  std::shared_ptr<const void> common_sent_ RR_GUARDED_BY(mutex_);  // what was sent to others too
  endpoint::SenderTime sent_time_ RR_GUARDED_BY(mutex_) = 0;       // 0: nothing yet
  bool is_own_sent_ RR_GUARDED_BY(mutex_) = false;

  std::vector<std::shared_ptr<Listener>> listeners_ RR_GUARDED_BY(mutex_);
  std::vector<Function<void()>> on_closed_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<const std::function<void(const Error&)>> on_refused_ RR_GUARDED_BY(mutex_);
  std::optional<Error> refusal_ RR_GUARDED_BY(mutex_);
  std::uint64_t told_side_ RR_GUARDED_BY(mutex_) = 0;  // the value that tell() was called for
  bool is_telling_ RR_GUARDED_BY(mutex_) = false;      // or will be, by posted work
  bool is_over_ RR_GUARDED_BY(mutex_) = false;         // all has been told
  std::vector<std::shared_ptr<Listener>> turn_;        // with the telling thread
};

}  // namespace rr
