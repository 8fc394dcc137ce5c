// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "rr/realtime/cyclic_loop.hpp"
#include "rr/realtime/layout.hpp"
#include "rr/realtime/signals.hpp"
#include "rr/realtime/state_frame.hpp"
#include "rr/realtime/udp_socket.hpp"
#include "rr/visibility.hpp"

/// State exchanged by UDP between loops: nothing is repeated, the newest wins, what is too old
/// counts as none. Both ends belong to one thread, their loop's, and once made never allocate or
/// lock; of the kernel they need one call for each packet.
namespace RR_VISIBLE rr {
namespace realtime {

/// What has come and what has not. Any thread may read it while the loop goes on.
struct ReceiveCounts {
  std::atomic<std::uint64_t> received{0};    ///< packets of any kind
  std::atomic<std::uint64_t> accepted{0};    ///< that were newer than all before
  std::atomic<std::uint64_t> lost{0};        ///< missing between the first and the newest accepted
  std::atomic<std::uint64_t> late{0};        ///< came behind a newer one; no longer among the lost
  std::atomic<std::uint64_t> duplicates{0};  ///< came a second time
  std::atomic<std::uint64_t> damaged{0};     ///< wrong length or checksum
  std::atomic<std::uint64_t> foreign{0};     ///< no frame, or of another layout
  std::atomic<std::uint64_t> restarts{0};    ///< the sender began anew
};

/// Sorts frames by epoch and sequence number.
class FrameOrder {
 public:
  /// Whether this frame is newer than all before. Counts it.
  bool accept(std::uint64_t epoch, std::uint64_t sequence, ReceiveCounts& counts);

 private:
  /// Of the newest so many sequence numbers it is known which have come; what is older is late.
  static constexpr std::uint64_t window = 1024;

  void begin(std::uint64_t epoch, std::uint64_t sequence);

  bool has_begun_ = false;
  std::uint64_t epoch_ = 0;
  std::uint64_t first_ = 0;
  std::uint64_t newest_ = 0;
  std::bitset<window> has_come_;  // by sequence number modulo window
};

/// The sender's end, without the pod's type.
class StateOutput {
 public:
  /// `epoch` is larger for a sender that begins later; 0 stands for the time of day in nanoseconds.
  explicit StateOutput(Layout layout, std::uint64_t epoch = 0);
  /// The next frame, which stays until the next call.
  std::span<const std::byte> make(const void* pod, Nanoseconds stamp);
  /// Frames made so far: the sequence number of the next one.
  [[nodiscard]] std::uint64_t sequence() const { return header_.sequence; }
  /// What the frames hold.
  [[nodiscard]] const Layout& layout() const { return layout_; }

 private:
  Layout layout_;
  FrameHeader header_;
  std::array<std::byte, largest_frame> frame_{};
};

/// The receiver's end, without the pod's type.
class StateInput {
 public:
  /// Takes frames of this layout only.
  explicit StateInput(Layout layout) : layout_(std::move(layout)) {}
  /// Whether the frame was newer than all before; then `pod` has its signals.
  bool take(std::span<const std::byte> frame, void* pod);
  /// The sender's time of the newest frame, by its own clock.
  [[nodiscard]] Nanoseconds stamp() const { return stamp_; }
  /// The sequence number of the newest frame.
  [[nodiscard]] std::uint64_t sequence() const { return sequence_; }
  /// What has come and what has not.
  [[nodiscard]] const ReceiveCounts& counts() const { return counts_; }
  /// What the frames hold.
  [[nodiscard]] const Layout& layout() const { return layout_; }

 private:
  Layout layout_;
  FrameOrder order_;
  ReceiveCounts counts_;
  Nanoseconds stamp_{0};
  std::uint64_t sequence_ = 0;
};

/// The layout itself, when it is of a pod of this size. Throws rr::Error (invalid_argument).
Layout layout_of_size(Layout layout, std::size_t size);

/// Sends the newest state. One packet a call.
template <Pod T>
class StateSender {
 public:
  /// Throws rr::Error (invalid_argument) for a layout of another pod.
  StateSender(Layout layout, UdpSocket& socket, std::uint64_t epoch = 0)
      : output_(layout_of_size(std::move(layout), sizeof(T)), epoch), socket_(socket) {}
  /// False when the system did not take the packet; it counts in the sequence all the same.
  bool send(const T& value, Nanoseconds stamp) { return socket_.send(output_.make(&value, stamp)); }
  /// Packets until now.
  [[nodiscard]] std::uint64_t sent() const { return output_.sequence(); }

 private:
  StateOutput output_;
  UdpSocket& socket_;
};

/// Receives state. A value that came longer than `lifespan` ago is as none, so that a dead sender
/// is noticed; an older one never follows a newer one.
template <Pod T>
class StateReceiver {
 public:
  /// Throws rr::Error (invalid_argument) for a layout of another pod.
  StateReceiver(Layout layout, Nanoseconds lifespan)
      : input_(layout_of_size(std::move(layout), sizeof(T))), lifespan_(lifespan) {}

  /// Takes what waits at the socket, `limit` packets at most, so that a flood holds up no cycle.
  /// Whether there was something newer. `now` is of the loop's clock.
  bool poll(const UdpSocket& socket, Nanoseconds now, int limit = 64) {
    bool is_newer = false;
    std::array<std::byte, largest_frame + 1> bytes;
    for (int i = 0; i < limit; ++i) {
      const auto size = socket.receive(bytes);
      if (!size) break;
      const auto got = std::span<const std::byte>(bytes).first(std::min(*size, bytes.size()));
      is_newer |= take(got, now);
    }
    return is_newer;
  }
  /// The same for one packet, wherever it is from.
  bool take(std::span<const std::byte> frame, Nanoseconds now) {
    if (!input_.take(frame, &value_)) return false;
    arrival_ = now;
    return true;
  }
  /// The newest value; nothing when none has come, or the newest is older than the lifespan.
  [[nodiscard]] const T* newest(Nanoseconds now) const { return is_fresh(now) ? &value_ : nullptr; }
  /// Whether a value has come, and not longer than the lifespan ago.
  [[nodiscard]] bool is_fresh(Nanoseconds now) const {
    return arrival_ && now - *arrival_ <= lifespan_;
  }
  /// The last that came, however old; T{} before the first.
  [[nodiscard]] const T& last() const { return value_; }
  /// Of that: when it came, by this loop's clock.
  [[nodiscard]] std::optional<Nanoseconds> arrival() const { return arrival_; }
  /// Of that: the sender's time, by its own clock.
  [[nodiscard]] Nanoseconds stamp() const { return input_.stamp(); }
  /// Of that: its sequence number.
  [[nodiscard]] std::uint64_t sequence() const { return input_.sequence(); }
  /// What has come and what has not; any thread may read it.
  [[nodiscard]] const ReceiveCounts& counts() const { return input_.counts(); }

 private:
  StateInput input_;
  Nanoseconds lifespan_;
  T value_{};
  std::optional<Nanoseconds> arrival_;
};

}  // namespace realtime
}  // namespace rr
