// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "rr/wire.hpp"
#include "rr/writer.hpp"
#include "runtime/cpp/src/channel/slot_budget.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"
#include "runtime/cpp/src/endpoint/wire_end.hpp"
#include "runtime/cpp/src/service/object_tree.hpp"

namespace rr::service {

class OfferedWire;
class ServerEndpoint;

/// A service's end of a wire: that of one client. Keeps the object alive for as long as functions
/// of the program may be called.
class ServedWireEnd final : public WireEnd::State {
 public:
  ServedWireEnd(std::shared_ptr<ServerEndpoint> endpoint,
                std::shared_ptr<const ServedObject> object, const Member& member);

  void close() override;
  /// Tells the client that it has ended.
  void send_closed();
  /// Its object is being released, of which the client is told.
  void begin_release() { is_released_ = true; }
  [[nodiscard]] bool is_released() const { return is_released_; }
  [[nodiscard]] std::uint32_t client() const override;

  /// Whether the client may send by it now; another answer than before only after what it may do
  /// has changed.
  bool may_take() { return is_allowed(taking_, true); }

  /// The client's node.
  [[nodiscard]] const NodeId& node() const;
  [[nodiscard]] const endpoint::SenderClock& clock() const { return core().clock(); }
  [[nodiscard]] MessageVersion version() const { return connection().version(); }
  /// Sends what others get too: the elements of a packet, which stay in `elements`. Failures are
  /// ignored.
  void send_common(std::shared_ptr<const void> value, Writer& elements, endpoint::SenderTime time);
  /// Whether the service may send to the client now.
  [[nodiscard]] bool may_send() const { return is_allowed(sending_, false); }
  /// Whether the service has users or rights, so that this may change.
  [[nodiscard]] bool is_restricted() const;
  /// Values come to the client by slots from now on, or did so once.
  void note_slots() { has_had_slots_ = true; }
  /// Gives the client the memory; false when it does not take it.
  [[nodiscard]] bool pass_memory(const channel::SlotWriter& memory) const {
    return connection().pass_memory(memory.handle());
  }
  /// Words by which the client says which slots it uses; null for none.
  [[nodiscard]] std::shared_ptr<channel::ServedHolds> draw_holds() const {
    return connection().draw_holds();
  }
  /// What memories of the node, and of the session, are counted in.
  [[nodiscard]] const std::shared_ptr<channel::SlotBudget>& node_slots() const {
    return core().slot_budget();
  }
  [[nodiscard]] const std::shared_ptr<channel::SlotBudget>& session_slots() const;
  /// The wire of the object.
  [[nodiscard]] OfferedWire& offered() const { return *offered_; }
  /// Begins to bring into the cache what sending will touch. The steps are to be taken in order,
  /// with time between them: where the things of one are is read from those of the one before.
  void fetch(std::size_t step) const;
  static constexpr std::size_t fetch_steps = 3;

 private:
  bool is_allowed(std::atomic<std::uint32_t>& asked_at, bool is_taking) const;
  [[nodiscard]] channel::Connection& connection() const override;
  void check_sending() const override;
  endpoint::SenderTime draw_time() override;
  void transmit(Writer& writer, const channel::Newest& newest) override;
  [[nodiscard]] std::shared_ptr<const void> sent_to_all(endpoint::SenderTime& time) const override;
  void on_taken(const std::shared_ptr<const void>& value, const TimeSpec& time) override;
  [[nodiscard]] bool has_listener() const override;
  void tell(const void* value, const TimeSpec& time) override;
  void leave() override;
  void release() override { object_.reset(); }

  const std::shared_ptr<ServerEndpoint> endpoint_;
  std::shared_ptr<const ServedObject> object_;
  const std::shared_ptr<OfferedWire> offered_;
  std::atomic<bool> is_released_ = false;
  std::atomic<bool> has_had_slots_ = false;
  // The standing of the session (SessionAccess) in which it was allowed last.
  mutable std::atomic<std::uint32_t> taking_{0};
  mutable std::atomic<std::uint32_t> sending_{0};
};

}  // namespace rr::service
