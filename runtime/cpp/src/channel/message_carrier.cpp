// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/message_carrier.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/reader.hpp"

namespace rr::channel {
namespace {

// What may wait to be received: about what the buffers of a socket take.
constexpr std::size_t most_messages = 256;
constexpr std::size_t most_bytes = 1024 * 1024;
constexpr std::size_t alignment = 16;
// Messages were checked before they came here.
constexpr Limits any_size{.message_size = std::numeric_limits<std::uint32_t>::max()};

}  // namespace

std::size_t MessageGather::add(std::span<const std::byte> bytes) {
  std::size_t taken = 0;
  if (size_ == 0) {
    taken = std::min(bytes.size(), smallest_header - have_);
    std::copy_n(bytes.begin(), taken, head_.begin() + static_cast<std::ptrdiff_t>(have_));
    have_ += taken;
    if (have_ != smallest_header) return taken;
    size_ = message_size(head_, any_size);
    if (size_ < smallest_header) return taken;
    bytes = bytes.subspan(taken);
    // Where the largest array begins is known best from as much as is there.
    std::vector<std::byte> begin(head_.begin(), head_.end());
    constexpr std::size_t glance = 4096;
    const std::size_t seen = std::min({bytes.size(), size_ - have_, glance});
    begin.insert(begin.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(seen));
    memory_ = allocate(size_ + alignment);
    shift_ = (alignment - largest_array_offset(begin, size_) % alignment) % alignment;
    std::memcpy(memory_.bytes + shift_, head_.data(), head_.size());
  }
  const std::size_t more = std::min(bytes.size(), size_ - have_);
  std::memcpy(memory_.bytes + shift_ + have_, bytes.data(), more);
  have_ += more;
  return taken + more;
}

void MessageGather::drop() {
  memory_ = {};
  size_ = 0;
  have_ = 0;
}

// What the link speaks to; lives as long as the link wants.
class MessageCarrier::User final : public LinkUser {
 public:
  explicit User(Descriptor bell) : bell_(std::move(bell)) {}

  bool received(MemoryRef owner, std::span<const std::byte> message) override {
    bool must_ring = false;
    {
      const MutexLock lock(mutex_);
      if (has_ended_) return true;
      if (!messages_.empty() &&
          (messages_.size() >= most_messages || bytes_ + message.size() > most_bytes)) {
        is_refusing_ = true;
        return false;
      }
      must_ring = messages_.empty();
      bytes_ += message.size();
      messages_.push_back({message, std::move(owner), {}});
    }
    if (must_ring) ring();
    return true;
  }

  bool received(std::span<const std::byte> message) override {
    Allocation memory = allocate(message.size() + alignment);
    const std::size_t shift =
        (alignment - largest_array_offset(message, message.size()) % alignment) % alignment;
    std::byte* const bytes = memory.bytes + shift;
    if (!message.empty()) std::memcpy(bytes, message.data(), message.size());
    return received(std::move(memory.owner), {bytes, message.size()});
  }

  void has_room() override {
    std::function<void()> on_room;
    {
      const MutexLock lock(mutex_);
      if (has_ended_) return;
      has_room_ = true;
      on_room = on_room_;
    }
    room_.notify_all();
    if (on_room) on_room();
  }

  void ended() override {
    {
      const MutexLock lock(mutex_);
      if (std::exchange(has_ended_, true)) return;
      on_room_ = nullptr;
    }
    room_.notify_all();
    platform::shut_down(bell_.get());
  }

  // All that waits; true when the link is to be told that there is room.
  bool take(std::deque<Frame>& messages) {
    const MutexLock lock(mutex_);
    messages.swap(messages_);
    messages_.clear();
    bytes_ = 0;
    return std::exchange(is_refusing_, false);
  }

  void set_on_room(std::function<void()> on_room) {
    const MutexLock lock(mutex_);
    if (!has_ended_) on_room_ = std::move(on_room);
  }
  void expect_room() {
    const MutexLock lock(mutex_);
    has_room_ = false;
  }
  void wait_for_room(Time deadline) {
    MutexLock lock(mutex_);
    while (!has_room_ && !has_ended_ && Clock::now() < deadline) {
      wait_until(room_, mutex_, deadline);
    }
  }

 private:
  void ring() {
    const std::byte mark{};
    // A full buffer holds marks enough.
    platform::send(bell_.get(), {&mark, 1});
  }

  const Descriptor bell_;
  Mutex mutex_;
  Condition room_;
  std::deque<Frame> messages_ RR_GUARDED_BY(mutex_);
  std::size_t bytes_ RR_GUARDED_BY(mutex_) = 0;
  bool is_refusing_ RR_GUARDED_BY(mutex_) = false;
  bool has_room_ RR_GUARDED_BY(mutex_) = true;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  std::function<void()> on_room_ RR_GUARDED_BY(mutex_);
};

namespace {

// The end that rings; the other one becomes `socket`.
Descriptor make_bell(Descriptor& socket) {
  Descriptor bell;
  if (const std::error_code error = platform::make_pair(socket, bell)) {
    throw Error(ErrorCode::system_resource_error, error.message());
  }
  return bell;
}

}  // namespace

MessageCarrier::MessageCarrier(std::unique_ptr<MessageLink> link, Descriptor& socket)
    : user_(std::make_shared<User>(make_bell(socket))),
      link_(std::move(link)),
      socket_(socket.get()) {
  link_->start(user_);
}

MessageCarrier::~MessageCarrier() { end(); }

std::ptrdiff_t MessageCarrier::receive(std::span<std::byte> /*room*/, bool /*may_block*/) {
  return platform::broken;  // it has no bytes
}

std::ptrdiff_t MessageCarrier::receive(Frame& message, bool may_block) {
  if (!has_received()) {
    std::array<std::byte, 64> marks;
    const auto wait = may_block ? platform::Wait::some : platform::Wait::none;
    const std::ptrdiff_t size = platform::receive(socket_, marks, wait);
    if (size < 0) return size;
    taken_.clear();
    next_ = 0;
    if (user_->take(taken_)) link_->resume();
    // Otherwise it was taken together with those before.
    if (taken_.empty()) return size == 0 ? 0 : platform::nothing_now;
  }
  message = std::move(taken_[next_++]);
  return 1;
}

// A message that the link has refused is whole, and waits.
bool MessageCarrier::flush() {
  if (!gather_.is_whole()) return true;
  const Frame message = gather_.message();
  user_->expect_room();
  if (link_->send(message.owner, message.bytes)) gather_.drop();
  return true;
}

std::ptrdiff_t MessageCarrier::send(std::span<const platform::Buffer> pieces) {
  flush();
  std::ptrdiff_t sent = 0;
  for (const platform::Buffer& piece : pieces) {
    std::span<const std::byte> bytes(piece.data, piece.size);
    while (!bytes.empty()) {
      if (gather_.is_whole()) return sent;
      const std::size_t taken = gather_.add(bytes);
      if (taken == 0) return platform::broken;  // no message
      bytes = bytes.subspan(taken);
      sent += static_cast<std::ptrdiff_t>(taken);
      flush();
    }
  }
  return sent;
}

void MessageCarrier::wait_for_room(Time deadline) { user_->wait_for_room(deadline); }

void MessageCarrier::set_on_room(std::function<void()> on_room) {
  user_->set_on_room(std::move(on_room));
}

void MessageCarrier::end() {
  if (has_ended_.exchange(true)) return;
  user_->ended();
  link_->close();
}

}  // namespace rr::channel
