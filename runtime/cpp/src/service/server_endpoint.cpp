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
                                 Way way, std::string_view metadata, bool is_urgent) {
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
}

void ServerEndpoint::stream_packet(Writer& writer, const EntryHeader& header,
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
  } catch (const Error& error) {
    // When the client is gone or does not listen, its connection ends and with it the session.
    if (connection_->is_closed() || error.code() == ErrorCode::connection_error) return;
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
  writer.reset(question.gathering ? question.gathering->version() : connection_->version());
  return writer;
}

// Sends a finished answer, or puts it where those of the same message gather.
void ServerEndpoint::finish(const Question& question, Writer& writer, std::string_view metadata) {
  if (question.gathering) {
    connection_->check_size(writer);
    question.gathering->put(question.place, writer.copy());
  } else {
    send_answer(writer, 1, endpoint::answer_header(question.entry).type, Way::reply, metadata,
                question.is_urgent);
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

void ServerEndpoint::answer_values(const Question& question, EntryType type,
                                   std::span<const Parameter> parameters,
                                   const void* const* values) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.gathering ? question.gathering->version() : connection_->version());
  endpoint::write_values(writer, parameters, values);
  if (writer.failed()) throw endpoint::latched(writer);
  EntryHeader header = endpoint::answer_header(question.entry);
  header.type = type;
  writer.entry(header, static_cast<std::uint32_t>(parameters.size()), 0);
  finish(question, writer);
}

void ServerEndpoint::answer_empty(const Question& question) {
  Writer& writer = channel::thread_writer();
  writer.reset(question.gathering ? question.gathering->version() : connection_->version());
  endpoint::write_empty_answer(writer, question.entry);
  finish(question, writer);
}

void ServerEndpoint::answer_elements(const Question& question, Writer& writer,
                                     std::uint32_t element_count, std::string_view metadata) {
  writer.entry(endpoint::answer_header(question.entry), element_count, 0);
  finish(question, writer, metadata);
}

void ServerEndpoint::answer_nothing(const Question& question) {
  if (question.gathering) question.gathering->put(question.place, {});
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

void ServerEndpoint::answer_late_text(const LateAnswer& late, std::string_view text) {
  Writer& writer = channel::thread_writer();
  writer.reset(late.gathering ? late.gathering->version() : connection_->version());
  writer.string_element("return", text);
  writer.entry(endpoint::answer_header(question_of(late)), 1, 0);
  finish_late(late, writer);
}

void ServerEndpoint::finish_late(const LateAnswer& late, Writer& writer) {
  try {
    if (late.gathering) {
      connection_->check_size(writer);
      late.gathering->put(late.place, writer.copy(), true);
      return;
    }
    const bool is_urgent = late.member != nullptr && (late.member->access & urgent) != 0;
    send_answer(writer, 1, endpoint::answer_header(question_of(late)).type, Way::send, {},
                is_urgent);
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
  std::erase_if(entries_, [](const auto& each) { return each.empty(); });
  const auto endpoint = endpoint_.lock();
  if (endpoint && !entries_.empty()) send(*endpoint, 0, entries_.size(), is_late);
}

void Gathering::send(ServerEndpoint& endpoint, std::size_t first, std::size_t end, bool is_late) {
  Writer& writer = channel::thread_writer();
  writer.reset(version_);
  for (std::size_t i = end; i != first; --i) {
    writer.prepend_bytes(entries_[i - 1].data(), entries_[i - 1].size());
  }
  try {
    // Several entries have no type of their own; one that is left alone is a session's.
    endpoint.send_answer(writer, static_cast<std::uint32_t>(end - first),
                         EntryType::function_call_res,
                         is_late ? ServerEndpoint::Way::send : ServerEndpoint::Way::reply);
    return;
  } catch (const Error& error) {
    // Each fits alone. Otherwise the client is gone.
    if (error.code() != ErrorCode::protocol_error || end - first == 1) return;
  }
  const std::size_t middle = first + (end - first) / 2;
  send(endpoint, first, middle, is_late);
  send(endpoint, middle, end, is_late);
}

void ServerEndpoint::leave() {
  if (is_member_.exchange(false)) host_->remove_client(*this);
  end_members();
  connection_->close_after(close_delay);
}

void ServerEndpoint::lost(const Error& why, channel::Laters& laters) {
  callbacks_.end(why.message(), laters);
  wires_.end_all(laters);
}

void ServerEndpoint::closed() {
  if (is_member_.exchange(false)) host_->remove_client(*this);
  end_members();
  last_object_.reset();
  belongings_.end(this);
  if (std::exchange(is_announced_, false)) {
    host_->release_objects_of(client_.endpoint);
    host_->announce_end(*this);
  }
}

// The client has gone: what it has begun ends with it.
void ServerEndpoint::end_members() {
  channel::Laters laters;
  callbacks_.end("the client has left", laters);
  wires_.end_all(laters);
  callbacks_.post(std::move(laters));
  pipes_.end();
  generators_.end();
}

void ServerEndpoint::release_path(const std::string& path, bool is_told) {
  wires_.release(path);
  pipes_.release(path);
  generators_.release_path(path);
  if (!is_told) return;
  send_packet({.type = EntryType::service_path_released_req, .service_path = path}, {}, nullptr);
}

void ServerEndpoint::attend(channel::Time now) {
  const channel::Milliseconds limit = directory_->core()->options().client_timeout;
  if (is_member_ && now - last_heard_.load() > limit) {
    connection_->close(
        Error(ErrorCode::connection_error, "the client has been silent for too long"));
  }
  channel::Laters laters;
  generators_.drop_unused(now, directory_->core()->options().generator_timeout, laters);
  callbacks_.post(std::move(laters));
}

void ServerEndpoint::take_answer(const Message& message, const Entry& entry, const MemoryRef& owner,
                                 channel::Laters& laters) {
  last_heard_.store(channel::coarse_now(), std::memory_order_relaxed);
  callbacks_.take_answer(message, entry, owner, laters);
  if (static_cast<ErrorCode>(entry.error) == ErrorCode::invalid_endpoint) {  // 07, section 1
    laters.emplace_back([self = shared_from_this()] { self->leave(); });
  }
}

}  // namespace rr::service
