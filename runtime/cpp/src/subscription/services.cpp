// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/services.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/subscription/owner.hpp"

namespace rr::subscription {
namespace {

const Error closed_here(ErrorCode::operation_aborted, "the client was closed");

// A delay of nothing would keep a thread busy.
channel::Milliseconds usable(channel::Milliseconds delay) {
  return std::max(channel::saturated(delay), channel::Milliseconds(1));
}

}  // namespace

void Services::DisconnectBatch::send() {
  for (const AttemptPointer& attempt : attempts) attempt->give_up();
  for (const auto& session : sessions) session->drop();
}

Services::Services(Host host, SubscriptionOptions options, std::weak_ptr<Owner> owner)
    : Waits(host.core),
      host_(std::move(host)),
      options_(std::move(options)),
      owner_(std::move(owner)),
      inner_(std::make_shared<Notifier>(host_.core)),
      program_(std::make_shared<Notifier>(host_.core)),
      filter_(std::make_shared<const Filter>(options_.filter)),
      delay_(usable(options_.retry_delay)),
      maximum_(channel::saturated(options_.max_retry_delay)) {}

// Services

Services::TargetPointer Services::find_target(const std::string& key) const {
  for (const TargetPointer& target : targets_) {
    if (target->key == key) return target;
  }
  return nullptr;
}

void Services::appear(const std::string& key, FoundService service, bool is_known) {
  DisconnectBatch batch;
  {
    const MutexLock lock(mutex_);
    check_open();
    TargetPointer target = find_target(key);
    if (target) target->is_fading = false;
    if (target && target->service.urls == service.urls) {
      target->service = std::move(service);
      target->is_known = is_known;
      return;
    }
    if (target) {
      const auto& urls = service.urls;
      if (target->phase == Target::Phase::connected &&
          std::find(urls.begin(), urls.end(), target->url) != urls.end()) {
        target->service = std::move(service);
        target->is_known = is_known;
        return;
      }
      leave(target, batch, closed_here);
    }
    target =
        std::make_shared<Target>(weak_from_this(), host_.core, key, std::move(service), is_known);
    targets_.push_back(target);
    begin_waiting();
  }
  batch.send();
  changed();
}

void Services::disappear(const std::string& key) {
  DisconnectBatch batch;
  {
    const MutexLock lock(mutex_);
    const TargetPointer target = find_target(key);
    if (!target) return;
    leave(target, batch, closed_here);
    begin_waiting();
  }
  batch.send();
  changed();
}

void Services::fade(const std::string& key) {
  {
    const MutexLock lock(mutex_);
    const TargetPointer target = find_target(key);
    if (!target) return;
    if (target->phase == Target::Phase::connected) {
      target->is_fading = true;
      return;
    }
  }
  disappear(key);
}

std::shared_ptr<const Filter> Services::filter() const {
  const MutexLock lock(mutex_);
  return filter_;
}

void Services::set_source(std::shared_ptr<FindingSource> source) {
  const MutexLock lock(mutex_);
  check_open();
  source_ = std::move(source);
}

void Services::look_for(std::vector<std::string> types, ServiceFilter filter) {
  auto prepared = std::make_shared<const Filter>(std::move(filter));
  std::shared_ptr<FindingSource> source;
  {
    const MutexLock lock(mutex_);
    check_open();
    if (!source_) {
      throw Error(ErrorCode::invalid_operation, "the subscription is one of URLs, not of types");
    }
    source = source_;
    filter_ = prepared;
    begin_waiting();
  }
  source->look_for(std::move(types), std::move(prepared));
}

// The target goes; what it has is left in the batch, unless somebody has claimed it.
void Services::leave(const TargetPointer& target, DisconnectBatch& batch, const Error& why) {
  host_.core->reactor().cancel(*target);
  target->phase = Target::Phase::gone;
  const auto client = std::exchange(target->client, nullptr);
  if (const auto attempt = std::exchange(target->attempt, nullptr)) {
    batch.attempts.push_back(attempt);
  }
  if (client) {
    notify_left(client);
    if (!is_claimed(client->session)) {
      batch.sessions.push_back(client->session);
      on_disconnected_.notify(*program_, client->id, why);
    }
  }
  std::erase(targets_, target);
}

void Services::notify_left(const std::shared_ptr<const LiveClient>& client) {
  inner_->add([members = members_, client] {
    for (const auto& member : members) member->client_left(client);
  });
}

void Services::close() {
  DisconnectBatch batch;
  std::vector<std::shared_ptr<Links>> members;
  std::shared_ptr<FindingSource> source;
  {
    const MutexLock lock(mutex_);
    if (std::exchange(is_closed_, true)) return;
    source.swap(source_);
    while (!targets_.empty()) leave(TargetPointer(targets_.back()), batch, closed_here);
    members.swap(members_);
    on_connected_.end(*program_);
    on_disconnected_.end(*program_);
    on_failed_.end(*program_);
  }
  if (source) source->end();
  for (const auto& member : members) member->end();
  batch.send();
  changed();
  if (const auto owner = owner_.lock()) owner->forget(*this);
}

void Services::check_open() const {
  if (is_closed_) throw Error(ErrorCode::invalid_operation, "the subscription is closed");
}

bool Services::is_open() const {
  const MutexLock lock(mutex_);
  return !is_closed_;
}

void Services::set_retry_delay(std::chrono::milliseconds delay, std::chrono::milliseconds maximum) {
  const MutexLock lock(mutex_);
  delay_ = usable(delay);
  maximum_ = channel::saturated(maximum);
}

std::chrono::milliseconds Services::retry_delay() const {
  const MutexLock lock(mutex_);
  return delay_;
}

// Clients

// Longest first. Of some that have ended it may not have been told yet.
std::vector<Services::TargetPointer> Services::connected() const {
  std::vector<TargetPointer> found;
  for (const TargetPointer& target : targets_) {
    if (target->phase != Target::Phase::connected) continue;
    if (target->client->session->is_open()) found.push_back(target);
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a->order < b->order; });
  return found;
}

// What could not be used for want of a definition may be now.
void Services::learn(const ObjectType* type) {
  if (type == nullptr) return;
  const auto before = host_.core->types();
  host_.core->add_definition(type->definition);
  if (host_.core->types() == before) return;
  const MutexLock lock(mutex_);
  inner_->add([members = members_] {
    for (const auto& member : members) member->try_again();
  });
}

std::shared_ptr<Stub> Services::find(const ObjectType* type) {
  learn(type);
  std::shared_ptr<const LiveClient> client;
  {
    const MutexLock lock(mutex_);
    const auto found = connected();
    if (!found.empty()) client = found.front()->client;
  }
  return client ? client->session->root(type) : nullptr;
}

std::shared_ptr<Stub> Services::find(const SubscriptionClientId& id, const ObjectType* type) {
  learn(type);
  std::shared_ptr<const LiveClient> client;
  {
    const MutexLock lock(mutex_);
    for (const TargetPointer& target : connected()) {
      if (!client && target->client->id == id) client = target->client;
    }
  }
  return client ? client->session->root(type) : nullptr;
}

std::vector<SubscriptionClientId> Services::connected_clients() const {
  std::vector<SubscriptionClientId> result;
  const MutexLock lock(mutex_);
  for (const TargetPointer& target : connected()) result.push_back(target->client->id);
  return result;
}

std::vector<SubscribedService> Services::services() const {
  std::vector<SubscribedService> result;
  const MutexLock lock(mutex_);
  for (const TargetPointer& target : targets_) {
    SubscribedService& service = result.emplace_back();
    service.urls = target->service.urls;
    service.last_error = target->error;
    service.failures = target->failures;
    service.is_connected = target->client != nullptr;
    if (target->client) {
      service.client = target->client->id;
      service.attributes = target->client->session->attributes();
    }
  }
  return result;
}

std::optional<Error> Services::last_error() const {
  const MutexLock lock(mutex_);
  const Target* newest = nullptr;
  for (const TargetPointer& target : targets_) {
    if (!target->error) continue;
    if (newest == nullptr || newest->failed_at < target->failed_at) newest = target.get();
  }
  return newest != nullptr ? newest->error : std::nullopt;
}

bool Services::is_claimed(const std::shared_ptr<Session>& session) const {
  return session && std::any_of(claimed_.begin(), claimed_.end(),
                                [&](const auto& other) { return other.lock() == session; });
}

std::shared_ptr<Session> Services::claim(const Stub* stub) {
  const MutexLock lock(mutex_);
  check_open();
  for (const TargetPointer& target : connected()) {
    const auto& session = target->client->session;
    if (stub == nullptr || session != stub->rr_session()) continue;
    if (is_claimed(session)) {
      throw Error(ErrorCode::invalid_operation, "the client is claimed already");
    }
    std::erase_if(claimed_, [](const auto& other) { return other.expired(); });
    claimed_.push_back(session);
    return session;
  }
  throw Error(ErrorCode::invalid_argument, "the stub is of no client of this subscription");
}

void Services::release(ClientBase& client) {
  std::shared_ptr<Session> session;
  {
    const MutexLock lock(mutex_);
    if (!is_claimed(client.rr_session())) {
      throw Error(ErrorCode::invalid_argument, "the client is not one that was claimed here");
    }
    session = client.rr_release();
    std::erase_if(claimed_, [&](const auto& other) { return other.lock() == session; });
    for (const TargetPointer& target : connected()) {
      if (target->client->session == session) return;
    }
  }
  session->drop();
}

// Functions

Subscription Services::on_connected(Function<void(const SubscriptionClientId&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  const auto listener = on_connected_.add(std::move(function));
  for (const TargetPointer& target : connected()) {
    program_->add([listener, id = target->client->id] { listener->call(id); });
  }
  return Subscription(listener);
}

Subscription Services::on_disconnected(
    Function<void(const SubscriptionClientId&, const Error&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  return Subscription(on_disconnected_.add(std::move(function)));
}

Subscription Services::on_failed(
    Function<void(const std::vector<std::string>&, const Error&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  const auto listener = on_failed_.add(std::move(function));
  for (const TargetPointer& target : targets_) {
    if (target->failures == 0) continue;
    program_->add([listener, urls = target->service.urls, error = *target->error] {
      listener->call(urls, error);
    });
  }
  return Subscription(listener);
}

}  // namespace rr::subscription
