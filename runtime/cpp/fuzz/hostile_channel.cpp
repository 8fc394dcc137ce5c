// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/hostile_channel.hpp"

#include <mutex>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/fuzz/promise.hpp"

namespace rr::fuzz {
namespace {

constexpr std::size_t smallest = 16;  // bytes of a message that a link carries

class HostileLink final : public MessageLink {
 public:
  HostileLink(std::shared_ptr<HostileScript> script, std::shared_ptr<std::atomic<int>> links)
      : script_(std::move(script)), links_(std::move(links)) {
    ++*links_;
  }
  ~HostileLink() override { --*links_; }

  void start(std::shared_ptr<LinkUser> user) override {
    const std::lock_guard lock(mutex_);
    user_ = std::move(user);
  }

  bool send(MemoryRef /*owner*/, std::span<const std::byte> bytes) override {
    MessageTree message;
    promise(read_tree(bytes, message), "what a client sends can be read");
    const std::vector<EntryTree> entries = std::exchange(message.entries, {});
    promise(!entries.empty(), "a message that a client sends has entries");
    for (const EntryTree& entry : entries) {
      const auto user = this->user();
      if (!user) return true;
      const HostileScript::Messages answers = script_->answer(message, entry);
      if (!answers) {
        user->ended();
        return true;
      }
      for (const Bytes& answer : *answers) {
        // What the client has no room for is lost: a service may well say nothing.
        if (answer.size() >= smallest) static_cast<void>(user->received(answer));
      }
    }
    return true;
  }

  void close() override {
    const std::lock_guard lock(mutex_);
    user_.reset();
  }

 private:
  std::shared_ptr<LinkUser> user() const {
    const std::lock_guard lock(mutex_);
    return user_;
  }

  const std::shared_ptr<HostileScript> script_;
  const std::shared_ptr<std::atomic<int>> links_;
  mutable std::mutex mutex_;
  std::shared_ptr<LinkUser> user_;
};

}  // namespace

HostileChannel::HostileChannel(const RecordedService& recorded)
    : script_(std::make_shared<HostileScript>(recorded)) {}

std::unique_ptr<MessageLink> HostileChannel::connect(const Url& /*url*/,
                                                     std::chrono::steady_clock::time_point) {
  return std::make_unique<HostileLink>(script_, links_);
}

std::unique_ptr<LinkListener> HostileChannel::listen(
    const Url& /*url*/, std::function<void(std::unique_ptr<MessageLink>)> /*accept*/) {
  throw Error(ErrorCode::invalid_operation, "nobody can listen here");
}

}  // namespace rr::fuzz
