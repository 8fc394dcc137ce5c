// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/export_file.hpp"
#include "gateway/topics.hpp"
#include "rr/dynamic.hpp"
#include "rr/error.hpp"
#include "rr/function.hpp"
#include "rr/node.hpp"
#include "rr/subscription.hpp"

namespace rr::gateway {

/// The object at a path below another (gateway/topics.hpp). Does not wait.
void find_object(const dynamic::Object& from, const std::string& path,
                 const Function<void(std::exception_ptr, dynamic::Object)>& done);

/// The session of one user with the robot's service, made again when it is lost. Any thread may use
/// it; functions are called on threads of the node.
class RobotSession : public std::enable_shared_from_this<RobotSession> {
 public:
  /// What becomes of finding an object.
  using Found = Function<void(std::exception_ptr, dynamic::Object)>;
  /// Notified of the connection.
  struct Listener {
    Function<void(const dynamic::Object& root)> connected;
    /// Also of each attempt to connect that has failed.
    Function<void(const std::string& reason)> disconnected;
    /// The object at a path below the root was released.
    Function<void(const std::string& path)> released;
  };

  /// A user without a name does not log in. Does not wait.
  static std::shared_ptr<RobotSession> open(Node& node, const std::string& url,
                                            const MappedUser& user, Listener listener);
  ~RobotSession() { subscription_.close(); }
  RobotSession(const RobotSession&) = delete;
  RobotSession& operator=(const RobotSession&) = delete;

  /// The object at a path below the root (gateway/topics.hpp). Fails with connection_error when the
  /// robot is not connected.
  void find(const std::string& path, const Found& done);
  /// Whether find() can succeed. False, with the reason, when the robot is not connected; without
  /// a reason while the first attempt goes on.
  [[nodiscard]] bool is_connected(std::optional<Error>& reason) const;
  /// Attributes of the service, as it gave them when it was connected; none when it is not.
  [[nodiscard]] std::map<std::string, VarValue> attributes() const;

 private:
  RobotSession() = default;
  [[nodiscard]] dynamic::Object root() const;
  void listen(Listener listener);

  ServiceSubscription subscription_;
  std::vector<Subscription> listeners_;
};

}  // namespace rr::gateway
