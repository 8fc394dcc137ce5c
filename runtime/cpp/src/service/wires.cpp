// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/wires.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/endpoint/requests.hpp"
#include "runtime/cpp/src/endpoint/slot_terms.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"
#include "runtime/cpp/src/service/offered_wire.hpp"
#include "runtime/cpp/src/service/places.hpp"
#include "runtime/cpp/src/service/response_batch.hpp"
#include "runtime/cpp/src/service/served_wire_end.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {
namespace {

// What they hold ends with the call.
void run(channel::DeferredCallbacks deferred) {  // NOLINT(performance-unnecessary-value-param)
  for (const std::function<void()>& later : deferred) later();
}

// How a client that connects a wire wants its values.
endpoint::SlotMode wanted_mode(const ServerEndpoint& endpoint, const Question& question) {
  if (!endpoint.connection().shares_slots()) return endpoint::SlotMode::messages;
  Decoder decoder = question.decoder();
  return endpoint::find_slot_mode(decoder, question.entry, endpoint::slots_element)
      .value_or(endpoint::SlotMode::messages);
}

// Of the memories whose slots one client reads, whoever else reads them.
constexpr channel::SlotBudget::Limits session_slots{.bytes = std::size_t{128} * 1024 * 1024,
                                                    .count = 64};

}  // namespace

Wires::Wires(ServerEndpoint& endpoint)
    : endpoint_(endpoint), slot_budget_(std::make_shared<channel::SlotBudget>(session_slots)) {}

void Wires::answer(const Question& question) {
  const auto object = endpoint_.find_object(question.entry.service_path);
  const Member& member = endpoint_.find_member(*object, question.entry.member, MemberKind::wire);
  switch (question.entry.type) {
    case EntryType::wire_connect_req:
      answer_connect(question, object, member);
      break;
    case EntryType::wire_disconnect_req:
      answer_disconnect(question, *object, member);
      break;
    case EntryType::wire_peek_in_value_req:
    case EntryType::wire_peek_out_value_req:
      answer_peek(question, *object, member);
      break;
    case EntryType::wire_poke_out_value_req:
      answer_poke(question, *object, member);
      break;
    default:
      answer_packet(question, *object, member);
      break;
  }
}

bool Wires::take(const Message& message, const Entry& entry, const MemoryRef& owner,
                 channel::DeferredCallbacks& deferred) {
  if (entry.type != EntryType::wire_packet) return false;
  const auto end = table_.find(entry.service_path, entry.member);
  if (!end || !endpoint_.is_in_session(message)) return false;
  // Who may not send any more is told so by handle().
  if (!static_cast<ServedWireEnd&>(*end).may_take()) return false;
  end->take(message, entry, owner, *endpoint_.types(), deferred);
  return true;
}

// Packets come here that are not alone in their message, or whose object was found only now; the
// others are dropped (07, section 13).
void Wires::answer_packet(const Question& question, const ServedObject& object,
                          const Member& member) {
  if (const auto end = table_.find(object.path, member.name)) {
    channel::DeferredCallbacks deferred;
    end->take(question.message, question.entry, question.owner, *endpoint_.types(), deferred);
    run(std::move(deferred));
  }
  if (question.batch) question.batch->put_nothing(question.place);
}

// A second request is answered as the first (07, section 13). The object's function is called, and
// may send, before the answer leaves.
void Wires::answer_connect(const Question& question, std::shared_ptr<const ServedObject> object,
                           const Member& member) {
  if (answer_change(question, *object, member)) return;
  if (!table_.find(object->path, member.name)) endpoint_.ask_keeper_to_connect(question, member);
  std::shared_ptr<ServedWireEnd> end;
  endpoint::SlotTerms slots;
  while (!(end = connect(question, object, member, slots))) {
    // It was released meanwhile: the client gets the one that is there now.
    auto next = endpoint_.find_object(question.entry.service_path);
    if (next->type != object->type) {
      throw Error(ErrorCode::object_not_found, "the object was released");
    }
    object = std::move(next);
  }
  answer_connected(question, slots);
  // The notice may have left before the answer, and then is not of what is connected by it.
  if (end->is_released()) end->send_closed();
}

void Wires::answer_connected(const Question& question, const endpoint::SlotTerms& slots) {
  if (slots.id == 0) {
    endpoint_.answer_empty(question);
    return;
  }
  Writer& writer = endpoint_.begin_answer(question);
  const std::uint32_t element_count = endpoint::write_slots(writer, slots);
  writer.entry(endpoint::answer_header(question.entry), element_count, 0);
  endpoint_.finish(question, writer);
}

// False when the request is not one about the slots of a connected wire.
bool Wires::answer_change(const Question& question, const ServedObject& object,
                          const Member& member) {
  if (!endpoint_.connection().shares_slots()) return false;
  Decoder decoder = question.decoder();
  const auto mode =
      endpoint::find_slot_mode(decoder, question.entry, endpoint::slots_again_element);
  if (!mode) return false;
  const auto end = std::static_pointer_cast<ServedWireEnd>(table_.find(object.path, member.name));
  if (!end || !end->is_open()) {
    throw Error(ErrorCode::service_error, "Invalid wire connection");
  }
  answer_connected(question, end->offered().change(end, *mode));
  return true;
}

// Null when the object is no longer the one at its path.
std::shared_ptr<ServedWireEnd> Wires::connect(const Question& question,
                                              const std::shared_ptr<const ServedObject>& object,
                                              const Member& member, endpoint::SlotTerms& slots) {
  auto end = std::static_pointer_cast<ServedWireEnd>(table_.find(object->path, member.name));
  if (!end) {
    end = std::make_shared<ServedWireEnd>(endpoint_.shared_from_this(), object, member);
    if (table_.add(end) != endpoint::WireTable::Added::yes) {
      throw Error(ErrorCode::connection_error, "the client has left");
    }
    end->open();
  }
  const auto give_up = [&] {
    table_.remove(*end);
    channel::DeferredCallbacks deferred;
    end->finish(deferred);
    run(std::move(deferred));
  };
  try {
    if (endpoint_.find_object(object->path) != object) {
      give_up();
      return nullptr;
    }
    // Whoever has changed meanwhile what the session may do has not found it in the table.
    if (!endpoint_.is_still_allowed(question)) throw ServerEndpoint::no_longer_allowed();
    slots = offered(*object->skeleton, member).join(end, wanted_mode(endpoint_, question));
  } catch (...) {
    give_up();
    throw;
  }
  // It may have ended before it could join, and would stay with the object.
  if (!end->is_open()) offered(*object->skeleton, member).leave(*end);
  return end;
}

void Wires::answer_disconnect(const Question& question, const ServedObject& object,
                              const Member& member) {
  const auto end = table_.find(object.path, member.name);
  if (!end) throw Error(ErrorCode::service_error, "Invalid wire connection");
  table_.remove(*end);
  channel::DeferredCallbacks deferred;
  end->finish(deferred);
  run(std::move(deferred));
  endpoint_.answer_empty(question);
}

void Wires::answer_peek(const Question& question, const ServedObject& object,
                        const Member& member) {
  const bool is_out = question.entry.type == EntryType::wire_peek_out_value_req;
  if (is_out && (member.access & readonly) != 0) {
    throw Error(ErrorCode::read_only_member, "Read only member");
  }
  if (!is_out && (member.access & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only member");
  }
  const OfferedWire& wire = offered(*object.skeleton, member);
  const std::shared_ptr<const void> value = is_out ? wire.peek_out() : wire.peek_in();
  Writer& writer = endpoint_.begin_answer(question);
  endpoint::write_wire_value(writer, *member.type, value.get());
  endpoint::write_wire_time(writer, endpoint::as_time_spec(endpoint_.core()->clock().now()));
  writer.entry(endpoint::answer_header(question.entry), endpoint::wire_elements, 0);
  endpoint_.finish(question, writer);
}

void Wires::answer_poke(const Question& question, const ServedObject& object,
                        const Member& member) {
  if ((member.access & readonly) != 0) {
    throw Error(ErrorCode::read_only_member, "Read only member");
  }
  if (member.holding == nullptr) {
    throw Error(ErrorCode::not_implemented_error, "values of this wire cannot be kept");
  }
  TimeSpec time;
  const std::shared_ptr<void> value = member.holding->make();
  endpoint::read_wire(question.message, question.entry, question.owner, *endpoint_.types(),
                      *member.type, time, value.get());
  OfferedWire& wire = offered(*object.skeleton, member);
  wire.keep(value, time);
  wire.tell_received(value.get(), time, endpoint_.client().endpoint);
  endpoint_.answer_empty(question);
}

std::size_t Wires::end_if(const Choice& is_over) {
  std::vector<endpoint::WireTable::End> over;
  for (const auto& end : table_.all()) {
    if (is_over(end->path(), end->member().name)) over.push_back(end);
  }
  for (const auto& end : over) end->close();
  return over.size();
}

void Wires::renew_slots() {
  for (const auto& end : table_.all()) static_cast<ServedWireEnd&>(*end).offered().renew_slots();
}

void Wires::release(std::string_view path) {
  channel::DeferredCallbacks deferred;
  for (const auto& end : table_.take_below(path)) {
    static_cast<ServedWireEnd&>(*end).begin_release();
    end->finish(deferred);
  }
  run(std::move(deferred));
}

void Wires::end_all(channel::DeferredCallbacks& deferred) {
  for (const auto& end : table_.take_all()) end->finish(deferred);
}

}  // namespace rr::service
