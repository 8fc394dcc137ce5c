// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/carrier.hpp"
#include "runtime/cpp/src/channel/passed_memories.hpp"
#include "runtime/cpp/src/channel/shared_rings.hpp"

namespace rr::channel {

/// Carries the bytes of a connection through two rings in shared memory. Its local socket stays:
/// the end of either side shows there, and its bytes are a bell for a reactor that watches it. What
/// a bell's byte says is not looked at. Memories of wires and pipes come with such bytes.
class SharedCarrier final : public Carrier {
 public:
  /// `spin`: how long a receive that blocks looks again and again before it sleeps, where the other
  /// side runs on another processor. `charge`: for the memory, whoever pays for it.
  SharedCarrier(SharedRings rings, bool is_server, int socket, std::chrono::microseconds spin,
                Charge charge = {});

  [[nodiscard]] bool carries_messages() const override { return false; }
  std::ptrdiff_t receive(std::span<std::byte> room, bool may_block) override;
  std::ptrdiff_t receive(Frame& message, bool may_block) override;
  [[nodiscard]] bool has_received() const override { return false; }
  std::ptrdiff_t send(std::span<const platform::Buffer> pieces) override;
  [[nodiscard]] std::size_t unsent() const override { return 0; }
  bool flush() override { return true; }
  void wait_for_room(Time deadline) override;
  void set_on_room(std::function<void()> /*on_room*/) override {}
  void end() override {}
  [[nodiscard]] std::string failure() const override;
  [[nodiscard]] SharedCarrier* shared() override { return this; }

  /// Any thread: the socket has an event, which is perhaps its end.
  void note_event(bool is_end = false) {
    const Look look = is_end ? Look::until_end : Look::once;
    Look expected = Look::none;
    if (!must_look_.compare_exchange_strong(expected, look) && is_end) must_look_ = look;
  }
  /// With the read lease: whether receive() has taken bells since this was asked last, which may
  /// have rung for room.
  bool has_taken_bells() { return std::exchange(has_taken_bells_, false); }
  /// With the read lease, which is about to be free: the bell rings from now on for what comes.
  /// True when something has come already; then it does not.
  bool rest();
  /// With the read lease: sleeps until there may be something to receive.
  void wait(Time deadline);
  /// Any thread: whoever sleeps in a receive is to look at the socket.
  void interrupt();
  /// Before it is used by several threads: memories of wires and pipes are passed, too.
  void use_slots() { has_slots_ = true; }
  /// Any thread.
  [[nodiscard]] bool has_slots() const { return has_slots_; }
  /// By the server, any thread: gives the client a memory of a wire or pipe, which is there before
  /// all that is sent afterwards. False when the socket does not take it, or about
  /// PassedMemories::most are in it that the client has not received.
  [[nodiscard]] bool pass_memory(const platform::Descriptor& handle);
  /// By the client, with the read lease: takes one that the server has passed; null for none, and
  /// for a server. `holds`: the place of the words by which its reader says what it uses.
  std::unique_ptr<SlotReader> take_slots(std::uint64_t id,
                                         std::optional<std::uint32_t> holds = std::nullopt);
  /// The same for the memory of a pipe.
  std::unique_ptr<PipeRingReader> take_ring(const PipeRingStart& start);
  /// By the server, any thread: words for one reader; null when there are none left.
  std::shared_ptr<ServedHolds> draw_holds();

  /// Any thread: the same for the other side, which may sleep where it does not see the socket's
  /// end.
  void interrupt_other() { writer_.interrupt_reader(); }

 private:
  std::ptrdiff_t read(std::span<std::byte> room);
  enum class Look : std::uint8_t { none, once, until_end };
  void look_at_socket(Look look);
  std::ptrdiff_t take_bells();
  void wait_for(Clock::duration time);
  bool spin();
  void ring() const;
  template <class Take>
  auto find_passed(const Take& take);
  template <class Place>
  std::shared_ptr<Place> open_place(std::uint64_t place);

  const SharedRings rings_;
  HoldPool pool_{rings_.holds()};  // of a server
  RingReader reader_;
  RingWriter writer_;
  const int socket_;
  const std::chrono::microseconds spin_;
  const Charge charge_;
  const bool is_server_;
  bool has_slots_ = false;
  std::atomic<Look> must_look_{Look::once};
  std::atomic<bool> is_interrupted_{false};
  std::atomic<bool> is_cheated_{false};     // an index of the other side was wrong
  std::atomic<std::size_t> unreceived_{0};  // passed since the socket was seen to be empty

  // With the read lease.
  bool has_ended_ = false;
  PassedMemories passed_;
  std::array<std::weak_ptr<HeldPlace>, HoldPlaces::count> places_;  // of a client
  bool has_taken_bells_ = false;
  bool is_watching_;
  unsigned vain_spins_ = 0;  // in a row, at most 8
  unsigned spins_skipped_ = 0;
};

}  // namespace rr::channel
