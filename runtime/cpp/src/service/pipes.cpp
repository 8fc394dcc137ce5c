// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/pipes.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/endpoint/pipe_arrival.hpp"
#include "runtime/cpp/src/endpoint/ring_terms.hpp"
#include "runtime/cpp/src/endpoint/values.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/service/places.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {
namespace {

constexpr std::size_t ends_of_a_client = 4096;
// What an endpoint takes without any packet, about.
constexpr std::size_t end_cost = 2048;
constexpr Parameter index_parameter = parameter<std::int32_t>("index");

}  // namespace

struct Pipes::Served final : PipeEnd::State {
  Served(std::shared_ptr<const endpoint::Core> core, std::shared_ptr<endpoint::PipeSide> side,
         Identity what, std::shared_ptr<PipePlace> where)
      : State(std::move(core), std::move(side), std::move(what)), place(std::move(where)) {}

  [[nodiscard]] endpoint::MissedPackets take_missed() override { return place->take_missed(*this); }

  const std::shared_ptr<PipePlace> place;
  channel::Charge charge;  // for the end itself
  // Guarded by the mutex of Pipes.
  bool is_announced = false;           // the client knows of it
  bool is_closed_unannounced = false;  // and must be told that it is gone already
};

Pipes::End Pipes::open(const Question& question, const ServedObject& object, const Member& member) {
  const Entry& entry = question.entry;
  Decoder decoder(question.message.version, &question.message.strings);
  std::int32_t wanted = 0;
  endpoint::read_value(decoder, entry, "index", type_of<std::int32_t>, &wanted);
  Element element;
  const bool is_unreliable =
      (member.access & unreliable) != 0 &&
      find_element(decoder, entry.elements, entry.element_count, "unreliable", element);
  const MutexLock lock(mutex_);
  const auto index = ends_.choose(object.path, member.name, wanted);
  if (!index || ends_.size() >= ends_of_a_client) {
    throw Error(ErrorCode::out_of_system_resource, "too many pipe endpoints");
  }
  channel::Charge charge(connection().account());
  if (!charge.add(end_cost + object.path.size())) {
    throw Error(ErrorCode::out_of_system_resource,
                "the pipe endpoints of this client take too much memory");
  }
  if (!endpoint_.is_still_allowed(question)) throw ServerEndpoint::no_longer_allowed();
  const auto end = std::make_shared<Served>(
      endpoint_.directory_->core(),
      std::shared_ptr<endpoint::PipeSide>(endpoint_.shared_from_this(), this),
      PipeEnd::State::Identity{object.path, &member, member.holding, *index, is_unreliable, false,
                               endpoint_.client().endpoint, endpoint_.client().node},
      Skeleton::Places::of(*object.skeleton).pipe(member.name));
  end->charge = std::move(charge);
  ends_.add(end);
  end->place->add(end);
  return end;
}

void Pipes::connect(const Question& question) {
  const auto object = endpoint_.find_object(question.entry.service_path);
  const Member& member = endpoint_.find_member(*object, question.entry.member, MemberKind::pipe);
  if (answer_ring_again(question, *object, member)) return;
  endpoint_.ask_keeper_to_connect(question, member);
  const End end = open(question, *object, member);
  try {
    // What was released meanwhile has not been found among the ends.
    if (endpoint_.find_object(question.entry.service_path) != object) {
      throw Error(ErrorCode::object_not_found, "the object was released");
    }
    const auto connected = end->place->connected();
    if (connected) connected(PipeEnd(end));
  } catch (...) {
    close(*end, false);
    throw;
  }
  if (!end->is_open()) {
    throw Error(ErrorCode::invalid_operation, "the service has closed this endpoint");
  }
  channel::PipeRingStart ring;
  if (wants_ring(question, endpoint::ring_element)) ring = join_ring(end);
  Writer& writer = endpoint_.begin_answer(question);
  std::uint32_t count = 1;
  if (ring.id != 0) {
    endpoint::write_ring(writer, ring);
    ++count;
  }
  if (end->identity.is_unreliable) {
    const std::int32_t is_unreliable = 1;
    type_of<std::int32_t>.write(writer, "unreliable", &is_unreliable);
    ++count;
  }
  type_of<std::int32_t>.write(writer, "index", &end->identity.index);
  endpoint_.answer_elements(question, writer, count);
  {
    const MutexLock lock(mutex_);
    end->is_announced = true;
    if (!end->is_closed_unannounced) return;
  }
  send_closed(*end);
}

// Rings

// Whether the client of a connection with shared memory asks for a ring.
bool Pipes::wants_ring(const Question& question, std::string_view element) const {
  if (!connection().shares_slots()) return false;
  Decoder decoder = question.decoder();
  return endpoint::find_ring_wish(decoder, question.entry, element) == endpoint::RingWish::ring;
}

// False when the request is not one about the ring of an endpoint that is connected.
bool Pipes::answer_ring_again(const Question& question, const ServedObject& object,
                              const Member& member) {
  if (!connection().shares_slots()) return false;
  Decoder decoder = question.decoder();
  const auto wish = endpoint::find_ring_wish(decoder, question.entry, endpoint::ring_again_element);
  if (!wish) return false;
  std::int32_t index = 0;
  endpoint::read_value(decoder, question.entry, "index", type_of<std::int32_t>, &index);
  End end;
  {
    const MutexLock lock(mutex_);
    end = std::static_pointer_cast<Served>(ends_.find(object.path, member.name, index));
  }
  if (!end) throw Error(ErrorCode::invalid_argument, "Invalid pipe");
  end->place->leave_ring(end);
  channel::PipeRingStart ring;
  if (*wish == endpoint::RingWish::ring) ring = join_ring(end);
  if (ring.id == 0) {
    endpoint_.answer_empty(question);
    return true;
  }
  Writer& writer = endpoint_.begin_answer(question);
  endpoint::write_ring(writer, ring);
  endpoint_.answer_elements(question, writer, 1);
  return true;
}

// Packets that only this client gets, or that are acknowledged, are not for a ring.
bool Pipes::may_join_ring(const Served& end) const {
  const Member& member = *end.identity.member;
  return (member.access & writeonly) == 0 && !end.is_sent_to_alone() &&
         !end.asks_for_acknowledgements() && connection().version() == MessageVersion::v4 &&
         endpoint_.access().may_send(EntryType::pipe_packet, end.identity.path, member.name);
}

// Its `id` is 0 when there is no ring for the end.
channel::PipeRingStart Pipes::join_ring(const End& end) {
  channel::PipeRingStart start;
  if (!may_join_ring(*end)) return {};
  auto holds = connection().draw_holds();
  if (!holds) return {};
  std::shared_ptr<channel::PipeRingWriter> ring;
  const auto number = end->enter_ring([&] {
    ring = end->place->join_ring({end, !endpoint_.access().is_open_to_all(), std::move(holds),
                                  endpoint_.core()->slot_budget(), endpoint_.wires().slot_budget()},
                                 start);
    return ring != nullptr;
  });
  if (!number) return {};
  start.number = *number;
  if (connection().pass_memory(ring->handle())) return start;
  end->place->leave_ring(end);
  return {};
}

void Pipes::renew_rings() {
  std::vector<endpoint::PipeTable::End> all;
  {
    const MutexLock lock(mutex_);
    all = ends_.all();
  }
  for (const auto& end : all) static_cast<Served&>(*end).place->renew_ring();
}

void Pipes::disconnect(const Question& question) {
  const auto object = endpoint_.find_object(question.entry.service_path);
  const Member& member = endpoint_.find_member(*object, question.entry.member, MemberKind::pipe);
  Decoder decoder(question.message.version, &question.message.strings);
  std::int32_t index = 0;
  endpoint::read_value(decoder, question.entry, "index", type_of<std::int32_t>, &index);
  endpoint::PipeTable::End end;
  {
    const MutexLock lock(mutex_);
    end = ends_.find(object->path, member.name, index);
    if (!end) throw Error(ErrorCode::invalid_argument, "Invalid pipe");
    ends_.remove(*end);
  }
  finish(std::static_pointer_cast<Served>(end), false);
  endpoint_.answer_empty(question);
}

void Pipes::take_packets(const Question& question) {
  const auto object = endpoint_.find_object(question.entry.service_path);
  const Member& member = endpoint_.find_member(*object, question.entry.member, MemberKind::pipe);
  endpoint::PipeArrival arrival(question.message, question.entry, question.owner,
                                *endpoint_.host_->types(),
                                {connection().account(), endpoint_.container_limit()});
  arrival.take([&](const endpoint::PipePacket& packet, Decoder&) -> endpoint::PipeArrival::Taken {
    const MutexLock lock(mutex_);
    auto end = ends_.find(object->path, member.name, packet.index);
    const bool is_taken = end != nullptr;
    return {std::move(end), is_taken};
  });
  if (arrival.has_acknowledgements()) {
    Writer& writer = endpoint_.begin_answer(question);
    const std::uint32_t count = arrival.write_acknowledgements(writer);
    endpoint_.answer_elements(question, writer, count, arrival.metadata());
  } else {
    endpoint_.answer_nothing(question);
  }
  arrival.deliver();
}

void Pipes::take_acknowledgements(const Question& question) {
  const Entry& entry = question.entry;
  if (entry.error != 0) return;  // a packet to what is not there
  endpoint::for_each_acknowledgement(question.message, entry,
                                     [&](std::int32_t index, std::uint32_t number) {
                                       endpoint::PipeTable::End end;
                                       {
                                         const MutexLock lock(mutex_);
                                         end = ends_.find(entry.service_path, entry.member, index);
                                       }
                                       if (end) end->take_acknowledgement(number);
                                     });
}

// Of an end that is not in the table any more.
void Pipes::finish(const End& end, bool is_told) {
  end->place->remove(end, is_told);
  end->finish();
}

std::size_t Pipes::end_if(const Choice& is_over) {
  std::vector<endpoint::PipeTable::End> over;
  {
    const MutexLock lock(mutex_);
    over = ends_.all();
  }
  std::erase_if(over, [&](const auto& end) {
    return !is_over(end->identity.path, end->identity.member->name);
  });
  for (const auto& end : over) close(*end, false);
  return over.size();
}

void Pipes::release(std::string_view path) {
  std::vector<endpoint::PipeTable::End> ended;
  {
    const MutexLock lock(mutex_);
    ended = ends_.take_below(path);
    // The notice of the release may leave before the answer, and then is not of what that opens.
    for (const auto& end : ended) {
      auto& served = static_cast<Served&>(*end);
      served.is_closed_unannounced = !served.is_announced;
    }
  }
  for (const auto& end : ended) finish(std::static_pointer_cast<Served>(end), true);
}

void Pipes::end() {
  std::vector<endpoint::PipeTable::End> ended;
  {
    const MutexLock lock(mutex_);
    ended = ends_.take_all();
  }
  for (const auto& end : ended) finish(std::static_pointer_cast<Served>(end), false);
}

channel::Connection& Pipes::connection() const { return endpoint_.connection(); }

// A change of what the session may do ends its ends in a moment.
[[gnu::hot]] void Pipes::stream(Writer& writer, const EntryHeader& header,
                                std::string_view metadata) {
  if (!endpoint_.access().may_send(header.type, header.service_path, header.member)) {
    throw Error(ErrorCode::invalid_operation, "the pipe endpoint is closed");
  }
  endpoint_.stream_packet(writer, header, metadata);
}

void Pipes::close(PipeEnd::State& state, bool /*may_wait*/) {
  auto& end = static_cast<Served&>(state);
  const auto keep = end.shared_from_this();
  bool is_announced = false;
  {
    const MutexLock lock(mutex_);
    if (!ends_.remove(end)) return;
    is_announced = end.is_announced;
    end.is_closed_unannounced = !is_announced;
  }
  finish(std::static_pointer_cast<Served>(keep), true);
  if (is_announced) send_closed(end);
}

void Pipes::send_closed(const Served& end) {
  const void* const values[] = {&end.identity.index};
  endpoint_.send_packet({.type = EntryType::pipe_closed,
                         .service_path = end.identity.path,
                         .member = end.identity.member->name},
                        {&index_parameter, 1}, values);
}

}  // namespace rr::service

namespace rr {

Skeleton::Places::~Places() {
  for (const auto& [name, place] : pipes_) place->set_connected(nullptr);
}

std::shared_ptr<service::PipePlace> Skeleton::Places::pipe(std::string_view name) {
  const MutexLock lock(mutex_);
  const auto found = pipes_.find(name);
  if (found != pipes_.end()) return found->second;
  return pipes_.emplace(std::string(name), std::make_shared<service::PipePlace>()).first->second;
}

}  // namespace rr
