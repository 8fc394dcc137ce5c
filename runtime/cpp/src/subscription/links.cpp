// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/subscription/links.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/endpoint/service_path.hpp"
#include "runtime/cpp/src/subscription/services.hpp"

namespace rr::subscription {
namespace {

// In its one spelling. `*` is no name of an object, so that another stands for it meanwhile.
std::string checked_path(std::string_view path) {
  if (path.empty() || path == "*") return "*";
  const bool is_any = path.starts_with("*.");
  const std::string text = is_any ? "a" + std::string(path.substr(1)) : std::string(path);
  const auto segments = endpoint::parse_path(text);
  if (!segments) {
    throw Error(ErrorCode::invalid_argument, "`" + std::string(path) + "` is no path");
  }
  std::string canonical = endpoint::canonical_path(*segments);
  if (is_any) canonical.replace(0, 1, "*");
  return canonical;
}

std::string path_at(const Session& session, const std::string& path) {
  return path.starts_with('*') ? session.service() + path.substr(1) : path;
}

}  // namespace

Link::Link(Links& links, std::shared_ptr<const LiveClient> whose)
    : client(std::move(whose)), links_(links.weak_from_this()), core_(links.core_) {}

Link::~Link() { core_->reactor().cancel(*this); }

void Link::on_timer() {
  if (const auto links = links_.lock()) links->due(shared_from_this());
}

Links::Links(std::shared_ptr<endpoint::Core> core, std::weak_ptr<Services> services,
             std::string member, std::string_view path)
    : notifier_(std::make_shared<Notifier>(core)),
      core_(std::move(core)),
      services_(std::move(services)),
      member_(std::move(member)),
      path_(checked_path(path)) {}

// Clients

void Links::client_came(const std::shared_ptr<const LiveClient>& client) {
  LinkPointer link;
  {
    const MutexLock lock(mutex_);
    if (!is_open_) return;
    link = make_link(client);
    links_.push_back(link);
  }
  changed();
  start(link);
}

void Links::client_left(const std::shared_ptr<const LiveClient>& client) {
  LinkPointer link;
  bool was_open = false;
  {
    const MutexLock lock(mutex_);
    const auto found = std::find_if(links_.begin(), links_.end(),
                                    [&](const auto& other) { return other->client == client; });
    if (found == links_.end()) return;
    link = std::move(*found);
    links_.erase(found);
    was_open = std::exchange(link->phase, Link::Phase::over) == Link::Phase::open;
  }
  if (was_open) leave(*link);
  changed();
}

void Links::try_again() {
  std::vector<LinkPointer> links;
  {
    const MutexLock lock(mutex_);
    for (const LinkPointer& link : links_) {
      if (link->phase == Link::Phase::resting && link->error) links.push_back(link);
    }
  }
  for (const LinkPointer& link : links) due(link);
}

void Links::end() {
  std::vector<LinkPointer> links;
  std::vector<LinkPointer> open;
  {
    const MutexLock lock(mutex_);
    if (!std::exchange(is_open_, false)) return;
    links.swap(links_);
    for (const LinkPointer& link : links) {
      if (std::exchange(link->phase, Link::Phase::over) == Link::Phase::open) open.push_back(link);
    }
    on_failed_.end(*notifier_);
    end_functions();
  }
  for (const LinkPointer& link : open) leave(*link);
  changed();
}

void Links::close() {
  end();
  if (const auto services = services_.lock()) services->forget(*this);
}

// What handles do

bool Links::is_open() const {
  const MutexLock lock(mutex_);
  return is_open_;
}

void Links::check_open() const {
  if (!is_open_) throw Error(ErrorCode::invalid_operation, "the subscription is closed");
}

std::vector<SubscriptionClientId> Links::clients() const {
  std::vector<SubscriptionClientId> result;
  const MutexLock lock(mutex_);
  for (const LinkPointer& link : links_) {
    if (link->phase == Link::Phase::open) result.push_back(link->client->id);
  }
  return result;
}

std::optional<Error> Links::last_error() const {
  const MutexLock lock(mutex_);
  for (const LinkPointer& link : links_) {
    if (link->error) return link->error;
  }
  return std::nullopt;
}

Subscription Links::on_failed(Function<void(const SubscriptionClientId&, const Error&)> function) {
  const MutexLock lock(mutex_);
  check_open();
  const auto listener = on_failed_.add(std::move(function));
  for (const LinkPointer& link : links_) {
    if (!link->error) continue;
    notifier_->add(
        [listener, id = link->client->id, error = *link->error] { listener->call(id, error); });
  }
  return Subscription(listener);
}

// Connecting

// Of the search for the object.
class Links::Found final : public Completion {
 public:
  Found(std::shared_ptr<Links> links, LinkPointer link)
      : links_(std::move(links)), link_(std::move(link)) {}
  void* result() override { return &object_; }
  void succeed() override { links_->found(link_, object_); }
  void fail(std::exception_ptr error) override { links_->failed(link_, error_of(error)); }

 private:
  const std::shared_ptr<Links> links_;
  const LinkPointer link_;
  std::shared_ptr<Stub> object_;
};

// Of the member.
class Links::Connected final : public Completion {
 public:
  Connected(std::shared_ptr<Links> links, LinkPointer link, void* place)
      : links_(std::move(links)), link_(std::move(link)), place_(place) {}
  void* result() override { return place_; }
  void succeed() override { links_->opened(link_); }
  void fail(std::exception_ptr error) override { links_->failed(link_, error_of(error)); }

 private:
  const std::shared_ptr<Links> links_;
  const LinkPointer link_;
  void* const place_;  // in the link
};

std::unique_ptr<Completion> Links::completion(const LinkPointer& link, void* place) {
  return std::make_unique<Connected>(shared_from_this(), link, place);
}

Error Links::error_of(const std::exception_ptr& error) {
  try {
    std::rethrow_exception(error);
  } catch (const Error& known) {
    return known;
  } catch (const std::exception& other) {
    return {ErrorCode::unknown_error, other.what()};
  } catch (...) {
    return {ErrorCode::unknown_error, "something that is no exception was thrown"};
  }
}

// On the watching thread, or another.
void Links::due(const LinkPointer& link) {
  {
    const MutexLock lock(mutex_);
    if (link->phase != Link::Phase::resting) return;
    link->phase = Link::Phase::connecting;
    core_->reactor().cancel(*link);
  }
  core_->reactor().post([self = shared_from_this(), link] { self->start(link); });
}

void Links::start(const LinkPointer& link) {
  Session& session = *link->client->session;
  try {
    session.learn();
    const std::string path = path_at(session, path_);
    if (path == session.service()) {
      found(link, session.root(nullptr));
    } else {
      session.start_find(path, {}, channel::Milliseconds(0),
                         std::make_shared<Found>(shared_from_this(), link));
    }
  } catch (const Error& error) {
    failed(link, error);
  }
}

void Links::found(const LinkPointer& link, const std::shared_ptr<Stub>& object) {
  try {
    connect(link, object);
  } catch (const Error& error) {
    failed(link, error);
  }
}

void Links::opened(const LinkPointer& link) {
  bool is_wanted = false;
  {
    const MutexLock lock(mutex_);
    is_wanted = link->phase == Link::Phase::connecting;
    if (is_wanted) {
      link->phase = Link::Phase::open;
      link->error.reset();
    }
  }
  if (is_wanted) {
    use(*link);
    changed();
  } else {
    leave(*link);
  }
}

void Links::failed(const LinkPointer& link, const Error& why) {
  // A session that has ended is told of in another way.
  const bool is_alive = link->client->session->is_open();
  {
    const MutexLock lock(mutex_);
    if (link->phase != Link::Phase::connecting) return;
    if (is_alive) {
      link->error = why;
      on_failed_.notify(*notifier_, link->client->id, why);
    }
  }
  rest(link);
  changed();
}

void Links::complain(const LinkPointer& link, const Error& why) {
  const MutexLock lock(mutex_);
  if (link->phase != Link::Phase::open || link->error) return;  // told once
  link->error = why;
  on_failed_.notify(*notifier_, link->client->id, why);
}

void Links::closed(const LinkPointer& link) {
  {
    const MutexLock lock(mutex_);
    if (link->phase != Link::Phase::open) return;
  }
  rest(link);
  changed();
}

void Links::rest(const LinkPointer& link) {
  const auto services = services_.lock();
  if (!services) return;
  const channel::Time when = channel::after(channel::Clock::now(), services->retry_delay());
  const MutexLock lock(mutex_);
  if (link->phase == Link::Phase::over) return;
  link->phase = Link::Phase::resting;
  core_->reactor().schedule(*link, link, when);
}

const Member& Links::need_member(const Session& session, const Stub& object, MemberKind kind,
                                 const Holding& holding) const {
  std::vector<const ObjectType*> types = {&object.rr_object_type()};
  for (std::size_t i = 0; i < types.size(); ++i) {
    const ObjectType& type = *types[i];
    for (const Member& member : type.members) {
      if (member.kind != kind || member.name != member_) continue;
      if (member.holding == &holding) return member;
      throw Error(ErrorCode::data_type_mismatch,
                  "`" + member_ + "` of `" + std::string(type.name) +
                      "` has values of another type than the subscription");
    }
    for (const std::string_view name : type.implements) {
      const bool is_short = name.find('.') == std::string_view::npos;
      const std::string qualified =
          is_short ? std::string(type.definition.name) + "." + std::string(name)
                   : std::string(name);
      if (const ObjectType* const other = session.types()->find_object(qualified)) {
        types.push_back(other);
      }
    }
  }
  throw Error(ErrorCode::member_not_found, "`" + object.rr_path() + "` has no " +
                                               (kind == MemberKind::wire ? "wire `" : "pipe `") +
                                               member_ + "`");
}

bool is_of_connection(const Error& error) {
  return error.code() == ErrorCode::connection_error ||
         error.code() == ErrorCode::invalid_operation;
}

}  // namespace rr::subscription
