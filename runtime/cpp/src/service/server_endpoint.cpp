// SPDX-License-Identifier: Apache-2.0
// What a service's end of a connection sends, and how it ends.
#include "runtime/cpp/src/service/server_endpoint.hpp"

#include <utility>

#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/gathering.hpp"
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
      last_heard_(channel::coarse_now()) {}

ServerEndpoint::~ServerEndpoint() {
  if (client_.endpoint != 0) directory_->core()->release_endpoint(client_.endpoint);
}

// Ends a message of answers, or of one packet, with its header, and sends it.
void ServerEndpoint::send_answer(Writer& writer, std::uint32_t entry_count, EntryType single_type,
                                 bool is_reply) {
  const endpoint::Core& core = *directory_->core();
  const auto type = static_cast<std::uint16_t>(single_type);
  const bool is_single = entry_count == 1;
  MessageHeader header{
      .sender_node = core.options().id,
      .receiver_node = client_.node,
      .sender_endpoint = client_.endpoint,
      .receiver_endpoint = remote_endpoint_,
      // The reference answers the question for a type twice; the number of the second
      // answer is left out here, so that all others are as it would count them.
      .message_id = draw_message_id(single_type == EntryType::object_type_name_ret ? 2 : 1),
      .routing = is_single && type > 0 && type < 500};
  if (is_single &&
      ((type > 0 && type <= 500) || single_type == EntryType::endpoint_check_capability_ret)) {
    header.sender_name = core.options().name;
  }
  writer.message(header, entry_count);
  if (is_reply) {
    connection_->reply(writer);
  } else {
    connection_->send(writer);
  }
}

void ServerEndpoint::send_packet(const EntryHeader& header, std::span<const Parameter> parameters,
                                 const void* const* values) {
  Writer& writer = channel::thread_writer();
  writer.reset(connection_->version());
  endpoint::write_values(writer, parameters, values);
  if (writer.failed()) throw endpoint::latched(writer);
  writer.entry(header, static_cast<std::uint32_t>(parameters.size()), 0);
  try {
    send_answer(writer, 1, header.type, false);
  } catch (const Error&) {
    // The client is gone or does not listen; its connection ends and with it the session.
  }
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
  writer.reset(question.gathering ? question.gathering->version() : connection_->version());
  return writer;
}

// Sends a finished answer, or puts it where those of the same message gather.
void ServerEndpoint::finish(const Question& question, Writer& writer) {
  if (question.gathering) {
    question.gathering->put(question.place, writer.copy());
  } else {
    send_answer(writer, 1, endpoint::answer_header(question.entry).type, true);
  }
}

void ServerEndpoint::answer_value(const Question& question, std::string_view name, const Type& type,
                                  const void* value) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.gathering ? question.gathering->version() : connection_->version());
  type.write(writer, name, value);
  if (writer.failed()) throw endpoint::latched(writer);
  writer.entry(endpoint::answer_header(question.entry), 1, 0);
  finish(question, writer);
}

void ServerEndpoint::answer_empty(const Question& question) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.gathering ? question.gathering->version() : connection_->version());
  endpoint::write_empty_answer(writer, question.entry);
  finish(question, writer);
}

void ServerEndpoint::answer_error(const Question& question, const Error& error) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.gathering ? question.gathering->version() : connection_->version());
  endpoint::write_error_answer(writer, question.entry, error);
  finish(question, writer);
}

namespace {

Entry question_of(const ServerEndpoint::LateAnswer& late) {
  Entry entry;
  entry.type = late.request_type;
  entry.service_path = late.path;
  entry.member = late.member_name;
  entry.request_id = late.request_id;
  return entry;
}

}  // namespace

void ServerEndpoint::answer_late(const LateAnswer& late, const void* result) {
  const Entry entry = question_of(late);
  Writer& writer = channel::thread_writer();
  writer.reset(late.gathering ? late.gathering->version() : connection_->version());
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
  writer.entry(endpoint::answer_header(entry), count, 0);
  finish_late(late, writer);
}

void ServerEndpoint::answer_late(const LateAnswer& late, const Error& error) {
  Writer& writer = channel::thread_writer();
  writer.reset(late.gathering ? late.gathering->version() : connection_->version());
  endpoint::write_error_answer(writer, question_of(late), error);
  finish_late(late, writer);
}

void ServerEndpoint::finish_late(const LateAnswer& late, Writer& writer) {
  if (late.gathering) {
    late.gathering->put(late.place, writer.copy(), true);
    return;
  }
  try {
    send_answer(writer, 1, endpoint::answer_header(question_of(late)).type, false);
  } catch (const Error& error) {
    if (connection_->is_closed() || error.code() == ErrorCode::connection_error) return;
    answer_late(late, error);  // the answer was too large
  }
}

void Gathering::put(std::size_t place, std::vector<std::byte> entry, bool is_late) {
  {
    const std::lock_guard lock(mutex_);
    entries_[place] = std::move(entry);
    if (--missing_ != 0) return;
  }
  Writer& writer = channel::thread_writer();
  writer.reset(version_);
  std::uint32_t count = 0;
  for (auto each = entries_.rbegin(); each != entries_.rend(); ++each) {
    if (each->empty()) continue;
    writer.prepend_bytes(each->data(), each->size());
    ++count;
  }
  // Several entries have no type of their own; one that is left alone is a session's.
  if (count == 0) return;
  try {
    endpoint_->send_answer(writer, count, EntryType::function_call_res, !is_late);
  } catch (const Error&) {
    // Too large together, or the client is gone: it runs into its time limit.
  }
}

void ServerEndpoint::leave() {
  channel::Laters laters;
  wires_.end_all(laters);
  for (const std::function<void()>& later : laters) later();
  if (is_member_.exchange(false)) host_->remove_client(*this);
  connection_->close_after(close_delay);
}

void ServerEndpoint::lost(const Error& /*why*/, channel::Laters& laters) { wires_.end_all(laters); }

void ServerEndpoint::closed() {
  if (is_member_.exchange(false)) host_->remove_client(*this);
  last_object_.reset();
}

void ServerEndpoint::attend(channel::Time now) {
  const channel::Milliseconds limit = directory_->core()->options().client_timeout;
  if (is_member_ && now - last_heard_.load() > limit) {
    connection_->close(
        Error(ErrorCode::connection_error, "the client has been silent for too long"));
  }
}

// No request of ours is ever open: callbacks are not served.
void ServerEndpoint::take_answer(const Message& /*message*/, const Entry& /*entry*/,
                                 const MemoryRef& /*owner*/, channel::Laters& /*laters*/) {}

}  // namespace rr::service
