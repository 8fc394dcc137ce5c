// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "rr/call.hpp"
#include "rr/definition_check.hpp"
#include "rr/node_id.hpp"
#include "rr/stub.hpp"
#include "rr/varvalue.hpp"
#include "rr/visibility.hpp"

/// The client's side of a connected service.
namespace rr::client {
class DefinitionReader;
}  // namespace rr::client

namespace RR_VISIBLE rr {

/// How to connect.
struct ConnectOptions {
  /// Of a service that has users; then `credentials` usually holds `password`.
  std::string username{};
  /// What proves who the user is, as the service wants it: mostly `password`, a string.
  std::map<std::string, VarValue> credentials{};
  /// Logs in without TLS even at a URL that this node's discovery has found, which any host on the
  /// network can announce. A URL from elsewhere is not asked about.
  bool allow_clear_credentials = false;
  /// Qualified name of the type that the root object must have or implement. Empty: that of the
  /// stub.
  std::string object_type{};
  /// For calls of this client's stubs; 0: the node's request timeout.
  std::chrono::milliseconds request_timeout{0};
  /// Called once when either side has ended the session, on a thread of the node: the reason.
  /// operation_aborted means that this side closed it, connection_error a lost connection or a
  /// service that sends this client away, service_not_found that the service was closed,
  /// protocol_error that what came was no message or one over the limits.
  std::function<void(const Error&)> on_closed{};
  /// Called when the service has released the object at a path, on a thread of the node. Stubs for
  /// it and for what lies below may still be used and reach the object that is there then, if any.
  std::function<void(const std::string&)> on_path_released{};
  /// Instead of the node's, NodeOptions::definition_check.
  std::optional<DefinitionCheck> definition_check{};
  /// Internal, for rr::dynamic: reads the definitions that the service sends.
  std::shared_ptr<client::DefinitionReader> definition_reader{};  // internal: of rr::dynamic
};

/// A session with a service: closes it when destroyed. The stubs found through it stay, but their
/// calls fail once it is closed.
class ClientBase {
 public:
  /// No session: not open.
  ClientBase() = default;
  /// Takes over the session; `other` has none afterwards.
  ClientBase(ClientBase&& other) noexcept = default;
  /// Closes this session, and takes over the other one.
  ClientBase& operator=(ClientBase&& other) noexcept;
  ~ClientBase();

  /// Tells the service, waits for its answer for at most half a second, and ends the connection.
  /// Calls that are open fail with connection_error. Nothing happens the second time.
  /// with_options() around it counts for nothing.
  void close();
  /// False once either side has ended the session.
  [[nodiscard]] bool is_open() const;
  /// Ends all open calls of this session with operation_cancelled.
  void cancel_calls();

  /// As the service gave them when connecting.
  [[nodiscard]] const std::map<std::string, VarValue>& attributes() const;
  /// The id of the service's node.
  [[nodiscard]] const NodeId& remote_node() const;
  /// The name of the service's node; empty for none.
  [[nodiscard]] const std::string& remote_name() const;
  /// The type of the root object, as the service told it.
  [[nodiscard]] const std::string& object_type() const;
  /// The texts of the service's definitions, by their names.
  [[nodiscard]] std::map<std::string, std::string> definitions() const;
  /// Type of the object at an objref, as the service tells it now. Throws rr::Error.
  [[nodiscard]] std::string find_object_type(const std::string& path,
                                             const CallOptions& options = {}) const;
  /// Attributes as they are now. Throws rr::Error.
  [[nodiscard]] std::map<std::string, VarValue> fetch_attributes(
      const CallOptions& options = {}) const;

  /// Logs in, perhaps as another user than in connecting. Locks that were made stay those of the
  /// user before. Throws rr::Error (authentication_error; invalid_operation for a service without
  /// users).
  void authenticate(const std::string& username, const std::map<std::string, VarValue>& credentials,
                    const CallOptions& options = {});
  /// Logs out. Throws rr::Error.
  void logout(const CallOptions& options = {});

  /// For the runtime: Node::connect makes clients.
  explicit ClientBase(std::shared_ptr<Session> session);  // made by Node::connect
  /// For the runtime: the session; null when there is none.
  [[nodiscard]] const std::shared_ptr<Session>& rr_session() const { return session_; }
  /// Leaves this without its session, which stays open. For subscriptions.
  [[nodiscard]] std::shared_ptr<Session> rr_release() { return std::exchange(session_, nullptr); }

 private:
  std::shared_ptr<Session> session_;
};

/// What the objects of a generated stub are; null for rr::Stub, which stands for any object.
template <class S>
const ObjectType* type_of_stub() {
  if constexpr (std::is_same_v<S, Stub>) {
    return nullptr;
  } else {
    return &S().rr_object_type();
  }
}

/// For stub_cast(): throws rr::Error (service_error).
[[noreturn]] void refuse_stub();
/// A stub as an S; null stays null. Throws rr::Error (service_error) when it is none.
template <class S>
std::shared_ptr<S> stub_cast(std::shared_ptr<Stub> stub) {
  if (!stub) return nullptr;
  auto result = std::dynamic_pointer_cast<S>(std::move(stub));
  if (!result) refuse_stub();
  return result;
}

/// The same, with the stub of the root object.
template <class S>
class Client : public ClientBase {
 public:
  /// No session and no stub.
  Client() = default;
  /// For the runtime: Node::connect makes clients.
  Client(std::shared_ptr<Session> session, std::shared_ptr<S> stub)
      : ClientBase(std::move(session)), stub_(std::move(stub)) {}

  /// The stub of the root object: `arm->move_to(1, 0)`.
  S* operator->() const { return stub_.get(); }
  /// The stub of the root object.
  S& operator*() const { return *stub_; }
  /// The same stub, to be kept elsewhere. Its calls fail once the session is closed.
  [[nodiscard]] const std::shared_ptr<S>& stub() const { return stub_; }

 private:
  std::shared_ptr<S> stub_;
};

}  // namespace rr
