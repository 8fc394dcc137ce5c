// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/subscription.hpp"
#include "runtime/cpp/src/subscription/filter.hpp"
#include "runtime/cpp/src/subscription/host.hpp"
#include "runtime/cpp/src/subscription/links.hpp"
#include "runtime/cpp/src/subscription/notifier.hpp"
#include "runtime/cpp/src/subscription/target.hpp"
#include "runtime/cpp/src/subscription/url_source.hpp"
#include "runtime/cpp/src/subscription/waits.hpp"

namespace rr::subscription {

class Owner;

/// Where services come from that are found by their type.
class FindingSource {
 public:
  virtual ~FindingSource() = default;
  /// Others from now on. No types: any.
  virtual void look_for(std::vector<std::string> types, std::shared_ptr<const Filter> filter) = 0;
  /// Nothing appears any more. May be called twice.
  virtual void end() = 0;
};

/// The state of a subscription: services that have appeared, and a connection to each of them. Who
/// says that services appear and disappear is somebody else: UrlSource, or discovery.
///
/// Large because it serves handles, sources of services and members alike, and each change of a
/// service concerns all three under one lock.
///
/// Everything happens on threads of the node, but for an attempt to connect, which blocks and has a
/// thread aside while it lasts. Its members are told of clients by `inner_`, in the order in which
/// these come and go.
class Services final : public Waits, public std::enable_shared_from_this<Services> {
 public:
  /// Throws rr::Error (invalid_argument) for a wrong filter.
  Services(Host host, SubscriptionOptions options, std::weak_ptr<Owner> owner);

  // For who knows of services. A service is named by a key.
  /// A service may be reached now; or it may be reached in other ways, or is another, than was said
  /// before. What it is connected by stays if that is among the URLs. `is_known` when all of
  /// `service` is filled in, not only what URLs tell.
  void appear(const std::string& key, FoundService service, bool is_known);
  /// It is gone. Its connection is closed.
  void disappear(const std::string& key);
  /// Nobody can say whether it is still there: its connection stays for as long as it lasts, and is
  /// not made again unless the service appears again.
  void fade(const std::string& key);
  /// Who knows of services, if it is not the program. Throws rr::Error (invalid_operation) when
  /// this is closed.
  void set_source(std::shared_ptr<FindingSource> source);
  /// Services of other types, or those that pass another filter, from now on. Those that do not
  /// match are closed. Throws rr::Error: invalid_argument for a wrong filter, invalid_operation
  /// when this is closed or is one of URLs.
  void look_for(std::vector<std::string> types, ServiceFilter filter);
  /// What the program says itself.
  [[nodiscard]] UrlSource& urls() { return urls_; }
  [[nodiscard]] endpoint::Core& core() const { return *host_.core; }

  // What handles do; see ServiceSubscription.
  void close();
  [[nodiscard]] bool is_open() const;
  void set_retry_delay(std::chrono::milliseconds delay, std::chrono::milliseconds maximum);
  void learn(const ObjectType* type);
  std::shared_ptr<Stub> find(const ObjectType* type) override;
  std::shared_ptr<Stub> find(const SubscriptionClientId& id, const ObjectType* type);
  [[nodiscard]] std::vector<SubscriptionClientId> connected_clients() const;
  [[nodiscard]] std::vector<SubscribedService> services() const;
  [[nodiscard]] std::optional<Error> last_error() const;
  std::shared_ptr<Session> claim(const Stub* stub);
  void release(ClientBase& client);
  Subscription on_connected(Function<void(const SubscriptionClientId&)> function);
  Subscription on_disconnected(Function<void(const SubscriptionClientId&, const Error&)> function);
  Subscription on_failed(Function<void(const std::vector<std::string>&, const Error&)> function);
  // Members (service_members.cpp)
  std::shared_ptr<Links> add_wire(std::string_view member, std::string_view path,
                                  const Holding& holding);
  std::shared_ptr<Links> add_pipe(std::string_view member, std::string_view path,
                                  const Holding& holding, std::size_t max_received);
  std::shared_ptr<Links> add_sub_object(std::string_view path);

  // For its parts.
  [[nodiscard]] std::chrono::milliseconds retry_delay() const;
  void forget(const Links& member);
  /// The timer of a service.
  void due(const std::shared_ptr<Target>& target);

 private:
  using TargetPointer = std::shared_ptr<Target>;
  using AttemptPointer = std::shared_ptr<Attempt>;

  // What is to be done when the lock has gone.
  struct DisconnectBatch {
    std::vector<AttemptPointer> attempts;
    std::vector<std::shared_ptr<Session>> sessions;
    /// Ends them without waiting.
    void send();
  };

  // Attempts (attempts.cpp)
  void begin_soon(const TargetPointer& target) RR_REQUIRES(mutex_);
  void begin_waiting() RR_REQUIRES(mutex_);
  bool begin(const TargetPointer& target);
  void attempt(const TargetPointer& target, const AttemptPointer& attempt);
  struct Reached {
    std::shared_ptr<Session> session;
    std::shared_ptr<SessionEnd> end;
    std::string url;
  };
  Reached reach(const TargetPointer& target, const AttemptPointer& attempt);
  Reached connect(const std::string& url, const FoundService& service, bool is_found,
                  const TargetPointer& target, const AttemptPointer& attempt);
  void check(const Session& session, const std::string& url, FoundService service,
             bool is_known) const;
  void succeed(const TargetPointer& target, const AttemptPointer& attempt, Reached reached);
  void fail(const TargetPointer& target, const AttemptPointer& attempt, const Error& why);
  void session_ended(const TargetPointer& target, SessionEnd& end, const Error& why);

  [[nodiscard]] std::shared_ptr<const Filter> filter() const;

  void check_open() const RR_REQUIRES(mutex_);  // throws invalid_operation
  [[nodiscard]] bool is_full() const RR_REQUIRES(mutex_);
  [[nodiscard]] TargetPointer find_target(const std::string& key) const RR_REQUIRES(mutex_);
  [[nodiscard]] std::vector<TargetPointer> connected() const RR_REQUIRES(mutex_);
  [[nodiscard]] bool is_claimed(const std::shared_ptr<Session>& session) const RR_REQUIRES(mutex_);
  void rest(Target& target, const Error& why) RR_REQUIRES(mutex_);
  void leave(const TargetPointer& target, DisconnectBatch& batch, const Error& why)
      RR_REQUIRES(mutex_);
  void notify_left(const std::shared_ptr<const LiveClient>& client) RR_REQUIRES(mutex_);
  std::shared_ptr<Links> add_member(std::shared_ptr<Links> member) RR_REQUIRES(mutex_);
  void check_holding(std::string_view member, const Holding& holding) const RR_EXCLUDES(mutex_);

  [[nodiscard]] bool has_ended() const override { return !is_open(); }
  [[nodiscard]] std::optional<Error> why_none() const override { return last_error(); }
  std::shared_ptr<Waits> share() override { return shared_from_this(); }

  const Host host_;
  const SubscriptionOptions options_;
  const std::weak_ptr<Owner> owner_;
  UrlSource urls_{*this};
  const std::shared_ptr<Notifier> inner_;    // to members
  const std::shared_ptr<Notifier> program_;  // to functions of the program

  mutable Mutex mutex_;
  bool is_closed_ RR_GUARDED_BY(mutex_) = false;
  std::shared_ptr<const Filter> filter_ RR_GUARDED_BY(mutex_);  // replaced, never changed
  std::shared_ptr<FindingSource> source_ RR_GUARDED_BY(mutex_);
  std::chrono::milliseconds delay_ RR_GUARDED_BY(mutex_);
  std::chrono::milliseconds maximum_ RR_GUARDED_BY(mutex_);
  std::vector<TargetPointer> targets_ RR_GUARDED_BY(mutex_);
  std::uint64_t last_order_ RR_GUARDED_BY(mutex_) = 0;
  std::uint64_t last_failure_ RR_GUARDED_BY(mutex_) = 0;
  std::vector<std::weak_ptr<Session>> claimed_ RR_GUARDED_BY(mutex_);
  std::vector<std::shared_ptr<Links>> members_ RR_GUARDED_BY(mutex_);
  Listeners<const SubscriptionClientId&> on_connected_ RR_GUARDED_BY(mutex_);
  Listeners<const SubscriptionClientId&, const Error&> on_disconnected_ RR_GUARDED_BY(mutex_);
  Listeners<const std::vector<std::string>&, const Error&> on_failed_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::subscription
