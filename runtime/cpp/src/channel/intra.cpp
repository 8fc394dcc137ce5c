// SPDX-License-Identifier: Apache-2.0
#include "rr/intra.hpp"

#include <functional>
#include <utility>

#include "rr/error.hpp"
#include "rr/mutex.hpp"

namespace rr {
namespace {

// One end of a link. What one sends the other one's user gets at once, in the same thread.
class IntraLink final : public MessageLink {
 public:
  static std::pair<std::unique_ptr<IntraLink>, std::unique_ptr<IntraLink>> make_pair(
      const std::string& own_url) {
    const auto ends = std::make_shared<Ends>();
    return {std::unique_ptr<IntraLink>(new IntraLink(ends, 0, {})),
            std::unique_ptr<IntraLink>(new IntraLink(ends, 1, own_url))};
  }

  [[nodiscard]] std::string local_url() const override { return url_; }
  void start(std::shared_ptr<LinkUser> user) override {
    bool is_late = false;
    std::shared_ptr<LinkUser> other;
    {
      const MutexLock lock(ends_->mutex);
      ends_->users[own_] = user;
      is_late = ends_->has_ended;
      other = ends_->users[1 - own_];
    }
    if (is_late) user->ended();
    if (other) other->has_room();
  }
  bool send(MemoryRef owner, std::span<const std::byte> message) override {
    std::shared_ptr<LinkUser> other;
    {
      const MutexLock lock(ends_->mutex);
      if (ends_->has_ended) return true;
      other = ends_->users[1 - own_];
    }
    return other && other->received(std::move(owner), message);
  }
  void resume() override {
    if (const auto other = other_user()) other->has_room();
  }
  void close() override {
    std::shared_ptr<LinkUser> other;
    {
      const MutexLock lock(ends_->mutex);
      ends_->has_ended = true;
      other = std::move(ends_->users[1 - own_]);
      ends_->users[own_] = nullptr;
    }
    if (other) other->ended();
  }

 private:
  struct Ends {
    Mutex mutex;
    std::shared_ptr<LinkUser> users[2] RR_GUARDED_BY(mutex);
    bool has_ended RR_GUARDED_BY(mutex) = false;
  };

  IntraLink(std::shared_ptr<Ends> ends, int own, std::string url)
      : ends_(std::move(ends)), own_(own), url_(std::move(url)) {}

  std::shared_ptr<LinkUser> other_user() const {
    const MutexLock lock(ends_->mutex);
    return ends_->users[1 - own_];
  }

  const std::shared_ptr<Ends> ends_;
  const int own_;
  const std::string url_;
};

}  // namespace

// A node that listens. The lock is held while a link is given to it, so that none is after its end.
struct IntraSpace::Entry {
  Entry(Present present, std::function<void(std::unique_ptr<MessageLink>)> accept_links)
      : node(std::move(present)), accept(std::move(accept_links)) {}

  const Present node;
  Mutex mutex;
  std::function<void(std::unique_ptr<MessageLink>)> accept
      RR_GUARDED_BY(mutex);  // empty: it has ended
};

class IntraSpace::Listening final : public LinkListener {
 public:
  Listening(std::shared_ptr<IntraSpace> space, std::shared_ptr<Entry> entry)
      : space_(std::move(space)), entry_(std::move(entry)) {}
  ~Listening() override {
    {
      const MutexLock lock(space_->mutex_);
      space_->entries_.erase(entry_->node.id);
    }
    std::function<void(std::unique_ptr<MessageLink>)> accept;
    const MutexLock lock(entry_->mutex);
    accept.swap(entry_->accept);
  }
  [[nodiscard]] std::vector<std::string> urls() const override { return {"rr+intra://"}; }

 private:
  const std::shared_ptr<IntraSpace> space_;
  const std::shared_ptr<Entry> entry_;
};

class IntraSpace::Channel final : public MessageChannel {
 public:
  Channel(std::shared_ptr<IntraSpace> space, Present node)
      : space_(std::move(space)), node_(std::move(node)) {}

  [[nodiscard]] ChannelTraits traits() const override {
    // Nobody is between.
    return {.is_local = true, .is_encrypted = true};
  }

  std::unique_ptr<MessageLink> connect(
      const Url& url, std::chrono::steady_clock::time_point /*deadline*/) override {
    if (url.node_id.is_any() && url.node_name.empty()) {
      throw Error(ErrorCode::invalid_argument,
                  "a URL with `rr+intra` needs `nodeid` or `nodename`");
    }
    const std::shared_ptr<Entry> entry = find(url);
    auto [own, others] = IntraLink::make_pair("rr+intra://");
    const MutexLock lock(entry->mutex);
    if (!entry->accept) fail(url);
    entry->accept(std::move(others));
    return std::move(own);
  }

  std::unique_ptr<LinkListener> listen(
      const Url& /*url*/, std::function<void(std::unique_ptr<MessageLink>)> accept) override {
    auto entry = std::make_shared<Entry>(node_, std::move(accept));
    const MutexLock lock(space_->mutex_);
    for (const auto& [id, other] : space_->entries_) {
      if (id == node_.id || (!node_.name.empty() && other->node.name == node_.name)) {
        throw Error(ErrorCode::invalid_operation,
                    "a node of this id or name listens in the process already");
      }
    }
    space_->entries_[node_.id] = entry;
    return std::make_unique<Listening>(space_, std::move(entry));
  }

 private:
  [[noreturn]] static void fail(const Url& url) {
    throw Error(ErrorCode::node_not_found,
                "no node " +
                    (url.node_id.is_any() ? "`" + url.node_name + "`" : url.node_id.text()) +
                    " listens in this process");
  }

  std::shared_ptr<Entry> find(const Url& url) const {
    const MutexLock lock(space_->mutex_);
    for (const auto& [id, entry] : space_->entries_) {
      if ((url.node_id.is_any() || url.node_id == id) &&
          (url.node_name.empty() || url.node_name == entry->node.name)) {
        return entry;
      }
    }
    fail(url);
  }

  const std::shared_ptr<IntraSpace> space_;
  const Present node_;
};

IntraSpace::IntraSpace() = default;
IntraSpace::~IntraSpace() = default;

std::shared_ptr<IntraSpace> IntraSpace::of_process() {
  static const auto space = std::make_shared<IntraSpace>();
  return space;
}

std::vector<IntraSpace::Present> IntraSpace::nodes() const {
  std::vector<Present> present;
  const MutexLock lock(mutex_);
  for (const auto& [id, entry] : entries_) present.push_back(entry->node);
  return present;
}

std::shared_ptr<MessageChannel> IntraSpace::channel(const NodeId& id, std::string name) {
  return std::make_shared<Channel>(shared_from_this(), Present{id, std::move(name)});
}

}  // namespace rr
