// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "rr/pipes.hpp"
#include "runtime/cpp/src/channel/pipe_ring.hpp"
#include "runtime/cpp/src/channel/slot_budget.hpp"
#include "runtime/cpp/src/channel/slot_holds.hpp"
#include "runtime/cpp/src/endpoint/missed_packets.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"

namespace rr::service {

/// The memory in which the packets of one pipe are that go to all, and the ends whose clients read
/// them there. Guarded by the pipe's lock.
///
/// The ring has what the slowest reader has not read. One that would keep a packet from it is taken
/// out, with a copy of what it has missed, which its end sends by messages.
class RingReaders {
 public:
  using End = std::shared_ptr<PipeEnd::State>;
  using Ends = std::vector<End>;

  /// A reader that joins.
  struct Joining {
    End end;
    bool is_restricted = false;  ///< its service has users or rights
    std::shared_ptr<channel::ServedHolds> holds{};
    std::shared_ptr<channel::SlotBudget> of_node{};
    std::shared_ptr<channel::SlotBudget> of_session{};
  };

  [[nodiscard]] bool is_empty() const { return readers_.empty(); }
  [[nodiscard]] bool has(const PipeEnd::State& end) const { return find(end) != readers_.size(); }
  /// Whether a client that leaves, or has left, may have lost the right to read: then the others
  /// get another memory.
  [[nodiscard]] bool has_restricted() const;

  /// Adds an end that is not here, with a memory if there is none, and says from where on it reads:
  /// all but the number of the packet. Null when one of the budgets has no room for that, the
  /// system no memory, or the memory has had too many readers. Then there is a new one soon.
  std::shared_ptr<channel::PipeRingWriter> add(Joining joining, channel::PipeRingStart& start);
  /// Puts a packet into the ring, an element `packet` of format 4, or takes all out when it is too
  /// large, or the memory is to be another one. Returns whether it is there. Afterwards `notified`
  /// has the ends whose clients are to be notified.
  bool put(std::span<const std::byte> packet, Ends& notified);
  /// Takes an end out, or all. They are among those that have left.
  void leave(const PipeEnd::State& end);
  void leave_all();
  /// Those that have left since this was asked last: each has to send what it has missed.
  [[nodiscard]] Ends take_left() { return std::exchange(left_, {}); }
  /// What an end that has left has missed. Once.
  endpoint::MissedPackets take_missed(const PipeEnd::State& end);
  /// It is gone, and sends nothing any more.
  void forget(const PipeEnd::State& end);

 private:
  struct Reader {
    End end;
    bool is_restricted = false;
    std::uint64_t turn = 0;
    std::uint32_t number = 0;    // in the memory
    std::uint64_t position = 0;  // up to which it has read, as is known
    std::uint64_t joined = 0;    // packets that were put in before it came
    std::uint64_t answered = 0;  // requests for a notice that were answered
    channel::SlotShare share;    // of its session
    std::shared_ptr<channel::ServedHolds> holds;
  };
  using Missed = std::pair<const PipeEnd::State*, endpoint::MissedPackets>;

  [[nodiscard]] std::size_t find(const PipeEnd::State& end) const;
  bool make(const std::shared_ptr<channel::SlotBudget>& of_node);
  void make_room(std::size_t size);
  void update(Reader& reader) const;
  void take_out(std::size_t place);
  [[nodiscard]] endpoint::MissedPackets missed_by(const Reader& reader) const;

  std::shared_ptr<channel::PipeRingWriter> ring_;
  std::vector<Reader> readers_;
  std::size_t largest_ = 0;  // packet so far, in bytes
  bool is_used_up_ = false;  // no reader can join
  Ends left_;
  std::vector<Missed> missed_;
};

}  // namespace rr::service
