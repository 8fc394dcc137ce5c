// SPDX-License-Identifier: Apache-2.0
#include "rr/node.hpp"

#include <algorithm>
#include <utility>

#include "rr/url.hpp"
#include "runtime/cpp/src/channel/status.hpp"
#include "runtime/cpp/src/endpoint/user_code.hpp"
#include "runtime/cpp/src/node/node_state.hpp"
#include "runtime/cpp/src/platform/threads.hpp"

namespace rr {

void NodeState::keep(const std::shared_ptr<Session>& session) {
  const MutexLock lock(mutex);
  if (is_shut_down) throw Error(ErrorCode::invalid_operation, "the node is shut down");
  remember(sessions, session);
}

void NodeState::join_done() {
  std::erase_if(workers, [](Worker& worker) {
    if (!*worker.is_done) return false;
    worker.thread.join();
    return true;
  });
}

void NodeState::run_aside(std::function<void()> work) {
  auto is_done = std::make_shared<std::atomic<bool>>(false);
  const MutexLock lock(mutex);
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

subscription::Host NodeState::host() {
  return {core, [this](std::function<void()> work) { run_aside(std::move(work)); },
          [this](const std::shared_ptr<Session>& session) { keep(session); }};
}

bool NodeState::is_own_thread() const {
  if (served_aside == this || core->reactor().is_own_thread()) return true;
  const RecursiveMutexLock lock(making);
  return services && services->is_own_thread();
}

thread_local const NodeState* NodeState::served_aside = nullptr;

void NodeState::end_part(std::unique_ptr<NodePart> NodeState::*slot) {
  NodePart* part = nullptr;
  {
    const RecursiveMutexLock lock(making);
    have_parts_ended = true;
    part = (this->*slot).get();
  }
  if (part != nullptr) part->end();
}

void NodeState::begin_end() {
  std::vector<std::weak_ptr<channel::Connection>> old_accepted;
  std::vector<std::weak_ptr<Session>> old_sessions;
  {
    const MutexLock lock(mutex);
    if (std::exchange(is_shut_down, true)) return;
    old_accepted.swap(accepted);
    old_sessions.swap(sessions);
  }
  places->end();
  end_part(&NodeState::discovery);
  end_part(&NodeState::subscriptions);
  for (const auto& session : old_sessions) {
    if (const auto alive = session.lock()) alive->drop();
  }
  end_part(&NodeState::services);
  for (const auto& connection : old_accepted) {
    if (const auto alive = connection.lock()) {
      alive->close(Error(ErrorCode::connection_error, "the node is shut down"));
    }
  }
}

void NodeState::finish_end() {
  const MutexLock one_at_a_time(ending);
  std::vector<Worker> old_workers;
  {
    const MutexLock lock(mutex);
    old_workers.swap(workers);
  }
  for (Worker& worker : old_workers) worker.thread.join();
  core->reactor().connections().wait_for_none();
  core->stop();
}

Node::Node(NodeOptions options) : state_(std::make_unique<State>()) {
  state_->core = std::make_shared<endpoint::Core>(std::move(options));
}

Node::~Node() {
  state_->begin_end();
  if (!state_->is_own_thread()) {
    state_->finish_end();
    return;
  }
  // This thread cannot wait for its own end.
  platform::run_apart([state = std::shared_ptr(std::move(state_))] { state->finish_end(); });
}

const NodeId& Node::id() const { return state_->core->options().id; }
const std::string& Node::name() const { return state_->core->options().name; }

bool Node::has_channel(std::string_view scheme) const {
  try {
    state_->core->channel(std::string(scheme));
    return true;
  } catch (const Error&) {
    return false;
  }
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

Timer Node::every(std::chrono::nanoseconds period, std::function<void()> work) {
  return state_->core->every(period, std::move(work));
}

Timer Node::after(std::chrono::nanoseconds delay, std::function<void()> work) {
  return state_->core->after(delay, std::move(work));
}

void Node::run_aside(std::function<void()> work) { state_->run_aside(std::move(work)); }

std::string Node::metrics() const {
  const auto& status = state_->core->status();
  if (!status) {
    throw Error(ErrorCode::invalid_operation, "the node counts nothing: NodeOptions::metrics");
  }
  return status->metrics();
}

void Node::set_fault(std::string why) {
  if (const auto& status = state_->core->status()) status->set_fault(std::move(why));
}

void Node::shutdown() {
  state_->begin_end();
  if (!state_->is_own_thread()) state_->finish_end();
}

}  // namespace rr
