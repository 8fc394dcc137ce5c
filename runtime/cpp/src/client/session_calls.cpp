// SPDX-License-Identifier: Apache-2.0
// Requests and their answers.
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr {

// A request on the stack of the thread that waits for its answer.
class Session::BlockingCall : public endpoint::Pending {
 public:
  explicit BlockingCall(Session& session) : session_(session) {}

  void answer(const Message& message, const Entry& entry, const MemoryRef& owner,
              channel::Laters& /*laters*/) final {
    if (entry.error != 0) {
      error = endpoint::read_error(message, entry, owner, *session_.types_);
    } else {
      try {
        Decoder decoder(message.version, &message.strings, owner, session_.types_.get());
        read(decoder, message, entry);
      } catch (...) {
        error = std::current_exception();
      }
    }
    session_.connection_->finish(waiter);  // after which this may be gone
  }
  void fail(const Error& why, channel::Laters& /*laters*/) final {
    error = std::make_exception_ptr(why);
    session_.connection_->finish(waiter);
  }

  channel::Waiter waiter;
  std::exception_ptr error;

 protected:
  ~BlockingCall() = default;
  virtual void read(Decoder& decoder, const Message& message, const Entry& entry) = 0;

 private:
  Session& session_;
};

template <class Read>
class Session::BlockingCallOf final : public BlockingCall {
 public:
  BlockingCallOf(Session& session, const Read& read) : BlockingCall(session), read_(read) {}

 private:
  void read(Decoder& decoder, const Message& message, const Entry& entry) override {
    read_(decoder, message, entry);
  }

  const Read& read_;
};

// A request whose answer goes to a completion. Keeps itself while it is open.
class Session::AsyncCall final : public endpoint::Pending,
                                 public channel::Timer,
                                 public std::enable_shared_from_this<AsyncCall> {
 public:
  AsyncCall(std::shared_ptr<Session> session, AnswerReader read,
            std::shared_ptr<Completion> completion)
      : session_(std::move(session)), read_(std::move(read)), completion_(std::move(completion)) {}
  ~AsyncCall() { session_->core_->reactor().cancel(*this); }

  void open(std::shared_ptr<Cancellation::State> cancellation) {
    cancellation_ = std::move(cancellation);
    if (cancellation_) cancellation_->add(session_, *this);
    keep_ = shared_from_this();
  }
  void limit(channel::Time when) {
    session_->core_->reactor().schedule(*this, weak_from_this(), when);
  }

  void answer(const Message& message, const Entry& entry, const MemoryRef& owner,
              channel::Laters& laters) override {
    if (entry.error != 0) {
      error_ = endpoint::read_error(message, entry, owner, *session_->types_);
    } else {
      try {
        Decoder decoder(message.version, &message.strings, owner, session_->types_.get());
        read_(decoder, message, entry);
      } catch (...) {
        error_ = std::current_exception();
      }
    }
    end(laters);
  }
  void fail(const Error& why, channel::Laters& laters) override {
    error_ = std::make_exception_ptr(why);
    end(laters);
  }
  // For a call that was never sent.
  void fail_unsent(std::exception_ptr error, channel::Laters& laters) {
    error_ = std::move(error);
    end(laters);
  }

 private:
  void on_timer() override {
    if (!session_->take(*this)) return;
    channel::Laters laters;
    fail(Error(ErrorCode::request_timeout, "no answer in time"), laters);
    session_->post(std::move(laters));
  }

  void end(channel::Laters& laters) {
    laters.emplace_back([self = shared_from_this()] { self->complete(); });
    keep_.reset();
  }

  void complete() {
    if (cancellation_) cancellation_->remove(*this);
    session_->core_->reactor().cancel(*this);
    try {
      if (error_) {
        completion_->fail(error_);
      } else {
        completion_->succeed();
      }
    } catch (const std::exception& error) {
      session_->core_->log(LogLevel::error,
                           std::string("a completion handler has thrown: ") + error.what());
    }
  }

  const std::shared_ptr<Session> session_;
  const AnswerReader read_;
  const std::shared_ptr<Completion> completion_;
  std::shared_ptr<Cancellation::State> cancellation_;
  std::exception_ptr error_;
  std::shared_ptr<AsyncCall> keep_;
};

Session::Milliseconds Session::timeout_for(Milliseconds timeout, const CallTerms& terms) const {
  if (terms.timeout.count() != 0) return terms.timeout;
  if (timeout.count() != 0) return timeout;
  if (options_.request_timeout.count() != 0) return options_.request_timeout;
  return core_->options().request_timeout;
}

void Session::call(const Outgoing& request, const Incoming& answer, Milliseconds timeout) {
  const auto read = [&](Decoder& decoder, const Message&, const Entry& entry) {
    if (answer.type != nullptr) {
      endpoint::read_value(decoder, entry, answer.element, *answer.type, answer.value);
    }
  };
  BlockingCallOf call(*this, read);
  perform(request, call, timeout);
}

void Session::call(const Outgoing& request, const AnswerReader& read, Milliseconds timeout) {
  BlockingCallOf call(*this, read);
  perform(request, call, timeout);
}

namespace {

// Takes a call out of its cancellation, whatever happens.
struct CancellationEntry {
  Cancellation::State* state;
  const endpoint::Pending& call;
  ~CancellationEntry() {
    if (state != nullptr) state->remove(call);
  }
};

}  // namespace

Writer& Session::write(const Outgoing& request) const {
  Writer& writer = channel::thread_writer();
  writer.reset(connection_->version());
  endpoint::write_values(writer, request.parameters, request.values);
  if (writer.failed()) throw endpoint::latched(writer);
  return writer;
}

void Session::perform(const Outgoing& request, BlockingCall& call, Milliseconds timeout) {
  const CallTerms terms = CallTerms::current();
  const channel::Time now = channel::coarse_now();
  const channel::Time deadline = channel::after(now, timeout_for(timeout, terms));
  Writer& writer = write(request);
  if (terms.cancellation) terms.cancellation->add(shared_from_this(), call);
  const CancellationEntry entry{terms.cancellation.get(), call};
  connection_->claim(call.waiter);
  try {
    send_numbered(request, writer, draw(&call, true), now);
  } catch (...) {
    // Somebody may be ending it at this moment, and must come to the end.
    const bool is_ours = take(call);
    connection_->resign(call.waiter);
    if (!is_ours && call.was_added()) connection_->wait(call.waiter, channel::never, now);
    throw;
  }
  connection_->wait(call.waiter, deadline, now);
  if (!call.waiter.is_done.load(std::memory_order_acquire)) {
    if (take(call)) throw Error(ErrorCode::request_timeout, "no answer in time");
    connection_->wait(call.waiter, channel::never, now);
  }
  if (call.error) std::rethrow_exception(call.error);
}

void Session::start(const Outgoing& request, const Incoming& answer, Milliseconds timeout,
                    std::shared_ptr<Completion> completion) {
  start(
      request,
      [answer](Decoder& decoder, const Message&, const Entry& entry) {
        if (answer.type != nullptr) {
          endpoint::read_value(decoder, entry, answer.element, *answer.type, answer.value);
        }
      },
      timeout, std::move(completion));
}

void Session::start(const Outgoing& request, AnswerReader read, Milliseconds timeout,
                    std::shared_ptr<Completion> completion) {
  const auto call =
      std::make_shared<AsyncCall>(shared_from_this(), std::move(read), std::move(completion));
  const CallTerms terms = CallTerms::current();
  try {
    Writer& writer = write(request);
    call->open(terms.cancellation);
    send_numbered(request, writer, draw(call.get(), true), channel::coarse_now());
    connection_->expect();
    call->limit(channel::after(channel::coarse_now(), timeout_for(timeout, terms)));
  } catch (...) {
    // Not from inside the call that starts it. If it has been taken, its end is on the way already.
    if (call->was_added() && !take(*call)) return;
    channel::Laters laters;
    call->fail_unsent(std::current_exception(), laters);
    post(std::move(laters));
  }
}

void Session::send(const Outgoing& request, bool has_number) {
  send_numbered(request, write(request), draw(nullptr, has_number), channel::coarse_now());
}

namespace {

// A session that one side has ended on purpose is not there any more; a lost connection is an error
// of the connection, whenever it is met.
[[noreturn]] void refuse_closed(const Error& why) {
  if (why.code() == ErrorCode::connection_error) throw Error(why);
  throw Error(ErrorCode::invalid_operation, "the session has ended: " + why.message());
}

}  // namespace

// The numbers of the next message; a request that waits for its answer is open from now on.
Session::Numbers Session::draw(endpoint::Pending* call, bool has_number) {
  const std::lock_guard lock(mutex_);
  if (why_closed_) refuse_closed(*why_closed_);
  Numbers numbers;
  if (call != nullptr) {
    numbers.request = pending_.add(*call);
  } else if (has_number) {
    numbers.request = pending_.skip();
  }
  numbers.message = next_message_id_++;
  numbers.is_connected = is_connected_;
  return numbers;
}

// Puts a request's headers in front of its elements, and sends it.
void Session::send_numbered(const Outgoing& request, Writer& writer, const Numbers& numbers,
                            channel::Time now) {
  writer.entry({.type = request.type,
                .service_path = request.path,
                .member = request.member,
                .request_id = numbers.request},
               static_cast<std::uint32_t>(request.parameters.size()), 0);
  const bool is_special = static_cast<std::uint16_t>(request.type) < 500;
  MessageHeader header{.sender_node = core_->options().id,
                       .receiver_node = remote_node_,
                       .sender_endpoint = endpoint_,
                       .receiver_endpoint = remote_endpoint_,
                       .message_id = numbers.message,
                       .routing = is_special || !numbers.is_connected};
  if (is_special) {
    header.sender_name = core_->options().name;
    header.receiver_name = remote_name_;
  }
  writer.message(header, 1);
  connection_->send(writer, now);
}

void Session::write_packet_message(Writer& writer, const EntryHeader& header,
                                   std::uint32_t element_count, std::string_view metadata) {
  const Numbers numbers = draw(nullptr, false);
  writer.entry(header, element_count, 0);
  writer.message({.sender_node = core_->options().id,
                  .receiver_node = remote_node_,
                  .sender_endpoint = endpoint_,
                  .receiver_endpoint = remote_endpoint_,
                  .metadata = metadata,
                  .message_id = numbers.message,
                  .routing = false},
                 1);
}

void Session::stream_packet(Writer& writer, const EntryHeader& header, std::string_view metadata) {
  write_packet_message(writer, header, 1, metadata);
  connection_->stream(writer);
}

void Session::reply_packet(Writer& writer, const EntryHeader& header, std::uint32_t element_count,
                           std::string_view metadata) {
  write_packet_message(writer, header, element_count, metadata);
  connection_->reply(writer);
}

bool Session::take(endpoint::Pending& call) {
  const std::lock_guard lock(mutex_);
  return pending_.take(call);
}

void Session::cancel(endpoint::Pending& call, channel::Laters& laters) {
  if (!take(call)) return;
  call.fail(Error(ErrorCode::operation_cancelled, "the call was cancelled"), laters);
  connection_->nudge();
}

void Session::cancel_calls() {
  channel::Laters laters;
  fail_all(Error(ErrorCode::operation_cancelled, "the call was cancelled"), laters);
  connection_->nudge();
  post(std::move(laters));
}

void Session::fail_all(const Error& why, channel::Laters& laters) {
  while (true) {
    endpoint::Pending* call = nullptr;
    {
      const std::lock_guard lock(mutex_);
      call = pending_.take_any();
    }
    if (call == nullptr) return;
    call->fail(why, laters);
  }
}

void Session::post(channel::Laters laters) {
  for (const std::function<void()>& later : laters) {
    if (!core_->reactor().post(later))
      later();  // the node is going away; this thread takes it along
  }
}

void Session::take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                          channel::Laters& laters) {
  endpoint::Pending* call = nullptr;
  {
    const std::lock_guard lock(mutex_);
    call = pending_.take(entry.request_id);
  }
  if (call != nullptr && (entry.type == EntryType::connect_client_ret ||
                          entry.type == EntryType::connect_client_combined_ret)) {
    take_remote(message, entry.error == 0);
  }
  const bool ends_session =
      static_cast<ErrorCode>(entry.error) == ErrorCode::invalid_endpoint;  // 07, section 1
  if (ends_session) {
    laters.emplace_back([self = shared_from_this()] { self->close(); });
    if (call != nullptr) {
      call->fail(Error(ErrorCode::invalid_endpoint, "Invalid Endpoint"), laters);
    }
  } else if (call != nullptr) {
    call->answer(message, entry, owner, laters);
  }
}

}  // namespace rr
