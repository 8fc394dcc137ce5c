// SPDX-License-Identifier: Apache-2.0
// What leaves one end of a pipe; and the handles of ends.
#include <utility>

#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/channel/scratch.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/endpoint/pipe_packets.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/endpoint/ring_terms.hpp"

namespace rr {
namespace {

[[noreturn]] void throw_closed() {
  throw Error(ErrorCode::invalid_operation, "the pipe endpoint is closed");
}

}  // namespace

// Numbers are drawn and packets sent under one lock: they leave in their order, and what cannot be
// sent takes no number that the other side would wait for.
template <class Write>
std::uint32_t PipeEnd::State::send_packet(const Write& write_value) {
  if (identity.is_client && (access_ & readonly) != 0) {
    throw Error(ErrorCode::read_only_member, "Read only pipe");
  }
  if (!identity.is_client && (access_ & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only pipe");
  }
  const bool asks = asks_.load(std::memory_order_relaxed);
  Writer& writer = channel::thread_writer();
  const MutexLock lock(sending_);
  endpoint::PipeSide* const side = side_while_sending();
  if (side == nullptr) throw_closed();
  if (has_ring_.load(std::memory_order_relaxed)) leave_ring(*side);
  if (asks) asked_.fetch_add(1, std::memory_order_relaxed);
  try {
    send_numbered(writer, *side, asks, write_value);
  } catch (...) {
    if (asks) asked_.fetch_sub(1, std::memory_order_relaxed);
    throw;
  }
  return next_number_ - 1;
}

template <class Write>
void PipeEnd::State::send_numbered(Writer& writer, endpoint::PipeSide& side, bool asks,
                                   const Write& write_value) {
  writer.reset(side.connection().version());
  endpoint::write_packet(writer, index_text_, next_number_, asks, [&] { write_value(writer); });
  if (writer.failed()) throw endpoint::latched(writer);
  const std::string_view metadata =
      identity.is_unreliable ? endpoint::unreliable_metadata : std::string_view();
  side.stream(writer,
              {.type = EntryType::pipe_packet,
               .service_path = identity.path,
               .member = identity.member->name,
               .metadata = metadata},
              metadata);
  ++next_number_;
}

[[gnu::hot]] std::uint32_t PipeEnd::State::send(const void* value) {
  if (has_ring_.load(std::memory_order_relaxed)) is_sent_to_alone_ = true;
  return send_packet(
      [&](Writer& writer) { identity.member->type->write(writer, "packet", value); });
}

[[gnu::hot]] std::uint32_t PipeEnd::State::send_written(Written& packet) {
  return send_packet([&](Writer& writer) {
    const Written::Form& form = packet.in(writer.version());
    writer.prepend_array(form.bytes, form.owner);
  });
}

// Rings

std::optional<std::uint32_t> PipeEnd::State::enter_ring(const std::function<bool()>& join) {
  const MutexLock lock(sending_);
  endpoint::PipeSide* const side = side_while_sending();
  if (side == nullptr) return std::nullopt;
  if (has_ring_) leave_ring(*side);
  has_ring_ = join();
  if (!has_ring_) return std::nullopt;
  return next_number_;
}

void PipeEnd::State::send_missed() {
  const MutexLock lock(sending_);
  endpoint::PipeSide* const side = side_while_sending();
  if (side != nullptr && has_ring_) leave_ring(*side);
}

// What is not sent is still there when this is called again.
void PipeEnd::State::leave_ring(endpoint::PipeSide& side) {
  if (!missed_) {
    missed_ = take_missed();
    next_number_ += static_cast<std::uint32_t>(missed_->read);
  }
  if (missed_->is_lost) {
    throw Error(ErrorCode::out_of_system_resource,
                "packets of the pipe that the client has not read cannot be sent to it any more");
  }
  if (!missed_->is_notified) send_notice(side);
  missed_->is_notified = true;
  Writer& writer = channel::thread_writer();
  while (!missed_->packets.empty()) {
    const endpoint::MissedPackets::Packet& packet = missed_->packets.front();
    send_numbered(writer, side, false, [&](Writer& to) {
      to.prepend_array({packet.bytes, packet.size}, packet.owner);
    });
    missed_->packets.pop_front();
  }
  missed_.reset();
  has_ring_ = false;
}

void PipeEnd::State::notify_of_ring() {
  const auto side = this->side();
  if (side) send_notice(*side);
}

void PipeEnd::State::send_notice(endpoint::PipeSide& side) const {
  Writer& writer = channel::thread_writer();
  writer.reset(side.connection().version());
  endpoint::write_ring_notice(writer, identity.index);
  side.stream(writer,
              {.type = EntryType::pipe_packet,
               .service_path = identity.path,
               .member = identity.member->name},
              {});
}

void PipeEnd::State::ask_for_acknowledgements(bool on) {
  asks_.store(on, std::memory_order_relaxed);
  if (!on || !has_ring_) return;
  try {
    send_missed();
  } catch (const Error&) {
    // It is tried again before the next packet.
  }
}

// Which one it is the function may care about; for the count they are alike, and a side that
// acknowledges too much gains nothing.
void PipeEnd::State::take_acknowledgement(std::uint32_t number) {
  if (acknowledged_.load() < asked_.load()) acknowledged_.fetch_add(1);
  Function<void(std::uint32_t)> function;
  {
    const MutexLock lock(mutex_);
    function = acknowledged_function_;
  }
  if (function) call([&] { function(number); });
}

std::size_t PipeEnd::State::unacknowledged() const {
  const std::uint64_t acknowledged = acknowledged_.load();
  const std::uint64_t asked = asked_.load();
  return asked > acknowledged ? asked - acknowledged : 0;
}

void PipeEnd::State::on_acknowledged(Function<void(std::uint32_t)> function) {
  const MutexLock lock(mutex_);
  // What is not kept ends after the lock, and with a closed end all of it.
  if (!is_closed_) std::swap(acknowledged_function_, function);
}

void PipeEnd::State::count_dropped() const {
  if (channel::Metrics* const metrics = core_->reactor().metrics()) metrics->count_dropped_packet();
}

bool PipeEnd::State::wait_sent(std::chrono::milliseconds limit, std::size_t bytes) const {
  const auto open = side();
  if (!open) return false;
  channel::Connection& connection = open->connection();
  return connection.has_sent(bytes) ||
         connection.wait_sent(bytes, channel::after(channel::Clock::now(), limit));
}

[[gnu::hot]] bool PipeEnd::State::has_sent(std::size_t bytes) const {
  const auto open = side();
  return open && open->connection().has_sent(bytes);
}

// The handles

namespace {

PipeEnd::State& need(const std::shared_ptr<PipeEnd::State>& state) {
  if (!state) throw Error(ErrorCode::invalid_operation, "the pipe endpoint was never connected");
  return *state;
}

}  // namespace

void PipeEnd::close() {
  if (!state_) return;
  if (const auto side = state_->side()) side->close(*state_, true);
}

bool PipeEnd::is_open() const { return state_ && state_->is_open(); }
std::int32_t PipeEnd::index() const { return need(state_).identity.index; }
bool PipeEnd::is_unreliable() const { return need(state_).identity.is_unreliable; }
std::uint32_t PipeEnd::client() const { return need(state_).identity.client; }
void PipeEnd::on_closed(Function<void()> function) { need(state_).on_closed(std::move(function)); }
std::size_t PipeEnd::available() const { return need(state_).available(); }
bool PipeEnd::wait(std::chrono::milliseconds limit) const { return need(state_).wait(limit); }
void PipeEnd::set_queue_limit(std::size_t packets, WhenFull when_full, std::size_t bytes) {
  need(state_).set_queue_limit(packets, when_full, bytes);
}
std::size_t PipeEnd::lost_count() const { return need(state_).lost_count(); }
void PipeEnd::ask_for_acknowledgements(bool on) { need(state_).ask_for_acknowledgements(on); }
void PipeEnd::on_acknowledged(Function<void(std::uint32_t)> function) {
  need(state_).on_acknowledged(std::move(function));
}
std::size_t PipeEnd::unacknowledged() const { return need(state_).unacknowledged(); }
bool PipeEnd::wait_sent(std::chrono::milliseconds limit, std::size_t bytes) const {
  return need(state_).wait_sent(limit, bytes);
}
std::shared_ptr<void> PipeEnd::take() { return need(state_).take(); }
std::shared_ptr<const void> PipeEnd::peek() const { return need(state_).peek(); }
std::uint32_t PipeEnd::send(const void* value) { return need(state_).send(value); }
Subscription PipeEnd::on_received(Function<void(std::shared_ptr<void>)> function) {
  return need(state_).on_received(std::move(function));
}
void PipeEnd::start_receive(std::unique_ptr<Completion> completion) {
  need(state_).start_receive(std::move(completion));
}
void PipeEnd::throw_no_packet() {
  throw Error(ErrorCode::invalid_operation, "no packet waits to be received");
}

}  // namespace rr
