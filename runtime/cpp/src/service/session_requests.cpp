// SPDX-License-Identifier: Apache-2.0
// Requests within a session (07, sections 2, 6, 8 and 14).
#include <optional>
#include <utility>

#include "rr/type.hpp"
#include "runtime/cpp/src/channel/logging.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/endpoint/client_version.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/decoded_memory.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/handler_memory.hpp"
#include "runtime/cpp/src/service/object_types.hpp"
#include "runtime/cpp/src/service/request.hpp"
#include "runtime/cpp/src/service/response_batch.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"
#include "runtime/cpp/src/service/service_host.hpp"

namespace rr::service {
namespace {

thread_local ServerEndpoint* current_endpoint = nullptr;
thread_local std::string_view path_of_request;

// While a handler runs.
class CurrentEndpoint {
 public:
  CurrentEndpoint(ServerEndpoint& endpoint, std::string_view path)
      : outer_(std::exchange(current_endpoint, &endpoint)),
        outer_path_(std::exchange(path_of_request, path)) {}
  ~CurrentEndpoint() {
    current_endpoint = outer_;
    path_of_request = outer_path_;
  }
  CurrentEndpoint(const CurrentEndpoint&) = delete;
  CurrentEndpoint& operator=(const CurrentEndpoint&) = delete;

 private:
  ServerEndpoint* const outer_;
  const std::string_view outer_path_;
};

bool is_odd(EntryType type) { return static_cast<std::uint16_t>(type) % 2 != 0; }

// What a request is counted as; nothing for packets.
std::optional<channel::RequestKind> kind_of(EntryType type) {
  using channel::RequestKind;
  switch (type) {
    case EntryType::property_get_req:
      return RequestKind::get;
    case EntryType::property_set_req:
      return RequestKind::set;
    case EntryType::function_call_req:
      return RequestKind::call;
    case EntryType::generator_next_req:
      return RequestKind::next;
    case EntryType::memory_read:
    case EntryType::memory_write:
    case EntryType::memory_get_param:
      return RequestKind::memory;
    case EntryType::wire_peek_in_value_req:
    case EntryType::wire_peek_out_value_req:
    case EntryType::wire_poke_out_value_req:
      return RequestKind::peek;
    case EntryType::wire_connect_req:
    case EntryType::wire_disconnect_req:
    case EntryType::pipe_connect_req:
    case EntryType::pipe_disconnect_req:
      return RequestKind::connect;
    case EntryType::object_type_name:
      return RequestKind::objref;
    case EntryType::pipe_packet:
    case EntryType::wire_packet:
      return std::nullopt;
    default:
      return RequestKind::session;
  }
}

bool is_special(EntryType type) {
  return is_odd(type) && static_cast<std::uint16_t>(type) < 500 &&
         type != EntryType::service_closed;
}

}  // namespace

ServerEndpoint* ServerEndpoint::current() { return current_endpoint; }
std::string_view ServerEndpoint::current_path() { return path_of_request; }

[[gnu::hot]] void ServerEndpoint::handle(const Message& message, const Entry& first,
                                         const MemoryRef& owner) {
  if (connection_->is_closed()) return;  // nobody is left for whom this could be done
  const channel::LogScope scope(core()->options(), *connection_, client_.endpoint);
  last_heard_.store(channel::coarse_now(), std::memory_order_relaxed);
  if (must_wait_for_login(message, first, owner)) return;
  const bool brings_login = has_outcome_;
  const bool asks_type_in_session = first.type == EntryType::object_type_name &&
                                    message.entry_count == 1 && message.receiver_endpoint != 0;
  if (is_special(first.type) && !asks_type_in_session) {
    handle_special(message, first);
  } else if (is_in_session(message)) {
    handle_session(message, first, owner);
  }
  if (brings_login) forget_login();
  // Anything else is for nobody here, and nobody could be answered.
}

// Whether a message is for this session. What it says of its sender counts for nothing: answers go
// to the client that has connected, whose connection this is.
bool ServerEndpoint::is_in_session(const Message& message) const {
  if (!is_member_.load(std::memory_order_relaxed)) return false;
  return message.receiver_endpoint == client_.endpoint &&
         (!message.has_routing || message.receiver_node == directory_->core()->options().id);
}

bool ServerEndpoint::take_packet(const Message& message, const Entry& entry, const MemoryRef& owner,
                                 channel::DeferredCallbacks& deferred) {
  last_heard_.store(channel::coarse_now(), std::memory_order_relaxed);
  return wires_.take(message, entry, owner, deferred);
}

[[gnu::hot]] void ServerEndpoint::handle_session(const Message& message, const Entry& first,
                                                 const MemoryRef& owner) {
  if (message.entry_count == 1) {
    handle_question({message, first, owner, nullptr, 0});
    return;
  }
  Unfinished state = begin_or_continue(message);
  EntryReader entries(message, state.next, state.offset);
  channel::Time until = channel::Clock::now() + channel::longest_turn;
  for (Entry entry; entries.next(entry);) {
    if (connection_->is_closed()) return;
    handle_question({message, entry, owner, state.batch, state.next++});
    connection_->await_strand();
    state.offset = entries.offset();
    if (state.next == message.entry_count) break;
    if (const channel::Time now = channel::Clock::now(); now >= until) {
      if (must_yield() && put_off(state)) return;
      until = now + channel::longest_turn;
    }
  }
}

// The message that was put off last is the first one that is handled again.
ServerEndpoint::Unfinished ServerEndpoint::begin_or_continue(const Message& message) {
  if (unfinished_.empty()) {
    return {.batch = std::make_shared<ResponseBatch>(shared_from_this(), message.entry_count)};
  }
  Unfinished state = std::move(unfinished_.back());
  unfinished_.pop_back();
  return state;
}

// A thread that does not poll is held, which others of its session's address may have to wait for.
bool ServerEndpoint::must_yield() {
  channel::Reactor& reactor = directory_->core()->reactor();
  return !reactor.is_polling() || reactor.holds_up_others();
}

// A message with so many requests that others have to wait for long: they come first, now and
// then. Not with the outcome of a login, which is for this time only.
bool ServerEndpoint::put_off(const Unfinished& state) {
  if (has_outcome_ || !connection_->suspend()) return false;
  unfinished_.push_back(state);
  directory_->core()->reactor().post([connection = connection_] { connection->resume(); });
  return true;
}

[[gnu::hot]] void ServerEndpoint::handle_question(Question question) {
  const Entry& entry = question.entry;
  const bool is_answered =
      is_odd(entry.type) && static_cast<ErrorCode>(entry.error) != ErrorCode::invalid_endpoint;
  if (!is_answered) {
    if (is_odd(entry.type)) leave();  // the client does not know of the session any more
    if (entry.type == EntryType::pipe_packet_ret &&
        access_.may_receive(entry.type, entry.service_path, entry.member)) {
      pipes_.take_acknowledgements(question);
    }
    answer_nothing(question);
    return;
  }
  DecodedMemory decoded(*this, question);
  question.decoded = &decoded;
  if (core()->reactor().metrics() != nullptr) question.begun = channel::Clock::now();
  const CurrentEndpoint current(*this, entry.service_path);
  std::exception_ptr exception;
  try {
    answer_question(question);
    if (!question.is_put_off) count(entry.type, question.begun, ErrorCode::none);
    return;
  } catch (...) {
    exception = std::current_exception();
  }
  try {
    const Error error = endpoint::describe(exception);
    count(entry.type, question.begun, error.code());
    answer_error(question, error);
  } catch (const Error& error) {
    directory_->core()->log(LogLevel::error, error.what());
    // The client would wait for the answer.
    if (error.code() == ErrorCode::out_of_system_resource) connection_->close(error);
  }
}

[[gnu::hot]] void ServerEndpoint::count(EntryType request, channel::Time begun,
                                        ErrorCode code) const {
  channel::Metrics* const metrics = core()->reactor().metrics();
  if (metrics == nullptr) return;
  const auto kind = kind_of(request);
  if (kind) metrics->count_request(*kind, channel::Clock::now() - begun, code);
}

[[gnu::hot]] void ServerEndpoint::answer_question(Question& question) {
  check_access(question);
  switch (question.entry.type) {
    case EntryType::property_get_req:
    case EntryType::property_set_req:
      answer_member(question, MemberKind::property);
      break;
    case EntryType::function_call_req:
      answer_member(question, MemberKind::function);
      break;
    case EntryType::generator_next_req:
      answer_generator_step(question);
      break;
    case EntryType::memory_read:
    case EntryType::memory_write:
    case EntryType::memory_get_param:
      answer_memory(question);
      break;
    case EntryType::pipe_packet:
      pipes_.take_packets(question);
      break;
    case EntryType::pipe_connect_req:
      pipes_.connect(question);
      break;
    case EntryType::pipe_disconnect_req:
      pipes_.disconnect(question);
      break;
    case EntryType::object_type_name:
      if (question.batch) {
        throw Error(ErrorCode::protocol_error, "Unknown request type");
      }
      answer_session_object_type(question);
      break;
    case EntryType::client_keep_alive_req:
      answer_empty(question);
      break;
    case EntryType::service_check_capability_req:
    case EntryType::endpoint_check_capability: {
      const std::uint32_t level = 0;
      answer_value(question, "return", type_of<std::uint32_t>, &level);
      break;
    }
    case EntryType::client_session_op_req:
      answer_session_operation(question);
      break;
    case EntryType::wire_packet:
    case EntryType::wire_connect_req:
    case EntryType::wire_disconnect_req:
    case EntryType::wire_peek_in_value_req:
    case EntryType::wire_peek_out_value_req:
    case EntryType::wire_poke_out_value_req:
      wires_.answer(question);
      break;
    default:
      throw Error(ErrorCode::protocol_error, "Unknown request type");
  }
}

void ServerEndpoint::answer_session_object_type(const Question& question) {
  const Entry& entry = question.entry;
  const auto object = find_object(entry.service_path);
  Decoder decoder = question.decoder();
  std::optional<DefinitionVersion> version;
  std::string_view text;
  if (endpoint::find_text(decoder, entry, "clientversion", text)) {
    version = endpoint::parse_version(text);
  }
  const auto type = type_for(*object->type, version);
  if (!type) throw Error(ErrorCode::object_not_found, "no type for this version of the client");
  answer_value(question, "objecttype", type_of<std::string>, &*type);
}

[[gnu::hot]] std::shared_ptr<const ServedObject> ServerEndpoint::find_object(
    std::string_view path) {
  ObjectTree& objects = host_->objects();
  const std::uint32_t generation = objects.generation();
  if (last_path_ == path && last_generation_ == generation) {
    if (auto object = last_object_.lock()) return object;
  }
  auto object = objects.find(path, client_.endpoint);
  last_path_ = path;
  last_object_ = object;
  last_member_ = nullptr;
  last_generation_ = generation;
  return object;
}

[[gnu::hot]] const Member& ServerEndpoint::find_member(const ServedObject& object,
                                                       std::string_view name, MemberKind kind) {
  if (last_member_ != nullptr && last_member_->name == name && last_member_->kind == kind) {
    return *last_member_;
  }
  const auto place = object.members->find(name);
  if (!place || object.type->members[*place].kind != kind) {
    throw Error(ErrorCode::member_not_found, "Member not found");
  }
  last_member_ = &object.type->members[*place];
  return *last_member_;
}

[[gnu::hot]] void ServerEndpoint::answer_member(Question& question, MemberKind kind) {
  const auto object = find_object(question.entry.service_path);
  const Member& member = find_member(*object, question.entry.member, kind);
  question.is_urgent = (member.access & urgent) != 0;
  const bool is_set = question.entry.type == EntryType::property_set_req;
  if (is_set && (member.access & readonly) != 0) {
    throw Error(ErrorCode::read_only_member, "Read only property");
  }
  if (!is_set && (member.access & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only property");
  }
  HandlerMemory made(*this, question, is_set ? 0 : host_->answer_sizes().expected(member));
  if (member.parameters.empty()) made.expect();
  Request::Source source{*this, question, *host_->types(), member, object, is_set, made};
  Request request(source);
  try {
    const auto place = static_cast<std::size_t>(&member - object->type->members.data());
    object->skeleton->rr_dispatch(place, request);
  } catch (...) {
    if (source.state == Request::Source::State::open) throw;
    directory_->core()->log(LogLevel::error, "`" + std::string(member.name) +
                                                 "` has thrown after it had answered: " +
                                                 endpoint::text_of_current_exception());
  }
  source.complete();
}

}  // namespace rr::service

namespace rr {

std::uint32_t ServiceContext::current_client() {
  const service::ServerEndpoint* const endpoint = service::ServerEndpoint::current();
  return endpoint != nullptr ? endpoint->client().endpoint : 0;
}

std::shared_ptr<const User> ServiceContext::current_user() {
  const service::ServerEndpoint* const endpoint = service::ServerEndpoint::current();
  return endpoint != nullptr ? endpoint->user() : nullptr;
}

}  // namespace rr
