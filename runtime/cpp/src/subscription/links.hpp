// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rr/member_subscription.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/subscription/notifier.hpp"
#include "runtime/cpp/src/subscription/target.hpp"

namespace rr::subscription {

class Services;
class Links;

/// A member at one client. What is not const is guarded by Links, or by what derives from it.
class Link : public channel::Timer, public std::enable_shared_from_this<Link> {
 public:
  enum class Phase : std::uint8_t {
    connecting,
    open,
    resting,  // it has failed or was closed; until the timer says so
    over,
  };

  Link(Links& links, std::shared_ptr<const LiveClient> whose);
  virtual ~Link();

  const std::shared_ptr<const LiveClient> client;
  Phase phase = Phase::connecting;
  std::optional<Error> error;

 private:
  void on_timer() override;

  const std::weak_ptr<Links> links_;
  const std::shared_ptr<endpoint::Core> core_;
};

/// A member, or an object, at all clients of a subscription: it is connected when a client comes,
/// and again when that fails or it is closed. Services tells of clients one at a time.
class Links : public std::enable_shared_from_this<Links> {
 public:
  /// Throws rr::Error (invalid_argument) for what is no path.
  Links(std::shared_ptr<endpoint::Core> core, std::weak_ptr<Services> services, std::string member,
        std::string_view path);
  virtual ~Links() = default;
  Links(const Links&) = delete;
  Links& operator=(const Links&) = delete;

  [[nodiscard]] const std::string& member() const { return member_; }
  /// Beginning with `*` where the service's name is to be put.
  [[nodiscard]] const std::string& path() const { return path_; }

  // From Services
  void client_came(const std::shared_ptr<const LiveClient>& client);
  void client_left(const std::shared_ptr<const LiveClient>& client);
  /// What has failed is tried now: the program knows more types.
  void try_again();
  /// The subscription is closed. From any thread; does not wait.
  void end();

  // What handles do; see MemberSubscription.
  void close();
  [[nodiscard]] bool is_open() const;
  [[nodiscard]] std::vector<SubscriptionClientId> clients() const;
  [[nodiscard]] std::optional<Error> last_error() const;
  Subscription on_failed(Function<void(const SubscriptionClientId&, const Error&)> function);

  /// The timer of a link.
  void due(const std::shared_ptr<Link>& link);

 protected:
  using LinkPointer = std::shared_ptr<Link>;

  // What the three kinds do in their own ways.
  virtual LinkPointer make_link(std::shared_ptr<const LiveClient> client) RR_REQUIRES(mutex_) = 0;
  /// The object is there: connects the member, then opened() or failed() is to be called. Throws
  /// rr::Error.
  virtual void connect(const LinkPointer& link, const std::shared_ptr<Stub>& object) = 0;
  /// It is open: begins to take what comes.
  virtual void use(Link& link) = 0;
  /// Ends what is open at a client that may go on. Does not wait.
  virtual void leave(Link& link) = 0;
  /// This or its links are others than before.
  virtual void changed() {}
  /// Frees functions of the program.
  virtual void end_functions() RR_REQUIRES(mutex_) {}

  void opened(const LinkPointer& link);
  void failed(const LinkPointer& link, const Error& why);
  /// What has come cannot be used; the member stays connected.
  void complain(const LinkPointer& link, const Error& why);
  /// The other side has closed it.
  void closed(const LinkPointer& link);
  /// The member of this name and kind, with values of a type. Throws rr::Error.
  [[nodiscard]] const Member& need_member(const Session& session, const Stub& object,
                                          MemberKind kind, const Holding& holding) const;
  /// Calls opened() or failed() when it has ended.
  std::unique_ptr<Completion> completion(const LinkPointer& link, void* place);
  [[nodiscard]] static Error error_of(const std::exception_ptr& error);

  [[nodiscard]] const std::shared_ptr<endpoint::Core>& core() const { return core_; }
  void check_open() const RR_REQUIRES(mutex_);  // throws invalid_operation

  mutable Mutex mutex_;
  bool is_open_ RR_GUARDED_BY(mutex_) = true;
  std::vector<LinkPointer> links_ RR_GUARDED_BY(mutex_);
  const std::shared_ptr<Notifier> notifier_;  // to functions of the program

 private:
  friend class Link;
  class Found;
  class Connected;
  void start(const LinkPointer& link);
  void found(const LinkPointer& link, const std::shared_ptr<Stub>& object);
  void rest(const LinkPointer& link);

  const std::shared_ptr<endpoint::Core> core_;
  const std::weak_ptr<Services> services_;
  const std::string member_;
  const std::string path_;
  Listeners<const SubscriptionClientId&, const Error&> on_failed_ RR_GUARDED_BY(mutex_);
};

/// What a client that goes while something is sent to all of them may say.
bool is_of_connection(const Error& error);

}  // namespace rr::subscription
