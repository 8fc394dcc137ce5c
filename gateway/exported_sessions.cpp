// SPDX-License-Identifier: Apache-2.0
#include "gateway/exported_sessions.hpp"

#include <utility>
#include <vector>

#include "gateway/elements.hpp"
#include "gateway/topics.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

constexpr std::chrono::seconds closing_tick{60};
/// For answers of a session that the robot has ended.
constexpr std::chrono::seconds longest_answer{2};

}  // namespace

ExportedSessions::ExportedSessions(Worker& worker, const Limits& limits, Ended ended)
    : worker_(worker),
      limits_(limits),
      ended_(std::move(ended)),
      self_(std::make_shared<ExportedSessions*>(this)),
      closing_(closing_tick, [] {}) {
  closing_.start();
}

ExportedSessions::~ExportedSessions() {
  self_.reset();
  closing_.stop();
  for (auto& [key, entry] : entries_) entry.session->close();
}

void ExportedSessions::open(Node& node, const std::string& url, const MappedUser& login,
                            const std::string& user, const std::string& name,
                            const std::string& reply_topic, Opened opened) {
  if (!is_level_name(name)) {
    throw Error(ErrorCode::invalid_argument, "`" + name + "` is no name of a session");
  }
  const Key key{user, name};
  if (const auto known = entries_.find(key); known != entries_.end()) {
    // While it begins, the first request's answer is that of those that repeat it.
    if (known->second.session->is_open()) opened(nullptr);
    return;
  }
  if (entries_.size() >= limits_.sessions) {
    throw Error(ErrorCode::out_of_system_resource,
                "far clients have too many sessions at the robot");
  }
  const auto post = [&worker = worker_](Function<void()> task) { worker.post(std::move(task)); };
  auto session =
      std::make_shared<ExportedSession>(post, listener(key, std::move(opened)), reply_topic);
  entries_[key] = {.session = session, .used = Clock::now()};
  session->open(node, url, login);
}

ExportedSession::Listener ExportedSessions::listener(const Key& key, Opened opened) {
  const std::weak_ptr<ExportedSessions*> weak = self_;
  const auto post = [&worker = worker_, weak](Function<void(ExportedSessions&)> task) {
    worker.post([weak, task = std::move(task)] {
      if (const auto self = weak.lock()) task(**self);
    });
  };
  return {[post, key, opened = std::move(opened)](const std::exception_ptr& error) {
            post([key, error, opened](ExportedSessions& self) { self.finish(key, error, opened); });
          },
          [post, key] { post([key](ExportedSessions& self) { self.ended_by_robot(key); }); }};
}

// Not of one that is ended here, which is not among the others any more.
void ExportedSessions::ended_by_robot(const Key& key) {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return;
  // A client that is disconnected would not get the error of the request that ended the session.
  found->second.ended = Clock::now();
  if (found->second.requests == 0) tell_end(key);
}

void ExportedSessions::tell_end(const Key& key) {
  ended_(key.second, entries_.at(key).session->reply_topic());
  end(key.first, key.second);
}

void ExportedSessions::finish(const Key& key, const std::exception_ptr& error,
                              const Opened& opened) {
  const bool is_there = entries_.contains(key);
  if (error) end(key.first, key.second);
  opened(error || is_there
             ? error
             : error_pointer(ErrorCode::connection_error, "the session has ended while it began"));
}

std::shared_ptr<ExportedSession> ExportedSessions::find(const std::string& user,
                                                        std::string_view name) {
  const auto found = entries_.find({user, std::string(name)});
  if (found == entries_.end() || !found->second.session->is_open()) return nullptr;
  found->second.used = Clock::now();
  return found->second.session;
}

void ExportedSessions::request_begun(const std::string& user, std::string_view name) {
  const auto found = entries_.find({user, std::string(name)});
  if (found != entries_.end()) ++found->second.requests;
}

void ExportedSessions::request_answered(const std::string& user, std::string_view name,
                                        const std::shared_ptr<ExportedSession>& session) {
  const Key key{user, std::string(name)};
  const auto found = entries_.find(key);
  // There may be another one by this name.
  if (found == entries_.end() || found->second.session != session) return;
  if (--found->second.requests == 0 && found->second.ended) tell_end(key);
}

void ExportedSessions::end(const std::string& user, std::string_view name) {
  auto node = entries_.extract({user, std::string(name)});
  if (!node.empty()) close(std::move(node.mapped().session));
}

std::string ExportedSessions::still_used(const std::string& user, std::string_view names) {
  std::string ended;
  for (const std::string_view name : parts_of(names, ',')) {
    const auto found = entries_.find({user, std::string(name)});
    if (found != entries_.end()) {
      found->second.used = Clock::now();
    } else if (is_level_name(name)) {
      ended += (ended.empty() ? "" : ",") + std::string(name);
    }
  }
  return ended;
}

void ExportedSessions::released(const std::string& user, const std::string& path) {
  for (auto& [key, entry] : entries_) {
    if (key.first == user) entry.session->forget_lock(path);
  }
}

void ExportedSessions::tick(Clock::time_point now) {
  std::vector<Key> silent;
  std::vector<Key> ended;
  for (auto& [key, entry] : entries_) {
    entry.session->tick(now);
    if (entry.ended && now - *entry.ended >= longest_answer) {
      ended.push_back(key);
    } else if (now - entry.used >= limits_.silence) {
      silent.push_back(key);
    }
  }
  for (const Key& key : ended) tell_end(key);
  for (const Key& key : silent) end(key.first, key.second);
}

void ExportedSessions::close(std::shared_ptr<ExportedSession> session) {
  closing_.post([session = std::move(session)] { session->close(); });
}

}  // namespace rr::gateway
