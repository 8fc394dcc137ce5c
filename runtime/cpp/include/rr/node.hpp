// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/client.hpp"
#include "rr/error.hpp"
#include "rr/options.hpp"
#include "rr/service.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/subscription.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

class Discovery;
class ServiceInfoSubscription;

/// One participant: offers services, and connects to those of others.
///
///   rr::Node node({.name = "camera.host"});
///   node.register_service("camera", std::make_shared<MyCamera>());
///   node.listen_tcp(6257, "*");  // for other machines, too
///
///   rr::Node node;
///   auto camera = node.connect<CameraStub>("rr+tcp://host:6257/?service=camera");
///   camera->start();
///
/// Threads. A node has few threads of its own: one waits for the network and handles what comes in
/// place, another watches it. What user code may rely on:
///
/// Members of a service are called on a thread of the node, for each client one at a time, in the
/// order of its requests. Calls of different clients may overlap, so objects that are shared need
/// their own locks.
///
/// A handler that takes long holds up its own client only: after a few milliseconds another thread
/// waits for the network. NodeOptions::max_threads bounds how many there are,
/// NodeOptions::session_threads how many of them one client may keep. A handler can answer later
/// (Request::defer), and then holds up no other.
///
/// A blocking call sends in the calling thread, which reads the connection itself until its answer
/// is there, if no other thread does. It may be made anywhere, in handlers too.
///
/// Event handlers and completions of asynchronous calls run on a thread of the node, never inside a
/// call that the program makes. Events of one session come one at a time, in order.
///
/// No user code runs, and nothing that belongs to user code is destroyed, while the runtime holds a
/// lock.
class Node {
 public:
  /// Makes a node. Nothing listens yet, and no thread runs. Throws rr::Error: invalid_argument for
  /// a name, invalid_configuration for files that cannot be used.
  explicit Node(NodeOptions options = {});
  /// As shutdown(). On a thread of the node, or of run_aside(), it does not wait; what the node
  /// still runs must not need what goes away behind it.
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  /// Its id: that of the options, of its certificate, or a random one.
  [[nodiscard]] const NodeId& id() const;
  /// Its name; empty for none.
  [[nodiscard]] const std::string& name() const;

  /// Accepts connections at `rr+tcp://host:port`, port 0 meaning any; a host of `*`, or none, means
  /// all addresses. Returns the port. Throws rr::Error.
  std::uint16_t listen(std::string_view url);
  /// The same at `host`: for programs of this machine only, unless another one is given. `*` means
  /// all addresses of both families, so that every machine that reaches this one can connect.
  std::uint16_t listen_tcp(std::uint16_t port, std::string_view host = "localhost");
  /// Whether URLs of a scheme (`rr+tcp`) can be listened at and connected to.
  [[nodiscard]] bool has_channel(std::string_view scheme) const;
  /// Where a service may be reached, by what this node knows: one URL for each address it listens
  /// at.
  [[nodiscard]] std::vector<std::string> urls(std::string_view service) const;

  /// The same for others to use: any-addresses stand for all addresses of this machine as they are
  /// now, and IPv6 scopes, which mean nothing elsewhere, are left out.
  [[nodiscard]] std::vector<std::string> candidate_urls(std::string_view service) const;
  /// Finding other nodes, and being found: see rr/discovery.hpp, which is to be included.
  [[nodiscard]] Discovery discovery() const;

  /// Offers an object and what it refers to. The name is a letter, then letters, digits and
  /// underscores. Throws rr::Error.
  Service register_service(std::string name, std::shared_ptr<Skeleton> root,
                           ServiceOptions options = {});

  /// Makes the types of a definition known for what is received without being asked for: structs in
  /// varvalues, exceptions, objects behind varobjects. Those of stubs and services are known
  /// anyway.
  void add_definition(const Definition& definition);
  /// The same for one that was made while the program runs: the node keeps it as long as it lives.
  void add_definition(const std::shared_ptr<const Definition>& definition);

  /// Connects to the service at a URL. The root object must be an S, or implement it; with rr::Stub
  /// any object will do that this program has a definition of. Throws rr::Error.
  template <class S>
  Client<S> connect(std::string_view url, ConnectOptions options = {}) {
    return connect<S>(*state_, url, std::move(options));
  }
  /// The same without waiting: it happens on a thread of its own. With other completion tokens see
  /// rr/async.hpp.
  template <class S>
  std::future<Client<S>> async_connect(std::string url, ConnectOptions options = {}) {
    auto promise = std::make_shared<std::promise<Client<S>>>();
    auto future = promise->get_future();
    connect_aside<S>(std::move(url), std::move(options),
                     [promise](std::exception_ptr error, Client<S> client) {
                       if (error) {
                         promise->set_exception(std::move(error));
                       } else {
                         promise->set_value(std::move(client));
                       }
                     });
    return future;
  }
  /// The same, calling `done(std::exception_ptr, Client<S>)` on that thread.
  template <class S, class Done>
  void connect_aside(std::string url, ConnectOptions options, Done done) {
    // The node may go while this runs; its state waits.
    run_aside([state = state_.get(), url = std::move(url), options = std::move(options),
               done = std::move(done)]() mutable {
      Client<S> client;
      std::exception_ptr error;
      try {
        client = connect<S>(*state, url, std::move(options));
      } catch (...) {
        error = std::current_exception();
      }
      done(std::move(error), std::move(client));
    });
  }
  /// Keeps a connection to the service at a URL, until the subscription is closed or this node
  /// ends; see rr/subscription.hpp. Does not wait. Throws rr::Error: invalid_argument for what is
  /// no URL of a service or a filter's wrong expression, invalid_operation after shutdown().
  template <class Text>
  requires std::is_convertible_v<const Text&, std::string_view> ServiceSubscription
  subscribe(const Text& url, SubscriptionOptions options = {}) {
    return subscribe_to({{std::string(std::string_view(url))}}, std::move(options));
  }
  /// The same with several ways to one service, tried in this order.
  ServiceSubscription subscribe(std::vector<std::string> urls, SubscriptionOptions options = {}) {
    return subscribe_to({std::move(urls)}, std::move(options));
  }
  /// The same with several services, each with its URLs.
  ServiceSubscription subscribe_all(std::vector<std::vector<std::string>> services,
                                    SubscriptionOptions options = {}) {
    return subscribe_to(std::move(services), std::move(options));
  }

  /// Keeps a connection to each service that can be found, whose root object has one of these types
  /// or implements it, and that passes the filter; none: any type. Services come and go with what
  /// is announced. Listens with default options unless Discovery::listen() was called. Throws
  /// rr::Error: invalid_argument for a filter's wrong expression, connection_error when discovery
  /// cannot be listened to, invalid_operation after shutdown().
  ServiceSubscription subscribe_types(std::vector<std::string> types,
                                      SubscriptionOptions options = {});
  /// The same with one type.
  ServiceSubscription subscribe_type(std::string type, SubscriptionOptions options = {}) {
    return subscribe_types({std::move(type)}, std::move(options));
  }
  /// The same without connecting: tells which services there are. See rr/discovery.hpp.
  ServiceInfoSubscription subscribe_services(std::vector<std::string> types,
                                             ServiceFilter filter = {});

  /// Calls a function every `period`, or once after `delay`: see NodeContext in rr/timer.hpp.
  Timer every(std::chrono::nanoseconds period, std::function<void()> work);
  /// Calls a function once after `delay`: see NodeContext in rr/timer.hpp.
  Timer after(std::chrono::nanoseconds delay, std::function<void()> work);

  /// Runs something on a thread of its own, which shutdown() waits for. It may not throw. Throws
  /// rr::Error (invalid_operation) after shutdown().
  void run_aside(std::function<void()> work);

  /// What the node has counted, as OpenMetrics text: what it answers `GET /metrics` with. Throws
  /// rr::Error (invalid_operation) unless NodeOptions::metrics switches it on.
  [[nodiscard]] std::string metrics() const;
  /// Makes `GET /health` say that something is wrong (HTTP 503), and what, until it is called with
  /// an empty text. Any thread.
  void set_fault(std::string why);

  /// Closes all services, clients and connections, and waits for the node's threads: for handlers
  /// that run, for what they are still to be told, and for run_aside(). On a thread of the node, or
  /// of run_aside(), it does not wait, which is left to the destructor or to the next call from
  /// another thread. May be called again, and by several threads.
  void shutdown();

  /// Serves a connection that came another way: one end of a connected stream socket, which is
  /// taken over. Throws rr::Error (connection_error) when the node has been shut down or has as
  /// many connections as it may.
  void adopt(int descriptor);

 private:
  struct State;
  using Opened = std::pair<std::shared_ptr<Session>, std::shared_ptr<Stub>>;

  template <class S>
  static Client<S> connect(State& state, std::string_view url, ConnectOptions options) {
    auto [session, stub] = open(state, url, std::move(options), type_of_stub<S>());
    return Client<S>(std::move(session), stub_cast<S>(std::move(stub)));
  }
  ServiceSubscription subscribe_to(std::vector<std::vector<std::string>> services,
                                   SubscriptionOptions options);
  static Opened open(State& state, std::string_view url, ConnectOptions options,
                     const ObjectType* type);
  std::unique_ptr<State> state_;
};

}  // namespace rr
