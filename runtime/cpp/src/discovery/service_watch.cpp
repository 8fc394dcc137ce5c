// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/service_watch.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/discovery/waiting.hpp"

namespace rr::discovery {
namespace {

using channel::Milliseconds;

// Questions at a time, so that nodes that do not exist hold up others no more than this; no
// announcer has more than two of them.
constexpr std::size_t most_questions = 16;
constexpr std::size_t most_of_sender = 2;
constexpr unsigned most_attempts = 3;
constexpr std::size_t nonces_kept = 16;

// A node that changes all the time is asked less often.
Milliseconds patience(std::size_t refreshes_in_a_minute) {
  if (refreshes_in_a_minute >= 13) return random_between(25'000, 35'000);
  if (refreshes_in_a_minute >= 9) return random_between(9'000, 11'000);
  if (refreshes_in_a_minute >= 6) return random_between(4'500, 5'500);
  if (refreshes_in_a_minute >= 4) return random_between(2'000, 2'500);
  if (refreshes_in_a_minute >= 1) return random_between(100, 600);
  return Milliseconds(0);
}

}  // namespace

ServiceWatch::ServiceWatch(subscription::Host host)
    : host_(std::move(host)), notifier_(std::make_shared<subscription::Notifier>(host_.core)) {}

void ServiceWatch::plan(Row& row, channel::Time now) {
  if (row.phase != Phase::idle || !row.is_outdated) return;
  while (!row.refreshes.empty() && row.refreshes.front() + std::chrono::minutes(1) < now) {
    row.refreshes.pop_front();
  }
  Milliseconds delay = row.failures > 0 ? random_between(0, 500) : random_between(100, 600);
  if (row.failures == 0) delay += patience(row.refreshes.size());
  if (row.is_fetched && row.known.nonce.empty()) delay += std::chrono::seconds(15);
  row.phase = Phase::waiting;
  row.due = now + delay;
}

void ServiceWatch::plan_all(channel::Time now) {
  for (auto& [id, row] : rows_) plan(row, now);
  set_alarm();
}

void ServiceWatch::set_alarm() {
  channel::Time next = channel::never;
  for (const auto& [id, row] : rows_) {
    if (row.phase == Phase::waiting) next = std::min(next, row.due);
  }
  // Those that are due and may not begin yet begin when another has ended.
  if (next == channel::never || has_ended_ || asking_ >= most_questions) return;
  if (!alarm_) {
    alarm_ = std::make_shared<Alarm>(host_.core->context().reactor, [watch = weak_from_this()] {
      if (const auto self = watch.lock()) self->begin_due();
    });
  }
  alarm_->set(next);
}

void ServiceWatch::heard(const KnownNode& node) {
  const MutexLock lock(mutex_);
  if (has_ended_) return;
  Row& row = rows_[node.node.id];
  row.known = node;
  auto& seen = row.seen_nonces;
  if (!row.is_fetched || node.nonce.empty()) {
    row.is_outdated = true;
  } else if (std::find(seen.begin(), seen.end(), node.nonce) == seen.end()) {
    row.is_outdated = true;
    row.failures = 0;
  }
  bool has_new_urls = false;
  for (FoundService& service : row.services) has_new_urls |= add_urls(service, node.node);
  if (has_new_urls) tell(followers_, node.node, row.services);
  // One that could not be asked three times may be asked again now that it has been heard.
  if (row.failures >= most_attempts) row.failures = 0;
  if (followers_.empty()) return;
  plan(row, channel::Clock::now());
  set_alarm();
}

void ServiceWatch::lost(const NodeId& node) {
  std::shared_ptr<Question> question;
  {
    const MutexLock lock(mutex_);
    const auto found = rows_.find(node);
    if (found == rows_.end()) return;
    question = found->second.question;
    rows_.erase(found);
    notifier_->add([followers = followers_, node] {
      for (const auto& follower : followers) follower->node_lost(node);
    });
  }
  if (question) question->give_up();
}

void ServiceWatch::end() {
  std::vector<std::shared_ptr<Question>> questions;
  std::vector<std::shared_ptr<channel::Interruption>> lookers;
  Followers followers;
  {
    const MutexLock lock(mutex_);
    has_ended_ = true;
    for (auto& [id, row] : rows_) {
      if (row.question) questions.push_back(row.question);
    }
    rows_.clear();
    followers.swap(followers_);
    lookers.swap(lookers_);
    if (alarm_) alarm_->cancel();
  }
  for (const auto& question : questions) question->give_up();
  for (const auto& looker : lookers) looker->interrupt();
  for (const auto& follower : followers) follower->watch_ended();
}

void ServiceWatch::add(std::shared_ptr<ServiceFollower> follower) {
  {
    const MutexLock lock(mutex_);
    if (has_ended_) throw Error(ErrorCode::invalid_operation, "the node is shut down");
    followers_.push_back(follower);
    plan_all(channel::Clock::now());
  }
  repeat(follower);
}

void ServiceWatch::remove(const ServiceFollower& follower) {
  std::shared_ptr<ServiceFollower> gone;
  const MutexLock lock(mutex_);
  const auto found = std::find_if(followers_.begin(), followers_.end(),
                                  [&](const auto& other) { return other.get() == &follower; });
  if (found == followers_.end()) return;
  gone = std::move(*found);
  followers_.erase(found);
}

void ServiceWatch::repeat(const std::shared_ptr<ServiceFollower>& follower) {
  const MutexLock lock(mutex_);
  for (const auto& [id, row] : rows_) {
    if (row.is_fetched) tell({follower}, row.known.node, row.services);
  }
}

// The lock keeps the order that of what has happened.
void ServiceWatch::tell(const Followers& followers, const DetectedNode& node,
                        const std::vector<FoundService>& services) {
  if (followers.empty()) return;
  notifier_->add([followers, node, services] {
    for (const auto& follower : followers) follower->services_are(node, services);
  });
}

std::size_t ServiceWatch::asked_of_sender(const std::string& sender) const {
  return static_cast<std::size_t>(std::count_if(rows_.begin(), rows_.end(), [&](const auto& item) {
    return item.second.phase == Phase::asking && item.second.known.sender == sender;
  }));
}

void ServiceWatch::begin_due() {
  std::vector<std::pair<KnownNode, std::shared_ptr<Question>>> begun;
  try {
    const MutexLock lock(mutex_);
    const channel::Time now = channel::Clock::now();
    for (auto& [id, row] : rows_) {
      if (has_ended_ || asking_ >= most_questions) break;
      if (row.phase != Phase::waiting || row.due > now) continue;
      if (asked_of_sender(row.known.sender) >= most_of_sender) {
        row.due = now + random_between(10, 30);  // looked at again when it may be its turn
        continue;
      }
      row.question = std::make_shared<Question>();
      row.phase = Phase::asking;
      ++asking_;
      begun.emplace_back(row.known, row.question);
    }
    set_alarm();
  } catch (const Error& error) {
    host_.core->log(LogLevel::warning, error.what());
  }
  for (const auto& [known, question] : begun) {
    try {
      host_.run_aside(
          [self = shared_from_this(), info = known, asked = question] { self->ask(info, asked); });
    } catch (const std::exception&) {  // the node ends, or no thread is to be had
      answered(known, question, std::nullopt);
    }
  }
}

void ServiceWatch::ask(const KnownNode& known, const std::shared_ptr<Question>& question) {
  std::optional<std::vector<FoundService>> services;
  try {
    services = ask_index(host_, known, *question);
  } catch (const std::exception& error) {
    host_.core->log(LogLevel::info, "the services of node " + known.node.id.text() +
                                        " are not known: " + error.what());
  }
  answered(known, question, std::move(services));
}

void ServiceWatch::answered(const KnownNode& known, const std::shared_ptr<Question>& question,
                            std::optional<std::vector<FoundService>> services) {
  std::vector<std::shared_ptr<channel::Interruption>> lookers;
  {
    const MutexLock lock(mutex_);
    --asking_;
    const channel::Time now = channel::Clock::now();
    const auto found = rows_.find(known.node.id);
    if (found != rows_.end() && found->second.question == question) {
      Row& row = found->second;
      row.question.reset();
      row.phase = Phase::idle;
      row.refreshes.push_back(now);
      if (row.refreshes.size() > nonces_kept) row.refreshes.pop_front();
      if (services) {
        row.failures = 0;
        row.is_fetched = true;
        row.is_outdated = row.known.nonce != known.nonce;
        row.seen_nonces.push_back(known.nonce);
        if (row.seen_nonces.size() > nonces_kept) row.seen_nonces.pop_front();
        row.services = std::move(*services);
        tell(followers_, row.known.node, row.services);
        if (!followers_.empty()) plan(row, now);
      } else if (++row.failures < most_attempts) {
        plan(row, now);
      }
    }
    set_alarm();
    if (!is_busy()) lookers.swap(lookers_);
  }
  for (const auto& looker : lookers) looker->interrupt();
}

// Whether answers are still to come that somebody who looks should wait for.
bool ServiceWatch::is_busy() const {
  const channel::Time soon = channel::Clock::now() + std::chrono::seconds(1);
  return std::any_of(rows_.begin(), rows_.end(), [&](const auto& item) {
    return item.second.phase == Phase::asking ||
           (item.second.phase == Phase::waiting && item.second.due < soon);
  });
}

std::vector<FoundService> ServiceWatch::look(channel::Time deadline) {
  std::shared_ptr<channel::Interruption> looker;
  {
    const MutexLock lock(mutex_);
    if (has_ended_) throw Error(ErrorCode::invalid_operation, "the node is shut down");
    const channel::Time now = channel::Clock::now();
    for (auto& [id, row] : rows_) {
      if (!row.is_outdated || row.phase == Phase::asking) continue;
      row.failures = 0;
      row.phase = Phase::waiting;
      row.due = now;
    }
    set_alarm();
    if (is_busy()) {
      looker = std::make_shared<channel::Interruption>();
      lookers_.push_back(looker);
    }
  }
  const auto forget = [&]() RR_REQUIRES(mutex_) { std::erase(lookers_, looker); };
  try {
    if (looker) wait_for_either(*looker, deadline);
  } catch (...) {
    const MutexLock lock(mutex_);
    forget();
    throw;
  }
  std::vector<FoundService> result;
  const MutexLock lock(mutex_);
  forget();
  if (has_ended_) throw Error(ErrorCode::operation_cancelled, "the node is shut down");
  for (const auto& [id, row] : rows_) {
    result.insert(result.end(), row.services.begin(), row.services.end());
  }
  return result;
}

}  // namespace rr::discovery
