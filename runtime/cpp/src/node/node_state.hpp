// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/node/recursive_mutex.hpp"
#include "runtime/cpp/src/subscription/host.hpp"

namespace rr {

/// The places where a node listens.
class Places {
 public:
  void add(std::unique_ptr<channel::Listener> listener) {
    const MutexLock lock(mutex_);
    if (has_ended_) throw Error(ErrorCode::invalid_operation, "the node is shut down");
    listeners_.push_back(std::move(listener));
  }
  void end() {
    std::vector<std::unique_ptr<channel::Listener>> old;
    const MutexLock lock(mutex_);
    has_ended_ = true;
    old.swap(listeners_);  // they end when the lock has gone
  }
  /// As the listeners say.
  std::vector<std::string> urls() {
    std::vector<std::string> result;
    const MutexLock lock(mutex_);
    for (const auto& listener : listeners_) {
      for (std::string& url : listener->urls()) result.push_back(std::move(url));
    }
    return result;
  }
  /// Announces the current nonce of the services at all places. Returns the text of an error;
  /// empty: none. Under the lock, so that concurrent calls leave the newest nonce.
  template <class Announcer>
  std::string tell_nonce(const Announcer& announcer) {
    std::string failure;
    const MutexLock lock(mutex_);
    const std::string nonce = announcer.nonce();
    for (const auto& listener : listeners_) {
      try {
        listener->services_changed(nonce);
      } catch (const Error& error) {
        failure = error.message();
      }
    }
    return failure;
  }

 private:
  Mutex mutex_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  std::vector<std::unique_ptr<channel::Listener>> listeners_ RR_GUARDED_BY(mutex_);
};

/// A part of a node that is created on first use: services, subscriptions, discovery. node.cpp does
/// not refer to any of them, so programs that use none are linked without them.
class NodePart {
 public:
  virtual ~NodePart() = default;
  /// Ends what it has to do with others. Waits for nobody.
  virtual void end() = 0;
  [[nodiscard]] virtual bool is_own_thread() const { return false; }
};

/// What a node is made of.
struct NodeState {
  std::shared_ptr<endpoint::Core> core;

  /// The part of a slot, which is made from the state unless it is there.
  template <class Part>
  Part& part(std::unique_ptr<NodePart> NodeState::*slot) {
    const RecursiveMutexLock lock(making);
    std::unique_ptr<NodePart>& place = this->*slot;
    if (!place) {
      place = std::make_unique<Part>(*this);
      if (have_parts_ended) place->end();
    }
    return static_cast<Part&>(*place);
  }
  mutable RecursiveMutex making;  // a part may need another one
  bool have_parts_ended RR_GUARDED_BY(making) = false;
  std::unique_ptr<NodePart> services RR_GUARDED_BY(making);
  std::unique_ptr<NodePart> subscriptions RR_GUARDED_BY(making);
  std::unique_ptr<NodePart> discovery RR_GUARDED_BY(making);

  // Threads of run_aside(), and whether they have done their work.
  struct Worker {
    std::thread thread;
    std::shared_ptr<std::atomic<bool>> is_done;
  };

  Mutex mutex;
  bool is_shut_down RR_GUARDED_BY(mutex) = false;
  const std::shared_ptr<Places> places = std::make_shared<Places>();
  std::vector<std::weak_ptr<channel::Connection>> accepted RR_GUARDED_BY(mutex);
  std::vector<std::weak_ptr<Session>> sessions RR_GUARDED_BY(mutex);
  std::vector<Worker> workers RR_GUARDED_BY(mutex);
  static thread_local const NodeState* served_aside;  // by this thread, if it is a worker

  // While a thread waits for the others to end.
  Mutex ending RR_ACQUIRED_BEFORE(mutex);

  /// Drops what has gone whenever the list would grow.
  template <class T>
  static void remember(std::vector<std::weak_ptr<T>>& list, const std::shared_ptr<T>& item) {
    if (list.size() == list.capacity()) {
      std::erase_if(list, [](const std::weak_ptr<T>& other) { return other.expired(); });
    }
    list.push_back(item);
  }

  /// Ends a session when the node is shut down. Throws rr::Error when it has been.
  void keep(const std::shared_ptr<Session>& session);
  void run_aside(std::function<void()> work);
  /// What parts need of the node.
  [[nodiscard]] subscription::Host host();
  [[nodiscard]] bool is_own_thread() const;

  /// Ends what the node has to do with others. Waits for nobody.
  void begin_end();
  /// Waits for the node's threads, and so for what runs on them. Not on one of them.
  void finish_end();

 private:
  void join_done() RR_REQUIRES(mutex);
  void end_part(std::unique_ptr<NodePart> NodeState::*slot);
};

struct Node::State : NodeState {};

}  // namespace rr
