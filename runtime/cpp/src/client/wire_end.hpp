// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>

#include "rr/mutex.hpp"
#include "rr/wires.hpp"
#include "runtime/cpp/src/channel/slot_budget.hpp"
#include "runtime/cpp/src/endpoint/slot_terms.hpp"
#include "runtime/cpp/src/endpoint/wire_end.hpp"

namespace rr {

class Session;

namespace channel {
class SlotReader;
}  // namespace channel

namespace client {

/// A client's end of a wire.
///
/// Where both sides share memory it asks for slots: then values do not come by themselves, but are
/// copied out of the memory that the service publishes them in, when the program asks for one.
/// While the program waits, a thread of the node sleeps on that memory. Whatever else comes is a
/// message, and times say which value is the newest.
class ClientWireEnd final : public WireEnd::State {
 public:
  ClientWireEnd(std::shared_ptr<Session> session, std::string path, const Member& member);

  void close() override;
  /// The service has answered that it is connected. From the thread that reads the answer.
  void take_answer(Decoder& decoder, const Entry& entry);
  /// How values are to come.
  [[nodiscard]] endpoint::SlotMode wanted_mode() const;
  /// Whether a notice that its object was released is of this end, and of none before it.
  [[nodiscard]] bool is_meant_by(std::uint64_t notice) const { return notices_before_ < notice; }
  /// It could not be connected.
  void give_up();

 private:
  [[nodiscard]] channel::Connection& connection() const override;
  void check_sending() const override;
  endpoint::SenderTime draw_time() override { return times_.draw(core().clock()); }
  void transmit(Writer& writer, const channel::Newest& newest) override;

  // Slots (wire_end_slots.cpp)
  void look() override { read_slots(false); }
  void on_awaited() override;
  void leave() override;
  void read_slots(bool tells_here);
  void take_slots(Decoder& decoder, const Entry& entry);
  void drop_slots() RR_REQUIRES(slots_mutex_);
  void ask(endpoint::SlotMode mode);
  void ask_soon(endpoint::SlotMode mode);
  void watch();
  [[nodiscard]] std::shared_ptr<channel::SlotReader> watched(bool& must_ask);
  bool end_watch();

  const std::shared_ptr<Session> session_;
  endpoint::SenderTimes times_;
  // See Notices. What is handled before the answer has come does not mean this end.
  std::atomic<std::uint64_t> notices_before_ = std::numeric_limits<std::uint64_t>::max();

  std::atomic<bool> has_slots_{false};  // slots_ is not null; written under slots_mutex_
  Mutex slots_mutex_;
  std::shared_ptr<channel::SlotReader> slots_ RR_GUARDED_BY(slots_mutex_);
  endpoint::SlotMode mode_ RR_GUARDED_BY(slots_mutex_) =
      endpoint::SlotMode::polled;  // asked for last
  bool has_left_ RR_GUARDED_BY(slots_mutex_) = false;
  bool is_watched_ RR_GUARDED_BY(slots_mutex_) = false;  // by watch(), or will be
  bool is_wanted_ RR_GUARDED_BY(slots_mutex_) = false;   // since watch() has looked last
  channel::SlotShare watch_share_ RR_GUARDED_BY(slots_mutex_);
};

}  // namespace client
}  // namespace rr
