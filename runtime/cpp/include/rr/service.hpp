// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rr/definition.hpp"
#include "rr/node_id.hpp"
#include "rr/rights.hpp"
#include "rr/skeleton.hpp"
#include "rr/timer.hpp"
#include "rr/users.hpp"
#include "rr/varvalue.hpp"
#include "rr/visibility.hpp"

/// The service's side: what a node offers under a name.
namespace RR_VISIBLE rr {

class LockKeeper;

/// A client that is connected to a service.
struct ServiceClient {
  std::uint32_t endpoint = 0;  ///< its number in this node
  NodeId node;                 ///< as it says, or as its certificate proves
  std::string node_name;       ///< as it says; empty for none
  std::string user{};  ///< the user that is logged in, or empty; in what clients() returns only
  /// Number of the session, which no other session of this process has had.
  std::uint64_t session = 0;
};

/// How much of each kind clients may make a service keep (docs/reference/limits.md). What is more
/// fails with OutOfSystemResource.
struct ServiceLimits {
  /// Objects besides the root, those of clients' own included.
  std::size_t objects = 8'192;
  /// While there are more than so many, those that are not in use are released when a session
  /// ends.
  std::size_t unused_objects = 1'024;
  /// Of one session: generators that are open.
  std::size_t generators = 1'024;
  /// Of one session: requests whose answers the service has put off.
  std::size_t late_answers = 4'096;
  /// Of one session: callbacks without an answer.
  std::size_t callbacks = 1'024;
  /// Of one session: monitors that it is in or waits for.
  std::size_t monitors = 256;
  /// Of one session: locks, and of one user those that are not of a session.
  std::size_t locks = 256;
};

/// How a service is offered.
struct ServiceOptions {
  /// What clients are told about the service: numbers, arrays and strings.
  std::map<std::string, VarValue> attributes{};
  /// Definitions, besides those that the root object's imports, whose types may be used in
  /// varvalues or varobjects.
  std::vector<const Definition*> extra_imports{};
  /// The users of the service; null: every client may use it, and no object can be locked.
  std::shared_ptr<const Users> users{};
  /// With users: whether every client has to be one. Otherwise clients may connect without a user,
  /// and log in later if they wish; in connecting they may not.
  bool require_user = true;
  /// What each user may do; null: everything. See rr/rights.hpp.
  std::shared_ptr<const Rights> rights{};
  /// The same from a file, instead of `rights`; empty for none. It is read again when it has
  /// changed, and sessions that are open get the new rules: within two seconds. Rules that cannot
  /// be read leave the ones before in force, and the log is told, level error. When the service is
  /// registered they make that throw rr::Error (invalid_configuration).
  std::string rights_file{};
  /// A session that is in an object's monitor and does not use the object for so long is out.
  std::chrono::milliseconds monitor_patience{30'000};
  /// Asked about every lock and monitor of clients in place of the service, with users or without
  /// (rr/lock_keeper.hpp); the service refuses nothing by itself because of them. Null: none.
  std::shared_ptr<LockKeeper> lock_keeper{};
  /// How much clients may make it keep.
  ServiceLimits limits{};
  /// Called on a thread of the node, before the first request of a client.
  std::function<void(const ServiceClient&)> on_client_connected{};
  /// Called on a thread of the node, after the last request of a client: when the connection has
  /// ended, which is up to 0.1 s after disconnect() or close().
  std::function<void(const ServiceClient&)> on_client_disconnected{};
  /// Called once as soon as no client waits for answers of a session any more: its client has left
  /// or is lost, or the service was closed. Its handlers may still run. On a thread of the node or
  /// that of close() or disconnect(), before on_client_disconnected.
  std::function<void(const ServiceClient&)> on_client_leaving{};
};

/// A service while it is offered.
class ServiceContext {
 public:
  virtual ~ServiceContext() = default;

  /// As it is registered.
  [[nodiscard]] virtual const std::string& name() const = 0;
  /// The root object.
  [[nodiscard]] virtual const Skeleton& root() const = 0;
  /// What clients are told now.
  [[nodiscard]] virtual std::map<std::string, VarValue> attributes() const = 0;
  /// Other attributes from now on. Clients get them when they connect or ask.
  virtual void set_attributes(std::map<std::string, VarValue> attributes) = 0;
  /// Forgets the object at a path and those below it, and tells all clients; a later request to the
  /// path finds the object anew. Objects of clients' own (per_client()) are released for all of
  /// them. Throws rr::Error: service_error for a path where no object is
  /// known, invalid_operation for the root.
  virtual void release_path(const std::string& path) = 0;
  /// The same for one client and an object of its own (per_client()), or one below such an object:
  /// no other client is concerned. Throws rr::Error: service_error when this client has none there.
  virtual void release_path(const std::string& path, std::uint32_t client) = 0;
  /// Locks the object at a path, and all below it, as a client does (rr/locks.hpp), but until
  /// unlock(), whether or not the user has a session. Only that user may use it then; for an empty
  /// name no user may. Users who may release each other's locks may release this one, too, and so
  /// may the user himself. Throws rr::Error: object_locked_error when the object, or one above or
  /// below, is locked, and what is thrown when no object can be found at the path.
  virtual void lock(const std::string& path, const std::string& user = {}) = 0;
  /// Ends the lock at this very path, of any user. False when there is none.
  virtual bool unlock(const std::string& path) = 0;
  /// The node that offers the service; as long as the context lives.
  [[nodiscard]] virtual NodeContext& node() const = 0;
  /// Other rights from now on, for sessions that are open, too: what they may not do any more ends.
  /// Null: everything is allowed. They hold until the file of rights changes, if there is one.
  virtual void set_rights(std::shared_ptr<const Rights> rights) = 0;
  /// The clients that are connected now.
  [[nodiscard]] virtual std::vector<ServiceClient> clients() const = 0;
  /// Ends the session of a client, if it has one, and tells the client so. Returns before the
  /// connection has ended.
  virtual void disconnect(std::uint32_t endpoint) = 0;
  /// Tells all clients that the service is closed, and ends their sessions. The name is free again.
  virtual void close() = 0;

  /// The client whose request this thread handles; 0 outside of handlers. For `perclient` members.
  static std::uint32_t current_client();
  /// The user that is logged in there; null for none, and outside of handlers.
  static std::shared_ptr<const User> current_user();
};

/// A registered service. The service stays until it is closed or its node goes away, whatever
/// becomes of this handle.
class Service {
 public:
  /// No service: not to be used.
  Service() = default;
  /// For the runtime: Node::register_service makes it.
  explicit Service(std::shared_ptr<ServiceContext> context) : context_(std::move(context)) {}

  /// The service: `service->close()`.
  ServiceContext* operator->() const { return context_.get(); }
  /// The same, to be kept elsewhere.
  [[nodiscard]] const std::shared_ptr<ServiceContext>& context() const { return context_; }

 private:
  std::shared_ptr<ServiceContext> context_;
};

}  // namespace rr
