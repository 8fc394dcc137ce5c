// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/shared_carrier.hpp"

#include <algorithm>
#include <array>
#include <thread>
#include <utility>

namespace rr::channel {
namespace {

// Of one receive at the socket. Another side that rings without end is looked at again later.
constexpr int most_looks = 16;
constexpr std::ptrdiff_t bells_at_once = 256;
// As a receive on a socket: after this time a thread looks at its deadline, and whether it is to do
// something else.
constexpr Milliseconds longest_sleep{100};
// Looks at the clock while spinning are this rare.
constexpr int looks_without_clock = 32;
// After spinning in vain, that is left out for twice as many receives each time, up to 2 to this.
constexpr unsigned most_vain_spins = 8;

// A program may ask for more: whoever wants the thread back would wait for as long.
constexpr std::chrono::microseconds longest_spin{1000};

std::chrono::microseconds allowed_spin(std::chrono::microseconds spin) {
  static const bool has_several_processors = std::thread::hardware_concurrency() > 1;
  constexpr std::chrono::microseconds none{0};
  return has_several_processors ? std::clamp(spin, none, longest_spin) : none;
}

}  // namespace

SharedCarrier::SharedCarrier(SharedRings rings, bool is_server, int socket,
                             std::chrono::microseconds spin, Charge charge)
    : rings_(std::move(rings)),
      reader_(is_server ? rings_.to_server() : rings_.to_client()),
      writer_(is_server ? rings_.to_client() : rings_.to_server()),
      socket_(socket),
      spin_(allowed_spin(spin)),
      charge_(std::move(charge)),
      is_server_(is_server),
      is_watching_(is_server) {}

// Sending

[[gnu::hot]] std::ptrdiff_t SharedCarrier::send(std::span<const platform::Buffer> pieces) {
  std::size_t wanted = 0;
  for (const platform::Buffer& piece : pieces) wanted += piece.size;
  std::size_t sent = 0;
  while (true) {
    const std::ptrdiff_t written = writer_.write(pieces, sent, [&](std::uint32_t how) {
      if (how == RingWriter::Steps::sleeps) {
        platform::wake_shared(&writer_.ring().words->reader);
      } else {
        ring();
      }
    });
    if (written < 0) {
      is_cheated_.store(true, std::memory_order_relaxed);
      return platform::broken;
    }
    sent += static_cast<std::size_t>(written);
    if (sent == wanted || !writer_.want_room()) return static_cast<std::ptrdiff_t>(sent);
  }
}

// A full socket has rung already, and a broken one has its end to be found.
void SharedCarrier::ring() const {
  constexpr std::array<std::byte, 1> bell{};
  platform::send(socket_, bell);
}

void SharedCarrier::wait_for_room(Time deadline) {
  const Time now = Clock::now();
  if (deadline <= now) return;
  writer_.wait_for_room(std::min<Clock::duration>(deadline - now, longest_sleep));
}

// Receiving

std::ptrdiff_t SharedCarrier::receive(Frame& /*message*/, bool /*may_block*/) {
  return platform::broken;  // it has no messages
}

[[gnu::hot]] std::ptrdiff_t SharedCarrier::receive(std::span<std::byte> room, bool may_block) {
  if (must_look_.load(std::memory_order_relaxed) != Look::none) {
    look_at_socket(must_look_.exchange(Look::none));
  }
  std::ptrdiff_t size = read(room);
  if (size != platform::nothing_now) return size;
  if (has_ended_) return 0;
  if (!may_block) return rest() ? read(room) : platform::nothing_now;
  wait_for(longest_sleep);
  size = read(room);
  if (size != platform::nothing_now) return size;
  // Woken for something else, or not at all.
  look_at_socket(Look::until_end);
  size = read(room);
  return size == platform::nothing_now && has_ended_ ? 0 : size;
}

[[gnu::hot]] std::ptrdiff_t SharedCarrier::read(std::span<std::byte> room) {
  std::uint32_t wake = 0;
  const std::ptrdiff_t size = reader_.read(room, wake);
  if ((wake & RingReader::Steps::by_word) != 0) platform::wake_shared(&reader_.ring().words->room);
  if ((wake & RingReader::Steps::by_bell) != 0) ring();
  if (size == platform::broken) is_cheated_.store(true, std::memory_order_relaxed);
  return size;
}

// Takes the bells, and finds the end, which is behind them. Before the ring is read: what was
// written before the end is received before it.
void SharedCarrier::look_at_socket(Look look) {
  for (int left = most_looks; left != 0; --left) {
    const std::size_t passed = passed_.size();
    const std::ptrdiff_t size = take_bells();
    if (size == 0 || size == platform::broken) has_ended_ = true;
    if (size <= 0) return;
    has_taken_bells_ = true;
    // What is received ends at a handle.
    const bool may_have_more = size == bells_at_once || passed_.size() != passed;
    if (look == Look::once && !may_have_more) return;
  }
  note_event(look == Look::until_end);
}

// A server takes no handles: the system closes those that come.
std::ptrdiff_t SharedCarrier::take_bells() {
  std::array<std::byte, bells_at_once> bells;
  if (is_server_ || !has_slots_) return platform::receive(socket_, bells, platform::Wait::none);
  platform::Descriptor handle;
  const std::ptrdiff_t size = platform::receive_with_handle(socket_, bells, handle);
  if (handle) passed_.add(handle);
  return size;
}

// The system counts what a client leaves in its socket for the user of this process.
bool SharedCarrier::pass_memory(const platform::Descriptor& handle) {
  constexpr std::array<std::byte, 1> bell{};
  if (!is_server_ || !has_slots_) return false;
  if (!platform::has_unreceived(socket_)) unreceived_ = 0;
  if (unreceived_.fetch_add(1) >= PassedMemories::most) {
    --unreceived_;
    return false;
  }
  return platform::send_with_handle(socket_, bell, handle) == std::ptrdiff_t{bell.size()};
}

std::shared_ptr<ServedHolds> SharedCarrier::draw_holds() {
  return is_server_ && has_slots_ ? pool_.draw() : nullptr;
}

template <class Take>
auto SharedCarrier::find_passed(const Take& take) {
  for (int left = most_looks; left != 0; --left) {
    if (auto memory = take()) return memory;
    must_look_ = Look::none;
    look_at_socket(Look::until_end);
    if (must_look_ == Look::none) break;  // that was all
  }
  return take();
}

// The reader that had the words before may still be there.
template <class Place>
std::shared_ptr<Place> SharedCarrier::open_place(std::uint64_t place) {
  if (const auto before = places_[place].lock()) before->detach();
  const auto first = rings_.holds();
  auto opened =
      std::make_shared<Place>(std::shared_ptr<SlotHolds::Words>(first, first.get() + place));
  places_[place] = opened;
  return opened;
}

std::unique_ptr<SlotReader> SharedCarrier::take_slots(std::uint64_t id,
                                                      std::optional<std::uint32_t> holds) {
  if (is_server_ || !has_slots_) return nullptr;
  auto slots = find_passed([&] { return passed_.take_slots(id); });
  if (slots && holds && *holds < HoldPlaces::count) slots->use_holds(open_place<SlotHolds>(*holds));
  return slots;
}

std::unique_ptr<PipeRingReader> SharedCarrier::take_ring(const PipeRingStart& start) {
  if (is_server_ || !has_slots_ || start.place >= HoldPlaces::count) return nullptr;
  auto ring = find_passed([&] { return passed_.take_ring(start.id); });
  if (!ring || !ring->begin(open_place<PipeCursor>(start.place), start)) return nullptr;
  return ring;
}

bool SharedCarrier::rest() {
  is_watching_ = !reader_.watch();
  return !is_watching_;
}

void SharedCarrier::wait(Time deadline) {
  const Time now = Clock::now();
  if (deadline > now) wait_for(std::min<Clock::duration>(deadline - now, longest_sleep));
}

[[gnu::hot]] void SharedCarrier::wait_for(Clock::duration time) {
  if (spin_.count() == 0 || !spin()) reader_.sleep(is_interrupted_, time);
  is_watching_ = false;
  if (is_interrupted_.load(std::memory_order_relaxed)) is_interrupted_.exchange(false);
}

// True when there is something now.
bool SharedCarrier::spin() {
  if (spins_skipped_ != 0) {
    --spins_skipped_;
    return false;
  }
  if (!reader_.is_written_elsewhere()) return false;
  if (is_watching_) reader_.run();
  is_watching_ = false;
  const Time until = Clock::now() + spin_;
  do {
    for (int i = 0; i < looks_without_clock; ++i) {
      if (reader_.is_ready()) {
        vain_spins_ = 0;
        return true;
      }
      platform::pause_briefly();
    }
  } while (Clock::now() < until && !is_interrupted_.load(std::memory_order_relaxed));
  vain_spins_ = std::min(vain_spins_ + 1, most_vain_spins);
  spins_skipped_ = (1U << vain_spins_) - 1;
  return false;
}

void SharedCarrier::interrupt() {
  is_interrupted_.store(true);
  reader_.interrupt();
}

std::string SharedCarrier::failure() const {
  if (!is_cheated_.load(std::memory_order_relaxed)) return {};
  return "the other side has written an index into the shared memory that cannot be";
}

}  // namespace rr::channel
