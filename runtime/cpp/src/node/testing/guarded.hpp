// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <semaphore>
#include <string>

#include "rr/callbacks.hpp"
#include "rr/memories.hpp"
#include "rr/node.hpp"
#include "rr/pipes.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "rr/users.hpp"
#include "rr/wires.hpp"

/// An object with a member of each kind, and users, for tests of who may do what.
namespace rr::testing {

extern const ObjectType rr_Guarded;

enum GuardedPlace : std::size_t {
  guarded_value,
  guarded_run,
  guarded_count,
  guarded_noticed,
  guarded_samples,
  guarded_level,
  guarded_store,
  guarded_ask,
  guarded_child,
  guarded_own,
  guarded_free,
};

class GuardedStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Guarded; }
  double get_value() { return rr_get<double>(member(guarded_value), {}); }
  void set_value(double value) { rr_set(member(guarded_value), {}, &value); }
  double run(const std::string& what) { return rr_call<double>(member(guarded_run), {}, what); }
  Generator<std::int32_t> count() {
    return rr_generate<std::int32_t, void>(member(guarded_count), {});
  }
  Event<double>& noticed() { return noticed_; }
  Pipe<double> samples() { return {*this, member(guarded_samples)}; }
  Wire<double> level() { return {*this, member(guarded_level)}; }
  ArrayMemory<double> store() { return {*this, member(guarded_store)}; }
  Callback<double()> ask() { return {*this, member(guarded_ask)}; }
  std::shared_ptr<GuardedStub> get_child(const std::string& index) {
    return rr_find_as<GuardedStub>(member(guarded_child), {}, index);
  }

 private:
  static const Member& member(std::size_t place) { return rr_Guarded.members[place]; }
  Event<double> noticed_{*this, member(guarded_noticed)};
};

class Guarded final : public Skeleton {
 public:
  Guarded();
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Guarded; }
  void rr_dispatch(std::size_t member, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t member, const ObjectIndex& index) override;
  std::shared_ptr<MemorySource> rr_memory(std::size_t /*member*/) override { return memory_; }
  [[nodiscard]] bool rr_has_monitor() const override { return true; }
  bool rr_monitor_enter(std::chrono::milliseconds timeout) override {
    return free.try_acquire_for(timeout);
  }
  void rr_monitor_exit() override { free.release(); }

  [[nodiscard]] PipeServer<double> samples() const {
    return {*this, rr_Guarded.members[guarded_samples]};
  }
  [[nodiscard]] WireServer<double> level() const {
    return {*this, rr_Guarded.members[guarded_level]};
  }
  void notice(double value) const { rr_fire_event(rr_Guarded.members[guarded_noticed], value); }
  [[nodiscard]] double ask(std::uint32_t client) const {
    return rr_call_back<double>(rr_Guarded.members[guarded_ask], {}, client);
  }
  template <class Token>
  auto async_ask(std::uint32_t client, Token&& token) const {
    return rr_async_call_back<double>(rr_Guarded.members[guarded_ask], {},
                                      std::forward<Token>(token), client);
  }

  std::function<double(const std::string&)> on_run;
  std::atomic<int> packets{0};   ///< that came by the pipe
  std::atomic<int> values{0};    ///< that came by the wire
  std::atomic<int> children{0};  ///< how often one was asked for
  std::shared_ptr<Guarded> last_child;
  std::binary_semaphore free{1};

 private:
  std::shared_ptr<StoredArrayMemory<double>> memory_ =
      std::make_shared<StoredArrayMemory<double>>(Array<double>(16));
  double value_ = 0;
};

/// alice and bob may lock, chief is an operator, guest is nothing. A password is the name.
class KnownUsers final : public Users {
 public:
  [[nodiscard]] User authenticate(const std::string& name,
                                  const std::map<std::string, VarValue>& credentials,
                                  const NodeId& node) const override;
};

/// A node with a Guarded.
struct GuardedService {
  explicit GuardedService(ServiceOptions options = with_users(), NodeOptions node_options = {})
      : node(std::move(node_options)) {
    service = node.register_service("guarded", object, std::move(options));
  }
  static ServiceOptions with_users() { return {.users = std::make_shared<KnownUsers>()}; }
  static ServiceOptions with_rights(const std::string& rules) {
    return {.users = std::make_shared<KnownUsers>(), .rights = std::make_shared<Rights>(rules)};
  }

  std::shared_ptr<Guarded> object = std::make_shared<Guarded>();
  Node node;
  Service service;
};

}  // namespace rr::testing
