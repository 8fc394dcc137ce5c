// SPDX-License-Identifier: Apache-2.0
// Requests and their answers.
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/client/generator.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"

namespace rr {

Session::Milliseconds Session::timeout_for(Milliseconds timeout, const CallTerms& terms) const {
  if (terms.timeout.count() != 0) return terms.timeout;
  if (timeout.count() != 0) return timeout;
  if (options_.request_timeout.count() != 0) return options_.request_timeout;
  return core_->options().request_timeout;
}

[[gnu::hot]] void Session::call(const Outgoing& request, const Incoming& answer,
                                Milliseconds timeout) {
  const auto read = [&](Decoder& decoder, const Message&, const Entry& entry) {
    if (answer.type != nullptr) {
      endpoint::read_value(decoder, entry, answer.element, *answer.type, answer.value);
    }
  };
  endpoint::BlockingCallOf call(*this, read);
  perform(request, call, timeout);
}

[[gnu::hot]] void Session::call(const Outgoing& request, const AnswerReader& read,
                                Milliseconds timeout) {
  endpoint::BlockingCallOf call(*this, read);
  perform(request, call, timeout);
}

[[gnu::hot]] Writer& Session::write(const Outgoing& request) const {
  Writer& writer = channel::thread_writer();
  writer.reset(connection_->version());
  endpoint::write_values(writer, request.parameters, request.values);
  if (writer.failed()) throw endpoint::latched(writer);
  return writer;
}

namespace {

using endpoint::Asked;

Asked asked(const Outgoing& request) {
  return request.opens_generator ? Asked::opening(request.type, request.path, request.member)
                                 : Asked(request.type, request.path, request.member);
}

// An opening that nobody waits for any more is remembered beyond the call.
Asked asked_while_open(const Outgoing& request) {
  return request.opens_generator ? asked(request)
                                 : Asked::while_open(request.type, request.path, request.member);
}

}  // namespace

[[gnu::hot]] void Session::perform(const Outgoing& request, endpoint::BlockingCall& call,
                                   Milliseconds timeout) {
  const CallTerms terms = CallTerms::of_blocking_call();
  const channel::Time now = channel::coarse_now();
  const channel::Time deadline = channel::after(now, timeout_for(timeout, terms));
  Writer& writer = write(request);
  call.perform(terms, deadline, now, [&](endpoint::Pending& open) {
    number(request, writer, draw(open, request, asked_while_open(request)));
    connection_->send_call(writer, now, endpoint::priority_of(request.type, request.is_urgent));
  });
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
  const CallTerms terms = CallTerms::of_started_call();
  const auto call = std::make_shared<endpoint::AsyncCall>(shared_from_this(), std::move(read),
                                                          std::move(completion));
  call->start(
      timeout_for(timeout, terms), terms, [&]() -> Writer& { return write(request); },
      [&](endpoint::Pending& open, Writer& writer) {
        number(request, writer, draw(open, request, asked(request)));
        const auto priority = endpoint::priority_of(request.type, request.is_urgent);
        if (priority == channel::Priority::usual) {
          connection_->stream(writer);  // it may be one of many
        } else {
          connection_->send(writer, channel::coarse_now(), priority);
        }
      });
}

void Session::send(const Outgoing& request, bool has_number) {
  Writer& writer = write(request);
  number(request, writer, draw(request, has_number));
  connection_->send(writer, channel::coarse_now(),
                    endpoint::priority_of(request.type, request.is_urgent));
}

namespace {

// A session that one side has ended on purpose is not there any more; a lost connection is an error
// of the connection, whenever it is met.
[[noreturn]] void refuse_closed(const Error& why) {
  if (why.code() == ErrorCode::connection_error) throw Error(why);
  throw Error(ErrorCode::invalid_operation, "the session has ended: " + why.message());
}

}  // namespace

void Session::refuse_ended() const {
  const MutexLock lock(mutex_);
  refuse_closed(why_closed_.value());
}

Session::Numbers Session::draw_numbers(bool has_name) {
  if (why_closed_) refuse_closed(*why_closed_);
  Numbers numbers{.message = next_message_id_++,
                  .is_connected = is_connected_,
                  .remote_endpoint = remote_.endpoint,
                  .remote_node = remote_.node,
                  .remote_name = {}};
  if (has_name) numbers.remote_name = remote_.name;
  return numbers;
}

namespace {

// Node names travel with what may not have found its session yet.
bool is_special(EntryType type) { return static_cast<std::uint16_t>(type) < 500; }

}  // namespace

// A request that waits for its answer is open from now on.
[[gnu::hot]] Session::Numbers Session::draw(endpoint::Pending& call, const Outgoing& request,
                                            endpoint::Asked asked) {
  const MutexLock lock(mutex_);
  Numbers numbers = draw_numbers(is_special(request.type));
  numbers.request = pending_.add(call, std::move(asked));
  return numbers;
}

[[gnu::hot]] Session::Numbers Session::draw(const Outgoing& request, bool has_number) {
  const MutexLock lock(mutex_);
  Numbers numbers = draw_numbers(is_special(request.type));
  if (has_number) numbers.request = pending_.skip();
  return numbers;
}

// Puts a request's headers in front of its elements.
[[gnu::hot]] void Session::number(const Outgoing& request, Writer& writer,
                                  const Numbers& numbers) const {
  writer.entry({.type = request.type,
                .service_path = request.path,
                .member = request.member,
                .request_id = numbers.request,
                .error = static_cast<std::uint16_t>(request.error)},
               static_cast<std::uint32_t>(request.parameters.size()), 0);
  const bool has_names = is_special(request.type);
  MessageHeader header{.sender_node = core_->options().id,
                       .receiver_node = numbers.remote_node,
                       .sender_endpoint = endpoint_,
                       .receiver_endpoint = numbers.remote_endpoint,
                       .message_id = numbers.message,
                       .routing = has_names || !numbers.is_connected};
  if (has_names) {
    header.sender_name = core_->options().name;
    header.receiver_name = numbers.remote_name;
  }
  writer.message(header, 1);
}

// Of a wire, so that the service is connected and what is known of it does not change.
void Session::send_newest(Writer& writer, const EntryHeader& header, std::uint32_t element_count,
                          const channel::Newest& newest) {
  writer.entry(header, element_count, 0);
  writer.message({.sender_node = core_->options().id,
                  .receiver_node = known_remote().node,
                  .sender_endpoint = endpoint_,
                  .receiver_endpoint = known_remote().endpoint,
                  .metadata = header.metadata,
                  .message_id = next_message_id_++,
                  .routing = false},
                 1);
  connection_->send_newest(writer, newest, channel::coarse_now());
}

void Session::write_packet_message(Writer& writer, const EntryHeader& header,
                                   std::uint32_t element_count, std::string_view metadata) {
  const Numbers numbers = draw({header.type, {}, {}}, false);
  writer.entry(header, element_count, 0);
  writer.message({.sender_node = core_->options().id,
                  .receiver_node = numbers.remote_node,
                  .sender_endpoint = endpoint_,
                  .receiver_endpoint = numbers.remote_endpoint,
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
  const MutexLock lock(mutex_);
  return pending_.take(call);
}

void Session::cancel_calls() {
  channel::DeferredCallbacks deferred;
  fail_all(Error(ErrorCode::operation_cancelled, "the call was cancelled"), deferred);
  connection_->nudge();
  post(std::move(deferred));
}

void Session::fail_all(const Error& why, channel::DeferredCallbacks& deferred) {
  while (true) {
    endpoint::Pending* call = nullptr;
    {
      const MutexLock lock(mutex_);
      call = pending_.take_any();
    }
    if (call == nullptr) return;
    call->fail(why, deferred);
  }
}

// The generator was opened although nobody waits for it any more.
void Session::end_abandoned(const Message& message, const Entry& entry, const MemoryRef& owner,
                            const endpoint::Asked::Opening& opening,
                            channel::DeferredCallbacks& deferred) {
  std::int32_t index = 0;
  try {
    Decoder decoder(message.version, &message.strings, owner, types().get());
    endpoint::read_value(decoder, entry, "index", type_of<std::int32_t>, &index);
  } catch (const Error&) {
    return;  // it has no number by which it could be ended
  }
  deferred.emplace_back([self = shared_from_this(), opening, index] {
    client::abort_generator(*self, opening.path, opening.member, index);
  });
}

[[gnu::hot]] void Session::take_answer(const Message& message, const Entry& entry,
                                       const MemoryRef& owner,
                                       channel::DeferredCallbacks& deferred) {
  endpoint::PendingTable::Answered answered;
  {
    const MutexLock lock(mutex_);
    answered = pending_.take_answered(entry);
  }
  if (answered.is_foreign && !has_told_foreign_.exchange(true)) {
    deferred.push_back(
        endpoint::tell_foreign_answer(core_, "the service `" + service_ + "`", entry));
  }
  if (answered.abandoned && entry.error == 0) {
    end_abandoned(message, entry, owner, *answered.abandoned, deferred);
  }
  if (answered.request != nullptr && (entry.type == EntryType::connect_client_ret ||
                                      entry.type == EntryType::connect_client_combined_ret)) {
    take_remote(message, entry.error == 0);
  }
  const bool ends_session =
      static_cast<ErrorCode>(entry.error) == ErrorCode::invalid_endpoint;  // 07, section 1
  if (ends_session) {
    deferred.emplace_back([self = shared_from_this()] { self->close(); });
    if (answered.request != nullptr) {
      answered.request->fail(Error(ErrorCode::invalid_endpoint, "Invalid Endpoint"), deferred);
    }
  } else if (answered.request != nullptr) {
    answered.request->answer(message, entry, owner, deferred);
  }
}

}  // namespace rr
