// SPDX-License-Identifier: Apache-2.0
#include "rr/realtime/state_channel.hpp"

#include <chrono>

#include "rr/error.hpp"

namespace rr::realtime {
namespace {

// One thread counts, so a load and a store do.
void raise(std::atomic<std::uint64_t>& number, std::uint64_t by = 1) {
  number.store(number.load(std::memory_order_relaxed) + by, std::memory_order_relaxed);
}

}  // namespace

void FrameOrder::begin(std::uint64_t epoch, std::uint64_t sequence) {
  has_begun_ = true;
  epoch_ = epoch;
  first_ = newest_ = sequence;
  has_come_.reset();
  has_come_.set(sequence % window);
}

bool FrameOrder::accept(std::uint64_t epoch, std::uint64_t sequence, ReceiveCounts& counts) {
  if (!has_begun_ || epoch > epoch_) {
    if (has_begun_) raise(counts.restarts);
    begin(epoch, sequence);
    raise(counts.accepted);
    return true;
  }
  if (epoch < epoch_) {
    raise(counts.late);
    return false;
  }
  if (sequence > newest_) {
    const std::uint64_t step = sequence - newest_;
    raise(counts.lost, step - 1);
    if (step >= window) has_come_.reset();
    for (std::uint64_t i = 1; i < step && i < window; ++i) has_come_.reset((newest_ + i) % window);
    has_come_.set(sequence % window);
    newest_ = sequence;
    raise(counts.accepted);
    return true;
  }
  const bool is_remembered = newest_ - sequence < window;
  if (is_remembered && has_come_.test(sequence % window)) {
    raise(counts.duplicates);
    return false;
  }
  raise(counts.late);
  if (is_remembered) {
    has_come_.set(sequence % window);
    if (sequence > first_) raise(counts.lost, ~std::uint64_t{0});  // one less
  }
  return false;
}

StateOutput::StateOutput(Layout layout, std::uint64_t epoch) : layout_(std::move(layout)) {
  header_.schema = layout_.hash();
  header_.epoch = epoch;
  if (epoch == 0) {
    header_.epoch = static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch() /
                                               std::chrono::nanoseconds(1));
  }
}

std::span<const std::byte> StateOutput::make(const void* pod, Nanoseconds stamp) {
  const auto frame = std::span(frame_).first(layout_.packed_size() + frame_overhead);
  layout_.pack(pod, frame.subspan(frame_header_size, layout_.packed_size()));
  header_.stamp = stamp.count();
  seal_frame(header_, frame);
  ++header_.sequence;
  return frame;
}

bool StateInput::take(std::span<const std::byte> frame, void* pod) {
  raise(counts_.received);
  FrameHeader header;
  std::span<const std::byte> payload;
  const FrameFault fault = open_frame(frame, header, payload);
  if (fault == FrameFault::damaged) raise(counts_.damaged);
  const bool is_ours = fault == FrameFault::none && header.schema == layout_.hash() &&
                       payload.size() == layout_.packed_size();
  if (!is_ours) {
    if (fault != FrameFault::damaged) raise(counts_.foreign);
    return false;
  }
  if (!order_.accept(header.epoch, header.sequence, counts_)) return false;
  layout_.unpack(payload, pod);
  stamp_ = Nanoseconds(header.stamp);
  sequence_ = header.sequence;
  return true;
}

Layout layout_of_size(Layout layout, std::size_t size) {
  if (layout.size() != size) {
    throw Error(ErrorCode::invalid_argument, "the layout of " + layout.name() + " is of " +
                                                 std::to_string(layout.size()) +
                                                 " bytes, the pod of " + std::to_string(size));
  }
  return layout;
}

}  // namespace rr::realtime
