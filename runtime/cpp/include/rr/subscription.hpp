// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/client.hpp"
#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/function.hpp"
#include "rr/member_subscription.hpp"
#include "rr/service_filter.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Subscriptions: connections to services that come and go (07, section 15; 05, section 8).
namespace rr::subscription {
class Services;
}  // namespace rr::subscription

namespace RR_VISIBLE rr {

/// How a subscription connects.
struct SubscriptionOptions {
  /// As in ConnectOptions.
  std::string username{};
  /// For `username`; usually `password`.
  std::map<std::string, VarValue> credentials{};
  /// As in ConnectOptions: for services that discovery finds.
  bool allow_clear_credentials = false;
  /// Qualified name of the type that root objects must have or implement. Empty: any.
  std::string object_type{};
  /// For calls of the clients' stubs; 0: the node's request timeout.
  std::chrono::milliseconds request_timeout{0};

  /// From a failure, or the loss of a connection, to the next attempt.
  std::chrono::milliseconds retry_delay{2'500};
  /// While attempts go on failing the delay doubles up to this; a success makes it retry_delay
  /// again. What is less than retry_delay means that the delay stays the same.
  std::chrono::milliseconds max_retry_delay{0};
  /// What an attempt may take, all URLs of the service together. Only the look-up of a host's name
  /// may take longer.
  std::chrono::milliseconds connect_timeout{10'000};

  /// Which services are wanted.
  ServiceFilter filter{};
  /// As in ConnectOptions, of each client.
  Function<void(const std::string& path)> on_path_released{};
  /// Internal: makes the reader of each session (ConnectOptions::definition_reader).
  Function<std::shared_ptr<client::DefinitionReader>()> make_definition_reader{};
};

/// How it stands with one service of a subscription.
struct SubscribedService {
  /// Of the service, in the order in which they are tried.
  std::vector<std::string> urls{};
  /// Whether it is connected now.
  bool is_connected = false;
  /// Once connected.
  SubscriptionClientId client{};
  /// Why the last attempt has failed, or the connection was lost. Nothing when it is connected, and
  /// before the first attempt has ended.
  std::optional<Error> last_error{};
  /// Attempts that have failed since it was last connected.
  std::size_t failures = 0;
  /// As the service gave them to the client that is connected; empty when there is none.
  std::map<std::string, VarValue> attributes{};
};

/// Keeps a connection to each of some services, and connects again when one is lost. Made by
/// Node::subscribe. Copies are handles of the same subscription, which lasts until it is closed or
/// its node is shut down, whether or not a handle is held. Any thread may use it; nothing
/// blocks but the waiting forms.
///
///   rr::ServiceSubscription camera = node.subscribe("rr+tcp://host:6257/?service=camera");
///   camera.wait_default_client<CameraStub>(5s)->start();
///   rr::WireSubscription<double> level = camera.subscribe_wire<double>("level");
///
/// A stub that was handed out belongs to one connection: when that is lost its calls fail, and the
/// next client has another stub. So ask for the client whenever you use it.
///
/// The program must know the types of the objects that it uses: those of stubs that it asks for it
/// does; for wires and pipes name them with use_types() or Node::add_definition().
class ServiceSubscription {
 public:
  /// A handle of nothing.
  ServiceSubscription() = default;

  /// Ends all clients that are not claimed, and what is being connected. Does not wait. Stubs
  /// that were handed out stay, but their calls fail.
  void close();
  /// False once it is closed or its node is shut down.
  [[nodiscard]] bool is_open() const;

  /// From now on these, alternatives of one service. A connection stays while its URL is among
  /// them. Throws rr::Error: invalid_argument for no URL at all or one that is none,
  /// invalid_operation when closed.
  void update_urls(std::vector<std::string> urls);
  /// The same for several services. One that shares a URL with one before is the same service.
  void update_services(std::vector<std::vector<std::string>> services);
  /// Of one made by Node::subscribe_type: services of other types, or those that pass another
  /// filter, from now on. Connections to those that match stay. Throws rr::Error: invalid_argument
  /// for a filter's wrong expression, invalid_operation when closed or made by URLs.
  void update_types(std::vector<std::string> types, ServiceFilter filter = {});
  /// See SubscriptionOptions. For what fails from now on.
  void set_retry_delay(std::chrono::milliseconds delay, std::chrono::milliseconds maximum = {});

  /// Makes known the types of these stubs, and what their definitions import.
  template <class... S>
  void use_types() {
    (learn(type_of_stub<S>()), ...);
  }

  /// The client that has been connected longest; null when there is none. Throws rr::Error
  /// (service_error) when it is no S.
  template <class S>
  [[nodiscard]] std::shared_ptr<S> try_default_client() const {
    return stub_cast<S>(find(type_of_stub<S>()));
  }
  /// Throws rr::Error (connection_error, with the reason) when there is none.
  template <class S>
  [[nodiscard]] std::shared_ptr<S> default_client() const {
    return stub_cast<S>(need(type_of_stub<S>()));
  }
  /// Waits for one. Throws rr::Error: operation_timeout with the reason of the last failure,
  /// invalid_operation when this is closed.
  template <class S>
  [[nodiscard]] std::shared_ptr<S> wait_default_client(std::chrono::milliseconds limit) const {
    return stub_cast<S>(wait(type_of_stub<S>(), limit));
  }
  /// void(std::exception_ptr, std::shared_ptr<S>). Defined in rr/async.hpp.
  template <class S, class Token>
  auto async_default_client(std::chrono::milliseconds limit, Token&& token) const;

  /// Those that are connected, longest first.
  [[nodiscard]] std::vector<SubscriptionClientId> connected_clients() const;
  /// One of them; null when it is not connected. Throws as try_default_client().
  template <class S>
  [[nodiscard]] std::shared_ptr<S> client(const SubscriptionClientId& id) const {
    return stub_cast<S>(find(id, type_of_stub<S>()));
  }
  /// How it stands with all services.
  [[nodiscard]] std::vector<SubscribedService> services() const;
  /// The reason of the failure that came last, of services that are not connected.
  [[nodiscard]] std::optional<Error> last_error() const;

  /// Keeps a client from being closed with the subscription: from now on it belongs to who holds
  /// what is returned, which closes it when destroyed. While both exist the subscription uses it
  /// too, and connects anew when it ends. Throws rr::Error: invalid_argument for a stub of another
  /// session or an old one, invalid_operation for one that is claimed already.
  template <class S>
  Client<S> claim_client(std::shared_ptr<S> stub) {
    auto session = claim(stub.get());
    return Client<S>(std::move(session), std::move(stub));
  }
  /// Gives a claimed client back. When the subscription is closed the client is closed too, without
  /// waiting. Throws rr::Error (invalid_argument) for one that was not claimed here.
  void release_client(ClientBase&& client);

  /// Calls `function` for each client that is connected, those that are already first. These three
  /// run one at a time, in order, on a thread of the node, and may use the subscription.
  Subscription on_connected(Function<void(const SubscriptionClientId&)> function);
  /// Calls `function` for each client that has ended, with the reason: see
  /// ConnectOptions::on_closed.
  Subscription on_disconnected(Function<void(const SubscriptionClientId&, const Error&)> function);
  /// Calls `function` for each attempt that has failed: the URLs of the service, and the reason of
  /// the last of them. Services whose last attempt has failed come first.
  Subscription on_failed(Function<void(const std::vector<std::string>&, const Error&)> function);

  /// Connects a wire of the object at a path at all clients, now and later. Paths begin with the
  /// name of the service or with `*`, which stands for it; empty means the root. Asking for the
  /// same wire again gives another handle of the same: a client can connect a wire once. Throws
  /// rr::Error (invalid_argument for what is no path; invalid_operation when closed, or when the
  /// same wire is used with another T; data_type_mismatch for a T that rr::dynamic has not).
  template <class T>
  WireSubscription<T> subscribe_wire(std::string_view member, std::string_view path = {}) {
    return WireSubscription<T>(add_wire(member, path, holding_of<T>));
  }
  /// Connects an endpoint of a pipe likewise; each call has endpoints of its own. When more than
  /// `max_received` packets wait to be received the oldest is lost; 0: no limit.
  template <class T>
  PipeSubscription<T> subscribe_pipe(std::string_view member, std::string_view path = {},
                                     std::size_t max_received = 0) {
    return PipeSubscription<T>(add_pipe(member, path, holding_of<T>, max_received));
  }
  /// Finds the object at a path at all clients. `S`, if given, is made known.
  template <class S = Stub>
  SubObjectSubscription subscribe_sub_object(std::string_view path) {
    learn(type_of_stub<S>());
    return SubObjectSubscription(add_sub_object(path));
  }

  /// For the runtime: Node::subscribe makes it.
  explicit ServiceSubscription(std::shared_ptr<subscription::Services> services);  // by Node

 private:
  using LinksPointer = std::shared_ptr<subscription::Links>;
  void learn(const ObjectType* type) const;
  std::shared_ptr<Stub> find(const ObjectType* type) const;
  std::shared_ptr<Stub> find(const SubscriptionClientId& id, const ObjectType* type) const;
  std::shared_ptr<Stub> need(const ObjectType* type) const;
  std::shared_ptr<Stub> wait(const ObjectType* type, std::chrono::milliseconds limit) const;
  /// The completion's result is a std::shared_ptr<Stub>.
  void start_wait(const ObjectType* type, std::chrono::milliseconds limit,
                  std::unique_ptr<Completion> completion) const;
  std::shared_ptr<Session> claim(const Stub* stub);
  LinksPointer add_wire(std::string_view member, std::string_view path, const Holding& holding);
  LinksPointer add_pipe(std::string_view member, std::string_view path, const Holding& holding,
                        std::size_t max_received);
  LinksPointer add_sub_object(std::string_view path);

  std::shared_ptr<subscription::Services> services_;
};

}  // namespace rr
