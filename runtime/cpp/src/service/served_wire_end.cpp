// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/served_wire_end.hpp"

#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"
#include "runtime/cpp/src/service/offered_wire.hpp"
#include "runtime/cpp/src/service/places.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {
namespace {

constexpr std::size_t line = 64;
// The parts of an endpoint and of its connection that sending touches are at their beginnings.
constexpr std::size_t lines_of_endpoint = 4;
constexpr std::size_t lines_of_connection = 8;

void fetch_lines(const void* begin, std::size_t count) {
  const auto* const first = static_cast<const char*>(begin);
  for (std::size_t i = 0; i < count; ++i) __builtin_prefetch(first + i * line, 1);
}

}  // namespace

ServedWireEnd::ServedWireEnd(std::shared_ptr<ServerEndpoint> endpoint,
                             std::shared_ptr<const ServedObject> object, const Member& member)
    : State(endpoint->core(), object->path, member),
      endpoint_(std::move(endpoint)),
      object_(std::move(object)),
      offered_(Skeleton::Places::of(*object_->skeleton).wire(member)) {
  stream_ = connection().new_stream();
  may_receive_ = (member.access & readonly) == 0;
}

channel::Connection& ServedWireEnd::connection() const { return endpoint_->connection(); }
const NodeId& ServedWireEnd::node() const { return endpoint_->client().node; }
std::uint32_t ServedWireEnd::client() const { return endpoint_->client().endpoint; }

bool ServedWireEnd::is_allowed(std::atomic<std::uint32_t>& asked_at, bool is_taking) const {
  const SessionAccess& access = endpoint_->access();
  const std::uint32_t standing = access.standing();
  if (asked_at.load(std::memory_order_relaxed) == standing) return true;
  const bool is_allowed = is_taking
                              ? access.may_receive(EntryType::wire_packet, path(), member().name)
                              : access.may_send(EntryType::wire_packet, path(), member().name);
  if (is_allowed) asked_at.store(standing, std::memory_order_relaxed);
  return is_allowed;
}

bool ServedWireEnd::is_restricted() const { return !endpoint_->access().is_open_to_all(); }
const std::shared_ptr<channel::SlotBudget>& ServedWireEnd::session_slots() const {
  return endpoint_->wires().slot_budget();
}

// With slots nothing is kept for each client. What was sent to all came to this one as well, or
// will when it has changed over.
std::shared_ptr<const void> ServedWireEnd::sent_to_all(endpoint::SenderTime& time) const {
  return has_had_slots_ ? offered_->sent_to_all(time) : nullptr;
}

void ServedWireEnd::check_sending() const {
  if ((member().access & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only member");
  }
  if (!may_send()) throw Error(ErrorCode::invalid_operation, "the wire is not connected");
}

endpoint::SenderTime ServedWireEnd::draw_time() { return offered_->draw_time(clock()); }

void ServedWireEnd::transmit(Writer& writer, const channel::Newest& newest) {
  writer.entry({.type = EntryType::wire_packet,
                .service_path = path(),
                .member = member().name,
                .metadata = endpoint::unreliable_mark},
               endpoint::wire_elements, 0);
  endpoint_->send_marked(writer, endpoint::unreliable_mark, &newest);
}

void ServedWireEnd::send_common(std::shared_ptr<const void> value, Writer& elements,
                                endpoint::SenderTime time) {
  if (!may_send()) return;
  keep_sent(std::move(value), time);
  Writer& writer = channel::thread_writer();
  writer.reset(elements.version());
  const std::span<const Piece> pieces = elements.pieces();
  for (auto piece = pieces.rbegin(); piece != pieces.rend(); ++piece) {
    writer.prepend_array({piece->data, piece->size}, elements.owner(*piece));
  }
  try {
    transmit(writer, {stream_, time});
  } catch (const Error&) {
    // The client is gone, or the value is larger than a message may be.
    channel::Metrics* const metrics = core().reactor().metrics();
    if (metrics != nullptr && !connection().is_closed()) metrics->count_dropped_value();
  }
}

void ServedWireEnd::fetch(std::size_t step) const {
  if (step == 0) {
    fetch_lines(this, (sizeof(*this) + line - 1) / line);
  } else if (step == 1) {
    fetch_lines(endpoint_.get(), lines_of_endpoint);
  } else {
    fetch_lines(&connection(), lines_of_connection);
  }
}

void ServedWireEnd::send_closed() {
  Writer& writer = channel::thread_writer();
  writer.reset(version());
  writer.entry({.type = EntryType::wire_closed, .service_path = path(), .member = member().name}, 0,
               0);
  try {
    endpoint_->send_marked(writer, endpoint::unreliable_mark, nullptr);
  } catch (const Error&) {
    // The client is gone; its session ends.
  }
}

void ServedWireEnd::close() {
  if (!begin_close()) return;
  send_closed();
  endpoint_->wires().remove(*this);
  finish_now();
}

void ServedWireEnd::on_taken(const std::shared_ptr<const void>& value, const TimeSpec& time) {
  offered_->keep(value, time);
}
bool ServedWireEnd::has_listener() const { return offered_->has_received_function(); }
void ServedWireEnd::tell(const void* value, const TimeSpec& time) {
  offered_->tell_received(value, time, client());
}
void ServedWireEnd::leave() { offered_->leave(*this); }

}  // namespace rr::service
