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
#include "rr/skeleton.hpp"
#include "rr/users.hpp"
#include "rr/varvalue.hpp"

/// The service's side: what a node offers under a name.
namespace rr {

/// A client that is connected to a service.
struct ServiceClient {
  std::uint32_t endpoint = 0;  ///< its number in this node
  NodeId node;
  std::string node_name;
  std::string user{};  ///< who is logged in, empty for nobody; in what clients() returns only
};

struct ServiceOptions {
  /// What clients are told about the service: numbers, arrays and strings.
  std::map<std::string, VarValue> attributes{};
  /// Definitions, besides those that the root object's imports, whose types may be used in
  /// varvalues or varobjects.
  std::vector<const Definition*> extra_imports{};
  /// Who may use the service; null: anybody, and no object can be locked.
  std::shared_ptr<const Users> users{};
  /// With users: whether everybody has to be one. Otherwise clients may connect without a user, and
  /// log in later if they wish; in connecting they may not.
  bool require_user = true;
  /// A session that is in an object's monitor and does not use the object for so long is out.
  std::chrono::milliseconds monitor_patience{30'000};
  /// Called on a thread of the node, before the first and after the last request of a client. The
  /// second comes when the connection has ended, which is up to 0.1 s after disconnect() or
  /// close().
  std::function<void(const ServiceClient&)> on_client_connected{};
  std::function<void(const ServiceClient&)> on_client_disconnected{};
};

/// A service while it is offered.
class ServiceContext {
 public:
  virtual ~ServiceContext() = default;

  [[nodiscard]] virtual const std::string& name() const = 0;
  [[nodiscard]] virtual const Skeleton& root() const = 0;
  [[nodiscard]] virtual std::map<std::string, VarValue> attributes() const = 0;
  virtual void set_attributes(std::map<std::string, VarValue> attributes) = 0;
  /// Forgets the object at a path and those below it, and tells all clients; a later request to the
  /// path finds the object anew. Objects of clients' own (per_client()) are released for all of
  /// them. Throws rr::Error: service_error for a path where no object is
  /// known, invalid_operation for the root.
  virtual void release_path(const std::string& path) = 0;
  /// The same for one client and an object of its own (per_client()), or one below such an object:
  /// nobody else is concerned. Throws rr::Error: service_error when this client has none there.
  virtual void release_path(const std::string& path, std::uint32_t client) = 0;
  [[nodiscard]] virtual std::vector<ServiceClient> clients() const = 0;
  /// Ends the session of a client, if it has one.
  virtual void disconnect(std::uint32_t endpoint) = 0;
  /// Tells all clients that the service is closed, and ends their sessions. The name is free again.
  virtual void close() = 0;

  /// The client whose request this thread handles; 0 outside of handlers. For `perclient` members.
  static std::uint32_t current_client();
  /// Who is logged in there; null for nobody, and outside of handlers.
  static std::shared_ptr<const User> current_user();
};

/// A registered service. The service stays until it is closed or its node goes away, whatever
/// becomes of this handle.
class Service {
 public:
  Service() = default;
  explicit Service(std::shared_ptr<ServiceContext> context) : context_(std::move(context)) {}

  ServiceContext* operator->() const { return context_.get(); }
  [[nodiscard]] const std::shared_ptr<ServiceContext>& context() const { return context_; }

 private:
  std::shared_ptr<ServiceContext> context_;
};

}  // namespace rr
