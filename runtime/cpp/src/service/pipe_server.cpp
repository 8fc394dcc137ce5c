// SPDX-License-Identifier: Apache-2.0
// A pipe as the object that offers it sees it.
#include <algorithm>
#include <array>
#include <chrono>
#include <new>
#include <optional>
#include <utility>

#include "rr/error.hpp"
#include "rr/skeleton.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/errors.hpp"
#include "runtime/cpp/src/platform/thread_object.hpp"
#include "runtime/cpp/src/service/pipe_place.hpp"
#include "runtime/cpp/src/service/places.hpp"

namespace rr {
namespace {

// A value that is written once for each message format, for all who get it.
class Encoded final : public PipeEnd::State::Written {
 public:
  Encoded(const Member& member, const void* value) : member_(member), value_(value) {}

  const Form& in(MessageVersion version) override {
    auto& form = forms_[version == MessageVersion::v2 ? 0 : 1];
    if (!form) form = encode(version);
    return *form;
  }

 private:
  // Short ones stay in a writer of the thread: nothing else is written there before they are sent.
  Form encode(MessageVersion version) const {
    auto* const writers = platform::thread_object<std::array<Writer, 2>>();
    if (writers == nullptr) throw std::bad_alloc();
    Writer& writer = (*writers)[version == MessageVersion::v2 ? 0 : 1];
    writer.reset(version);
    member_.type->write(writer, "packet", value_);
    if (writer.failed()) throw endpoint::latched(writer);
    const auto pieces = writer.pieces();
    if (pieces.size() == 1 && pieces[0].size < Writer::attach_threshold) {
      return {{pieces[0].data, pieces[0].size}, {}};
    }
    Allocation memory = allocate(writer.size());
    std::size_t at = 0;
    for (const Piece& piece : pieces) {
      std::copy(piece.data, piece.data + piece.size, memory.bytes + at);
      at += piece.size;
    }
    writer.reset(version);
    return {{memory.bytes, at}, std::move(memory.owner)};
  }

  const Member& member_;
  const void* const value_;
  std::array<std::optional<Form>, 2> forms_;
};

}  // namespace

PipeServerBase::PipeServerBase(const Skeleton& skeleton, const Member& member)
    : place_(Skeleton::Places::of(skeleton).pipe(member.name)), member_(&member) {}

std::size_t PipeServerBase::endpoint_count() const { return place_->ends()->size(); }

void PipeServerBase::set_backlog_limit(std::size_t packets) const {
  place_->set_backlog_limit(packets);
}

[[gnu::hot]] bool PipeServerBase::wait_sent(std::chrono::milliseconds limit,
                                            std::size_t bytes) const {
  const auto ends = place_->ends();
  // Mostly nothing waits, and then nobody asks for the time.
  std::optional<channel::Time> deadline;
  bool is_sent = true;
  for (const auto& end : *ends) {
    if (end->has_sent(bytes)) continue;
    if (!deadline) deadline = channel::after(channel::Clock::now(), limit);
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(*deadline - channel::Clock::now());
    const auto wait = std::max(left, std::chrono::milliseconds(0));
    // It gives up before its time only when the end or its connection closes.
    const bool is_over = end->wait_sent(wait, bytes) || channel::Clock::now() < *deadline;
    is_sent = is_over && is_sent;
  }
  return is_sent;
}

[[gnu::hot]] void PipeServerBase::send_all(const void* value) const {
  if ((member_->access & writeonly) != 0) {
    throw Error(ErrorCode::write_only_member, "Write only pipe");
  }
  Encoded packet(*member_, value);
  const auto [by_message, limit, notified] = place_->begin_packet(packet);
  service::PipePlace::notify_of_ring(notified);
  for (const auto& end : *by_message) {
    if (limit != 0) {
      end->ask_for_acknowledgements(true);
      if (end->unacknowledged() > limit) {
        end->count_dropped();
        continue;
      }
    }
    try {
      end->send_written(packet);
    } catch (const Error& error) {
      if (error.code() == ErrorCode::buffer_limit_violation ||
          error.code() == ErrorCode::out_of_system_resource) {
        end->count_dropped();
        PipeEnd(end).close();
      } else if (end->is_open() && error.code() != ErrorCode::connection_error &&
                 error.code() != ErrorCode::invalid_operation) {
        throw;  // the value may not travel
      }
    }
  }
}

std::vector<PipeEnd> PipeServerBase::ends() const {
  const auto ends = place_->ends();
  std::vector<PipeEnd> result;
  for (const auto& end : *ends) result.emplace_back(end);
  return result;
}

void PipeServerBase::set_connected(Function<void(PipeEnd)> function) const {
  place_->set_connected(std::move(function));
}

}  // namespace rr
