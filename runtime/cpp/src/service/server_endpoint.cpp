// SPDX-License-Identifier: Apache-2.0
// What a service's end of a connection sends, and how it ends.
#include "runtime/cpp/src/service/server_endpoint.hpp"

#include <tuple>
#include <utility>

#include "runtime/cpp/src/channel/logging.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/decoded_memory.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/handler_memory.hpp"
#include "runtime/cpp/src/service/response_batch.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {
namespace {

// The socket is closed so long after a farewell (04, section 5).
constexpr channel::Milliseconds close_delay{100};

}  // namespace

ServerEndpoint::ServerEndpoint(std::shared_ptr<Directory> directory,
                               std::shared_ptr<channel::Connection> connection)
    : directory_(std::move(directory)),
      connection_(std::move(connection)),
      owed_answers_(std::make_shared<OwedAnswers>(connection_->account())),
      last_heard_(channel::coarse_now()) {}

std::string ServerEndpoint::service_name() const { return host_ ? host_->name() : std::string(); }

ServerEndpoint::~ServerEndpoint() {
  if (client_.endpoint != 0) directory_->core()->release_endpoint(client_.endpoint);
}

// Ends a message of answers, or of one packet, with its header, and sends it.
[[gnu::hot]] void ServerEndpoint::send_answer(Writer& writer, std::uint32_t entry_count,
                                              EntryType single_type, Way way,
                                              std::string_view metadata, bool is_urgent) {
  const endpoint::Core& core = *directory_->core();
  const auto type = static_cast<std::uint16_t>(single_type);
  const bool is_single = entry_count == 1;
  MessageHeader header{
      .sender_node = core.options().id,
      .receiver_node = client_.node,
      .sender_endpoint = client_.endpoint,
      .receiver_endpoint = remote_endpoint_,
      .metadata = metadata,
      // The reference answers the question for a type twice; the number of the second
      // answer is left out here, so that all others are as it would count them.
      .message_id = draw_message_id(single_type == EntryType::object_type_name_ret ? 2 : 1),
      .routing = is_single && type > 0 && type < 500};
  if (is_single &&
      ((type > 0 && type <= 500) || single_type == EntryType::endpoint_check_capability_ret)) {
    header.sender_name = core.options().name;
  }
  writer.message(header, entry_count);
  const channel::Priority priority = endpoint::priority_of(single_type, is_urgent);
  switch (way) {
    case Way::reply:
      connection_->reply(writer, priority);
      break;
    case Way::send:
      connection_->send(writer, channel::coarse_now(), priority);
      break;
    case Way::stream:
      connection_->stream(writer);
      break;
  }
  writer.release();  // the thread may not write anything for long, and nobody is charged for it
}

[[gnu::hot]] void ServerEndpoint::stream_packet(Writer& writer, const EntryHeader& header,
                                                std::string_view metadata) {
  writer.entry(header, 1, 0);
  send_answer(writer, 1, header.type, Way::stream, metadata);
}

void ServerEndpoint::send_packet(const EntryHeader& header, std::span<const Parameter> parameters,
                                 const void* const* values, bool is_urgent) {
  Writer& writer = channel::thread_writer();
  writer.reset(connection_->version());
  endpoint::write_values(writer, parameters, values);
  if (writer.failed()) throw endpoint::latched(writer);
  writer.entry(header, static_cast<std::uint32_t>(parameters.size()), 0);
  try {
    send_answer(writer, 1, header.type, Way::send, {}, is_urgent);
    is_told_full_.store(false, std::memory_order_relaxed);
  } catch (const Error& error) {
    // When the client is gone or does not listen, its connection ends and with it the session.
    if (connection_->is_closed() || error.code() == ErrorCode::connection_error) return;
    // Once, not for each packet to a client that takes none.
    if (error.code() == ErrorCode::out_of_system_resource && is_told_full_.exchange(true)) return;
    directory_->core()->log(LogLevel::error, "`" + std::string(header.member) + "` of `" +
                                                 std::string(header.service_path) +
                                                 "` was not sent to a client: " + error.what());
  }
}

void ServerEndpoint::send_request(Writer& entry, EntryType type, bool is_urgent) {
  send_answer(entry, 1, type, Way::send, {}, is_urgent);
}

void ServerEndpoint::send_marked(Writer& writer, std::string_view metadata,
                                 const channel::Newest* newest) {
  writer.message({.sender_node = core()->options().id,
                  .receiver_node = client_.node,
                  .sender_endpoint = client_.endpoint,
                  .receiver_endpoint = remote_endpoint_,
                  .metadata = metadata,
                  .message_id = draw_message_id(),
                  .routing = false},
                 1);
  if (newest != nullptr) {
    connection_->send_newest(writer, *newest, channel::coarse_now());
  } else {
    connection_->send(writer);
  }
}

const std::shared_ptr<endpoint::Core>& ServerEndpoint::core() const { return directory_->core(); }

const std::shared_ptr<const TypeRegistry>& ServerEndpoint::types() const { return host_->types(); }

Writer& ServerEndpoint::begin_answer(const Question& question) const {
  Writer& writer = channel::thread_writer();
  writer.reset(question.batch ? question.batch->version() : connection_->version());
  return writer;
}

// A user who has gone meanwhile, or may not have it any more, gets an error instead.
[[gnu::hot]] void ServerEndpoint::finish(const Question& question, Writer& writer,
                                         std::string_view metadata) {
  if (!is_still_allowed(question)) throw no_longer_allowed();
  deliver(question, writer, metadata);
}

// Sends a finished answer, or puts it where those of the same message gather.
void ServerEndpoint::deliver(const Question& question, Writer& writer, std::string_view metadata) {
  if (question.batch) {
    question.batch->put(question.place, question.entry, writer);
  } else {
    send_answer(writer, 1, endpoint::answer_header(question.entry).type, Way::reply, metadata,
                question.is_urgent);
  }
}

void ServerEndpoint::answer_value(const Question& question, std::string_view name, const Type& type,
                                  const void* value) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.batch ? question.batch->version() : connection_->version());
  type.write(writer, name, value);
  if (writer.failed()) throw endpoint::latched(writer);
  writer.entry(endpoint::answer_header(question.entry), 1, 0);
  finish(question, writer);
}

[[gnu::hot]] void ServerEndpoint::answer_result(const Question& question, const Member& member,
                                                HandlerMemory& made, const void* value) {
  const channel::OfferedCharge made_before(made.end());
  // What the request has brought goes when its handler has returned, which is soon.
  const channel::OfferedCharge decoded(question.decoded != nullptr ? question.decoded->end()
                                                                   : channel::Charge());
  Writer& writer = begin_answer(question);
  writer.attach_texts();
  member.type->write(writer, member.kind == MemberKind::function ? "return" : "value", value);
  if (writer.failed()) throw endpoint::latched(writer);
  host_->answer_sizes().note(member, writer.size());
  writer.entry(endpoint::answer_header(question.entry), 1, 0);
  finish(question, writer);
}

void ServerEndpoint::answer_values(const Question& question, EntryType type,
                                   std::span<const Parameter> parameters,
                                   const void* const* values) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.batch ? question.batch->version() : connection_->version());
  endpoint::write_values(writer, parameters, values);
  if (writer.failed()) throw endpoint::latched(writer);
  EntryHeader header = endpoint::answer_header(question.entry);
  header.type = type;
  writer.entry(header, static_cast<std::uint32_t>(parameters.size()), 0);
  finish(question, writer);
}

void ServerEndpoint::answer_empty(const Question& question) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.batch ? question.batch->version() : connection_->version());
  endpoint::write_empty_answer(writer, question.entry);
  finish(question, writer);
}

void ServerEndpoint::answer_elements(const Question& question, Writer& writer,
                                     std::uint32_t element_count, std::string_view metadata) {
  writer.entry(endpoint::answer_header(question.entry), element_count, 0);
  finish(question, writer, metadata);
}

void ServerEndpoint::answer_nothing(const Question& question) {
  if (question.batch) question.batch->put_nothing(question.place);
}

void ServerEndpoint::answer_error(const Question& question, const Error& error) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.batch ? question.batch->version() : connection_->version());
  endpoint::write_error_answer(writer, question.entry, error);
  deliver(question, writer);
}

namespace {

Entry question_of(const LateAnswer& late) {
  Entry entry;
  entry.type = late.request_type;
  entry.service_path = late.path;
  entry.member = late.member_name;
  entry.request_id = late.request_id;
  return entry;
}

}  // namespace

void ServerEndpoint::answer_late(const LateAnswer& late, const void* result) {
  if (!is_still_allowed(late.admission, late.path, late.member_name)) {
    answer_late(late, no_longer_allowed());
    return;
  }
  const Entry entry = question_of(late);
  Writer& writer = channel::thread_writer();
  writer.reset(late.batch ? late.batch->version() : connection_->version());
  const bool is_call = late.member->kind == MemberKind::function;
  std::uint32_t count = 1;
  if (late.member->type != nullptr && result != nullptr) {
    late.member->type->write(writer, is_call ? "return" : "value", result);
  } else if (is_call) {
    const std::int32_t nothing = 0;
    type_of<std::int32_t>.write(writer, "return", &nothing);
  } else {
    count = 0;
  }
  if (writer.failed()) {
    answer_late(late, endpoint::latched(writer));
    return;
  }
  host_->answer_sizes().note(*late.member, writer.size());
  writer.entry(endpoint::answer_header(entry), count, 0);
  finish_late(late, writer);
}

void ServerEndpoint::answer_late(const LateAnswer& late, const Error& error) {
  Writer& writer = channel::thread_writer();
  writer.reset(late.batch ? late.batch->version() : connection_->version());
  endpoint::write_error_answer(writer, question_of(late), error);
  finish_late(late, writer, error.code());
}

void ServerEndpoint::answer_late_text(const LateAnswer& late, std::string_view text) {
  Writer& writer = channel::thread_writer();
  writer.reset(late.batch ? late.batch->version() : connection_->version());
  writer.string_element("return", text);
  writer.entry(endpoint::answer_header(question_of(late)), 1, 0);
  finish_late(late, writer);
}

void ServerEndpoint::finish_late(const LateAnswer& late, Writer& writer, ErrorCode code) {
  count(late.request_type, late.begun, code);
  const Entry request = question_of(late);
  const auto send = [&] {
    if (late.batch) {
      late.batch->put(late.place, request, writer, true);
      return;
    }
    const bool is_urgent = late.member != nullptr && (late.member->access & urgent) != 0;
    send_answer(writer, 1, endpoint::answer_header(request).type, Way::send, {}, is_urgent);
  };
  try {
    send();
  } catch (const Error& error) {
    if (connection_->is_closed() || error.code() == ErrorCode::connection_error) return;
    // The answer was too large, for a message or for this client.
    writer.reset(late.batch ? late.batch->version() : connection_->version());
    endpoint::write_error_answer(writer, request, error);
    try {
      send();
    } catch (const Error& last) {
      connection_->close(last);
    }
  }
}

std::size_t ServerEndpoint::container_limit() const {
  const NodeOptions& options = core()->options();
  if (!host_ || (host_->requires_user() && !user())) {
    return options.budget.containers_before_login;
  }
  return options.budget.containers != 0 ? options.budget.containers
                                        : 3 * std::size_t{options.limits.message_size};
}

std::size_t ServerEndpoint::generator_limit() const { return host_->limits().generators; }
std::size_t ServerEndpoint::late_answer_limit() const { return host_->limits().late_answers; }
std::size_t ServerEndpoint::callback_limit() const { return host_->limits().callbacks; }

Decoder Question::decoder(const TypeRegistry* types) const {
  Decoder result(message.version, &message.strings, owner, types);
  if (decoded != nullptr) result.set_budget(*decoded);
  return result;
}

void ServerEndpoint::leave() {
  if (is_member_.exchange(false)) host_->remove_client(*this);
  end_members();
  connection_->close_after(close_delay);
}

void ServerEndpoint::lost(const Error& why, channel::DeferredCallbacks& deferred) {
  std::shared_ptr<Logins::Attempt> login;
  {
    const MutexLock lock(user_mutex_);
    login = login_;
  }
  if (login) directory_->logins().cancel(login);
  callbacks_.end(why.message(), deferred);
  wires_.end_all(deferred);
  generators_.end(deferred);
  std::shared_ptr<ServiceHost> host;
  ServiceClient client;
  {
    const MutexLock lock(user_mutex_);
    std::tie(host, client) = session_;
  }
  if (host) host->monitors().leave_lines(client.endpoint);
  announce_leaving(deferred);
}

void ServerEndpoint::closed() {
  const channel::LogScope scope(core()->options(), *connection_, client_.endpoint);
  if (is_member_.exchange(false)) host_->remove_client(*this);
  end_members();
  last_object_.reset();
  unfinished_.clear();
  client_values_.end(this);
  if (std::exchange(is_announced_, false)) {
    host_->release_objects_of(client_.endpoint);
    host_->announce_end(*this);
    audit_.disconnected();
  }
}

// The client has gone: what it has begun ends with it.
void ServerEndpoint::end_members() {
  channel::DeferredCallbacks deferred;
  callbacks_.end("the client has left", deferred);
  wires_.end_all(deferred);
  callbacks_.post(std::move(deferred));
  pipes_.end();
  owed_answers_->end();
  channel::DeferredCallbacks last_moments;
  generators_.end(last_moments);
  announce_leaving(last_moments);
  for (const auto& later : last_moments) later();
}

// Once for each session, whatever ends it.
void ServerEndpoint::announce_leaving(channel::DeferredCallbacks& deferred) {
  const MutexLock lock(user_mutex_);
  if (!present_at_) return;
  deferred.emplace_back([host = std::exchange(present_at_, nullptr), client = session_.second] {
    host->announce_leaving(client);
  });
}

void ServerEndpoint::release_path(const std::string& path) {
  wires_.release(path);
  pipes_.release(path);
  generators_.release_path(path);
  if (!access_.may_send(EntryType::service_path_released_req, path, {})) return;
  send_packet({.type = EntryType::service_path_released_req, .service_path = path}, {}, nullptr);
}

void ServerEndpoint::attend(channel::Time now) {
  const channel::Milliseconds limit = directory_->core()->options().client_timeout;
  if (is_member_ && now - last_heard_.load() > limit) {
    connection_->close(
        Error(ErrorCode::connection_error, "the client has been silent for too long"));
  }
  channel::DeferredCallbacks deferred;
  generators_.drop_unused(now, directory_->core()->options().generator_timeout, deferred);
  callbacks_.post(std::move(deferred));
}

void ServerEndpoint::take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                                 channel::DeferredCallbacks& deferred) {
  last_heard_.store(channel::coarse_now(), std::memory_order_relaxed);
  callbacks_.take_answer(message, entry, owner, deferred);
  if (static_cast<ErrorCode>(entry.error) == ErrorCode::invalid_endpoint) {  // 07, section 1
    deferred.emplace_back([self = shared_from_this()] { self->leave(); });
  }
}

}  // namespace rr::service
