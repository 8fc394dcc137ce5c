// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string_view>

#include "rr/buffer.hpp"
#include "rr/reader.hpp"
#include "rr/registry.hpp"
#include "rr/stub.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/call_terms.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/endpoint/pending.hpp"

/// Requests and the threads or completions that wait for their answers: those of a client, and the
/// callbacks of a service.
namespace rr::endpoint {

/// One end of a connection, as far as it asks the other.
class Caller {
 public:
  virtual ~Caller() = default;
  [[nodiscard]] virtual channel::Connection& connection() const = 0;
  [[nodiscard]] virtual const std::shared_ptr<Core>& core() const = 0;
  [[nodiscard]] virtual const std::shared_ptr<const TypeRegistry>& types() const = 0;
  /// Takes an open call out of the table; false when somebody else has.
  virtual bool take(Pending& call) = 0;
  /// Keeps this while there are calls.
  virtual std::shared_ptr<Caller> share() = 0;

  /// Ends a call that nobody else has ended.
  void cancel(Pending& call, channel::DeferredCallbacks& deferred);
  /// Runs what ending calls has left over, on a thread of the node.
  void post(channel::DeferredCallbacks deferred) const;
};

/// Reads an answer on whichever thread has received it: may not wait nor run user code. Throws
/// rr::Error.
using AnswerReader = std::function<void(Decoder&, const Message&, const Entry&)>;

/// Logs that an entry came with the number of a request that asked for something else. For
/// `deferred`.
std::function<void()> tell_foreign_answer(std::shared_ptr<Core> core, std::string_view sender,
                                          const Entry& entry);

/// Ends a call when a stop is requested.
struct CancelCall {
  std::shared_ptr<Caller> caller;
  Pending* call;
  void operator()() const;
};

/// Throws rr::Error (operation_cancelled) for a call that is not to begin any more.
void refuse_stopped(const std::stop_token& stop);

/// A request on the stack of the thread that waits for its answer.
class BlockingCall : public Pending {
 public:
  explicit BlockingCall(Caller& caller) : caller_(caller) {}

  void answer(const Message& message, const Entry& entry, const MemoryRef& owner,
              channel::DeferredCallbacks& deferred) final;
  void fail(const Error& why, channel::DeferredCallbacks& deferred) final;

  /// Sends the request and waits for the answer. `send` opens this call and sends. Throws what it
  /// throws, rr::Error, or what the other side has thrown.
  template <class Send>
  void perform(const CallTerms& terms, channel::Time deadline, channel::Time now, const Send& send);

 protected:
  ~BlockingCall() = default;
  virtual void read(Decoder& decoder, const Message& message, const Entry& entry) = 0;

 private:
  void wait(channel::Time deadline, channel::Time now);
  void wait_after_failure(channel::Time now);

  Caller& caller_;
  channel::Waiter waiter_;
  std::exception_ptr error_;
};

template <class Read>
class BlockingCallOf final : public BlockingCall {
 public:
  BlockingCallOf(Caller& caller, const Read& read) : BlockingCall(caller), read_(read) {}

 private:
  void read(Decoder& decoder, const Message& message, const Entry& entry) override {
    read_(decoder, message, entry);
  }

  const Read& read_;
};

/// A request whose answer goes to a completion. Keeps itself while it is open.
class AsyncCall final : public Pending,
                        public channel::Timer,
                        public std::enable_shared_from_this<AsyncCall> {
 public:
  AsyncCall(std::shared_ptr<Caller> caller, AnswerReader read,
            std::shared_ptr<Completion> completion);
  ~AsyncCall();

  void answer(const Message& message, const Entry& entry, const MemoryRef& owner,
              channel::DeferredCallbacks& deferred) override;
  void fail(const Error& why, channel::DeferredCallbacks& deferred) override;

  /// Sends the request. `encode` writes it and returns the writer; `send` opens this call and sends
  /// what is in the writer. Nothing is thrown: the completion gets that too.
  template <class Encode, class Send>
  void start(channel::Milliseconds timeout, const CallTerms& terms, const Encode& encode,
             const Send& send);

 private:
  void open(const std::stop_token& stop);
  void expect(channel::Milliseconds timeout);
  void fail_to_start();
  void on_timer() override;
  void end(channel::DeferredCallbacks& deferred);
  void complete();

  const std::shared_ptr<Caller> caller_;
  const AnswerReader read_;
  const std::shared_ptr<Completion> completion_;
  std::optional<std::stop_callback<CancelCall>> cancelled_by_;
  std::exception_ptr error_;
  std::shared_ptr<AsyncCall> keep_;
};

template <class Send>
void BlockingCall::perform(const CallTerms& terms, channel::Time deadline, channel::Time now,
                           const Send& send) {
  refuse_stopped(terms.stop);
  std::optional<std::stop_callback<CancelCall>> cancelled_by;
  if (terms.stop.stop_possible()) {
    cancelled_by.emplace(terms.stop, CancelCall{caller_.share(), this});
  }
  caller_.connection().claim(waiter_);
  try {
    send(*this);
  } catch (...) {
    wait_after_failure(now);
    throw;
  }
  if (terms.stop.stop_requested()) CancelCall{caller_.share(), this}();  // it was not open yet
  wait(deadline, now);
}

template <class Encode, class Send>
void AsyncCall::start(channel::Milliseconds timeout, const CallTerms& terms, const Encode& encode,
                      const Send& send) {
  try {
    Writer& writer = encode();
    open(terms.stop);
    send(*this, writer);
    if (terms.stop.stop_requested()) CancelCall{caller_, this}();  // it was not open yet
    expect(timeout);
  } catch (...) {
    fail_to_start();
  }
}

}  // namespace rr::endpoint
