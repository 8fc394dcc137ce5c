// SPDX-License-Identifier: Apache-2.0
#include "rr/node.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "rr/discovery.hpp"
#include "rr/url.hpp"
#include "runtime/cpp/src/channel/channel.hpp"
#include "runtime/cpp/src/client/session.hpp"
#include "runtime/cpp/src/discovery/interfaces.hpp"
#include "runtime/cpp/src/discovery/node_discovery.hpp"
#include "runtime/cpp/src/discovery/service_infos.hpp"
#include "runtime/cpp/src/discovery/type_source.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"
#include "runtime/cpp/src/endpoint/service_index_types.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"
#include "runtime/cpp/src/service/directory.hpp"
#include "runtime/cpp/src/subscription/owner.hpp"

namespace rr {

namespace {

// The places where a node listens.
class Places {
 public:
  void add(std::unique_ptr<channel::Listener> listener) {
    const std::lock_guard lock(mutex_);
    if (has_ended_) throw Error(ErrorCode::invalid_operation, "the node is shut down");
    listeners_.push_back(std::move(listener));
  }
  void end() {
    std::vector<std::unique_ptr<channel::Listener>> old;
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    old.swap(listeners_);  // they end when the lock has gone
  }
  // As the listeners say.
  std::vector<std::string> urls() {
    std::vector<std::string> result;
    const std::lock_guard lock(mutex_);
    for (const auto& listener : listeners_) {
      for (std::string& url : listener->urls()) result.push_back(std::move(url));
    }
    return result;
  }
  // All of them say the newest nonce, whoever comes last. Returns what went wrong.
  std::string tell_nonce(const discovery::Announcer& announcer) {
    std::string failure;
    const std::lock_guard lock(mutex_);
    const std::string nonce = announcer.nonce();
    for (const auto& listener : listeners_) {
      try {
        listener->services_changed(nonce);
      } catch (const Error& error) {
        failure = error.message();
      }
    }
    return failure;
  }

 private:
  std::mutex mutex_;
  bool has_ended_ = false;
  std::vector<std::unique_ptr<channel::Listener>> listeners_;
};

}  // namespace

struct Node::State {
  std::shared_ptr<endpoint::Core> core;
  std::shared_ptr<service::Directory> directory;
  std::shared_ptr<subscription::Owner> subscriptions;
  std::shared_ptr<discovery::NodeDiscovery> discovery;
  // Threads of run_aside(), and whether they have done their work.
  struct Worker {
    std::thread thread;
    std::shared_ptr<std::atomic<bool>> is_done;
  };

  std::mutex mutex;
  bool is_shut_down = false;
  const std::shared_ptr<Places> places = std::make_shared<Places>();
  std::vector<std::weak_ptr<channel::Connection>> accepted;
  std::vector<std::weak_ptr<Session>> sessions;
  std::vector<Worker> workers;
  static thread_local const State* served_aside;  // by this thread, if it is a worker

  std::mutex ending;  // while a thread waits for the others to end; taken before `mutex`

  // Gives each new connection a receiver, and remembers it for the end.
  channel::AcceptHandler accept_handler() {
    return [this](std::shared_ptr<channel::Connection> connection) {
      {
        const std::lock_guard lock(mutex);
        if (is_shut_down) throw Error(ErrorCode::connection_error, "the node is shut down");
        remember(accepted, connection);
      }
      return directory->accept(std::move(connection));
    };
  }

  // Drops what has gone whenever the list would grow.
  template <class T>
  static void remember(std::vector<std::weak_ptr<T>>& list, const std::shared_ptr<T>& item) {
    if (list.size() == list.capacity()) {
      std::erase_if(list, [](const std::weak_ptr<T>& other) { return other.expired(); });
    }
    list.push_back(item);
  }

  void keep(const std::shared_ptr<Session>& session) {
    const std::lock_guard lock(mutex);
    if (is_shut_down) throw Error(ErrorCode::invalid_operation, "the node is shut down");
    remember(sessions, session);
  }

  void join_done() {
    std::erase_if(workers, [](Worker& worker) {
      if (!*worker.is_done) return false;
      worker.thread.join();
      return true;
    });
  }

  void run_aside(std::function<void()> work) {
    auto is_done = std::make_shared<std::atomic<bool>>(false);
    const std::lock_guard lock(mutex);
    if (is_shut_down) throw Error(ErrorCode::invalid_operation, "the node is shut down");
    join_done();
    std::thread thread([this, work = std::move(work), is_done]() mutable {
      served_aside = this;
      endpoint::call_user_code(*core, "work aside", work);
      work = nullptr;  // what it owns may use the node when it goes
      *is_done = true;
    });
    workers.push_back({std::move(thread), std::move(is_done)});
  }

  [[nodiscard]] bool is_own_thread() const {
    return served_aside == this || core->reactor().is_own_thread() ||
           directory->logins().is_own_thread();
  }
  void begin_end();
  void finish_end();
};

thread_local const Node::State* Node::State::served_aside = nullptr;

// Ends what the node has to do with others. Waits for nobody.
void Node::State::begin_end() {
  std::vector<std::weak_ptr<channel::Connection>> old_accepted;
  std::vector<std::weak_ptr<Session>> old_sessions;
  {
    const std::lock_guard lock(mutex);
    if (std::exchange(is_shut_down, true)) return;
    old_accepted.swap(accepted);
    old_sessions.swap(sessions);
  }
  places->end();
  discovery->end();
  subscriptions->end();
  for (const auto& session : old_sessions) {
    if (const auto alive = session.lock()) alive->drop();
  }
  directory->close();
  for (const auto& connection : old_accepted) {
    if (const auto alive = connection.lock()) {
      alive->close(Error(ErrorCode::connection_error, "the node is shut down"));
    }
  }
}

// Waits for the node's threads, and so for what runs on them. Not on one of them.
void Node::State::finish_end() {
  const std::lock_guard one_at_a_time(ending);
  std::vector<Worker> old_workers;
  {
    const std::lock_guard lock(mutex);
    old_workers.swap(workers);
  }
  for (Worker& worker : old_workers) worker.thread.join();
  core->reactor().wait_for_connections();
  core->stop();
}

namespace {

void tell_nonce(Places& places, discovery::NodeDiscovery& discovery, const endpoint::Core& core) {
  const std::string failure = places.tell_nonce(discovery.announcer());
  const auto& log = core.options().log;
  if (!failure.empty() && log) log(LogLevel::warning, failure);
}

}  // namespace

Node::Node(NodeOptions options) : state_(std::make_unique<State>()) {
  state_->core = std::make_shared<endpoint::Core>(std::move(options));
  state_->directory = std::make_shared<service::Directory>(state_->core);
  const subscription::Host host{
      state_->core,
      [state = state_.get()](std::function<void()> work) { state->run_aside(std::move(work)); },
      [state = state_.get()](const std::shared_ptr<Session>& session) { state->keep(session); }};
  state_->discovery = std::make_shared<discovery::NodeDiscovery>(
      host, [state = state_.get()] { return state->places->urls(); });
  const std::weak_ptr<discovery::NodeDiscovery> known = state_->discovery;
  state_->directory->set_discovery({[known] {
                                      const auto discovery = known.lock();
                                      return discovery ? discovery->detected_nodes()
                                                       : std::vector<DetectedNode>();
                                    },
                                    [known, places = state_->places, core = state_->core] {
                                      const auto discovery = known.lock();
                                      if (!discovery) return;
                                      discovery->announcer().services_changed();
                                      tell_nonce(*places, *discovery, *core);
                                    }});
  state_->directory->start();
  state_->subscriptions = std::make_shared<subscription::Owner>(host);
}

Node::~Node() {
  state_->begin_end();
  if (!state_->is_own_thread()) {
    state_->finish_end();
    return;
  }
  // This thread cannot wait for its own end.
  std::thread([state = std::move(state_)] { state->finish_end(); }).detach();
}

const NodeId& Node::id() const { return state_->core->options().id; }
const std::string& Node::name() const { return state_->core->options().name; }

std::uint16_t Node::listen(std::string_view url) {
  const Url parsed = Url::parse(url);
  state_->core->start();
  auto listener = state_->core->channel(parsed.scheme).listen(parsed, state_->accept_handler());
  const std::uint16_t port = Url::parse(listener->urls().front()).port;
  state_->places->add(std::move(listener));
  tell_nonce(*state_->places, *state_->discovery, *state_->core);
  state_->discovery->announcer().announce_soon();
  return port;
}

std::uint16_t Node::listen_tcp(std::uint16_t port, std::string_view host) {
  const bool needs_brackets = host.find(':') != std::string_view::npos && !host.starts_with('[');
  const std::string place = needs_brackets ? "[" + std::string(host) + "]" : std::string(host);
  return listen("rr+tcp://" + place + ":" + std::to_string(port));
}

bool Node::has_channel(std::string_view scheme) const {
  try {
    state_->core->channel(std::string(scheme));
    return true;
  } catch (const Error&) {
    return false;
  }
}

std::vector<std::string> Node::urls(std::string_view service) const {
  std::vector<std::string> result;
  for (const std::string& url : state_->places->urls()) {
    result.push_back(service_index::own_service_url(url, id(), service));
  }
  return result;
}

std::vector<std::string> Node::candidate_urls(std::string_view service) const {
  std::vector<std::string> result;
  const auto addresses = discovery::local_addresses();
  for (const std::string& base : state_->places->urls()) {
    for (const std::string& url : discovery::reachable_urls(base, addresses)) {
      result.push_back(service_index::service_url(url, id(), service));
    }
  }
  return result;
}

Discovery Node::discovery() const { return Discovery(state_->discovery); }

ServiceSubscription Node::subscribe_types(std::vector<std::string> types,
                                          SubscriptionOptions options) {
  state_->discovery->ensure_listening();
  ServiceFilter filter = options.filter;
  const auto services = state_->subscriptions->add(std::move(options));
  const auto& watch = state_->discovery->watch_pointer();
  const auto source = std::make_shared<discovery::TypeSource>(watch, state_->core, services,
                                                              std::move(types), std::move(filter));
  services->set_source(source);
  watch->add(source);
  return ServiceSubscription(services);
}

ServiceInfoSubscription Node::subscribe_services(std::vector<std::string> types,
                                                 ServiceFilter filter) {
  const auto& watch = state_->discovery->watch_pointer();
  const auto infos = std::make_shared<discovery::ServiceInfos>(watch, state_->core,
                                                               std::move(types), std::move(filter));
  state_->discovery->ensure_listening();
  watch->add(infos);
  return ServiceInfoSubscription(infos);
}

Service Node::register_service(std::string name, std::shared_ptr<Skeleton> root,
                               ServiceOptions options) {
  return Service(state_->directory->add(std::move(name), std::move(root), std::move(options)));
}

void Node::add_definition(const Definition& definition) {
  state_->core->add_definition(definition);
}

void Node::add_definition(const std::shared_ptr<const Definition>& definition) {
  state_->core->keep_definition(definition);
}

Node::Opened Node::open(State& state, std::string_view url, ConnectOptions options,
                        const ObjectType* type) {
  const Url parsed = Url::parse(url);
  if (type != nullptr) state.core->add_definition(type->definition);
  auto session = std::make_shared<Session>(state.core, parsed, std::move(options));
  state.keep(session);
  auto stub = session->connect(parsed, type);
  return {std::move(session), std::move(stub)};
}

ServiceSubscription Node::subscribe_to(std::vector<std::vector<std::string>> services,
                                       SubscriptionOptions options) {
  return ServiceSubscription(state_->subscriptions->add(std::move(services), std::move(options)));
}

Timer Node::every(std::chrono::nanoseconds period, std::function<void()> work) {
  return state_->core->every(period, std::move(work));
}

Timer Node::after(std::chrono::nanoseconds delay, std::function<void()> work) {
  return state_->core->after(delay, std::move(work));
}

void Node::run_aside(std::function<void()> work) { state_->run_aside(std::move(work)); }

void Node::adopt(int descriptor) {
  state_->core->start();
  channel::adopt_socket(state_->core->context(), descriptor, state_->accept_handler());
}

void Node::shutdown() {
  state_->begin_end();
  if (!state_->is_own_thread()) state_->finish_end();
}

}  // namespace rr
