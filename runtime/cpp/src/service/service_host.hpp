// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/service.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/service/answer_sizes.hpp"
#include "runtime/cpp/src/service/locks.hpp"
#include "runtime/cpp/src/service/monitors.hpp"
#include "runtime/cpp/src/service/object_tree.hpp"
#include "runtime/cpp/src/service/rights_file.hpp"

namespace rr::service {

class Directory;
class ServerEndpoint;

/// A service of a node: its objects, and the clients that use it.
///
/// Large because it is two things in one: what a program may do with its service (ServiceContext),
/// and what each session asks of it. Objects, locks, monitors and rights are parts.
class ServiceHost final : public ServiceContext, public std::enable_shared_from_this<ServiceHost> {
 public:
  ServiceHost(std::shared_ptr<endpoint::Core> core, std::weak_ptr<Directory> directory,
              std::string name, std::shared_ptr<Skeleton> root, ServiceOptions options);
  /// Attaches the root object. Throws what that throws.
  void start();
  /// False until then: clients may not connect yet.
  [[nodiscard]] bool is_started() const { return is_started_; }

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] const Skeleton& root() const override { return *objects_.root()->skeleton; }
  [[nodiscard]] std::map<std::string, VarValue> attributes() const override;
  void set_attributes(std::map<std::string, VarValue> attributes) override;
  void release_path(const std::string& path) override;
  void release_path(const std::string& path, std::uint32_t client) override;
  void lock(const std::string& path, const std::string& user) override;
  bool unlock(const std::string& path) override;
  [[nodiscard]] NodeContext& node() const override { return *core_; }
  void set_rights(std::shared_ptr<const Rights> rights) override;
  [[nodiscard]] std::vector<ServiceClient> clients() const override;
  /// What its clients use.
  struct Use {
    std::size_t sessions = 0;
    std::size_t objects = 0;
    std::size_t wires = 0;
    std::size_t pipes = 0;
  };
  [[nodiscard]] Use use() const;
  void disconnect(std::uint32_t endpoint) override;
  void close() override;

  [[nodiscard]] ObjectTree& objects() { return objects_; }
  [[nodiscard]] const std::shared_ptr<const TypeRegistry>& types() const { return types_; }
  /// Of the root object, of extra imports, and of all they import, sorted.
  [[nodiscard]] const std::vector<const Definition*>& definitions() const { return definitions_; }
  [[nodiscard]] const std::vector<const Definition*>& extra_imports() const {
    return options_.extra_imports;
  }
  /// The type of the root object for a client of this version, if any.
  [[nodiscard]] std::optional<std::string> root_type_for(
      const std::optional<DefinitionVersion>& client) const;

  [[nodiscard]] const Users* users() const { return options_.users.get(); }
  /// Whether only users may use the service.
  [[nodiscard]] bool requires_user() const {
    return options_.users != nullptr && options_.require_user;
  }
  [[nodiscard]] const ServiceLimits& limits() const { return options_.limits; }
  /// What each user may do; null: everything.
  [[nodiscard]] std::shared_ptr<const Rights> rights() const;
  [[nodiscard]] AnswerSizes& answer_sizes() { return answer_sizes_; }
  [[nodiscard]] Locks& locks() { return locks_; }
  [[nodiscard]] Monitors& monitors() { return *monitors_; }
  /// The keeper of locks and monitors in place of these two; null for none.
  [[nodiscard]] LockKeeper* lock_keeper() const { return options_.lock_keeper.get(); }

  /// False when the service has been closed.
  bool add_client(const std::shared_ptr<ServerEndpoint>& client);
  void remove_client(const ServerEndpoint& client);
  /// The client of this number; null when there is none.
  [[nodiscard]] std::shared_ptr<ServerEndpoint> find_client(std::uint32_t endpoint) const;
  /// Releases what was a client's own, and what nobody uses any more where there is much of that:
  /// on a thread of the node, behind its last request.
  void release_objects_of(std::uint32_t client);
  /// Tells that a client has gone: likewise.
  void announce_leaving(const ServiceClient& client) const;
  void announce_end(const ServerEndpoint& client) const;
  /// Sends an event of the object at a path to all clients, or to the one whose own it is.
  void fire(const std::string& path, std::uint32_t owner, const Member& member,
            const void* const* arguments);

 private:
  using Clients = std::vector<std::shared_ptr<ServerEndpoint>>;
  [[nodiscard]] std::shared_ptr<const Clients> connected() const;
  [[nodiscard]] std::string releasable(const std::string& path) const;
  void attach(const ServedObject& object);
  void detach(const ObjectTree::Released& released);
  static void tell_released(const endpoint::Core& core, ObjectTree::Released released);
  void tell_released_later(ObjectTree::Released released) const;
  static void tell_closed(ServerEndpoint& client);
  void notify(const std::function<void(const ServiceClient&)>& function,
              const ServiceClient& client) const;

  const std::shared_ptr<endpoint::Core> core_;
  const std::weak_ptr<Directory> directory_;
  const std::string name_;
  std::map<std::string, VarValue> attributes_ RR_GUARDED_BY(mutex_);
  std::shared_ptr<const Rights> rights_ RR_GUARDED_BY(mutex_);
  const ServiceOptions options_;  // without these two
  const std::shared_ptr<const TypeRegistry> types_;
  const std::vector<const Definition*> definitions_;
  ObjectTree objects_;
  AnswerSizes answer_sizes_;
  Locks locks_;
  const std::shared_ptr<Monitors> monitors_;
  std::shared_ptr<RightsFile> rights_file_;  // null without one

  std::atomic<bool> is_started_{false};
  mutable Mutex mutex_;
  std::shared_ptr<const Clients> clients_ RR_GUARDED_BY(mutex_);  // replaced, never changed
  bool is_closed_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace rr::service
