// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <rr/node.hpp>
#include <string>
#include <vector>

#include "conformance/runners/shared/binding.hpp"
#include "conformance/runners/shared/caller.hpp"

namespace rr::conformance {

/// What arrives without being asked for: events, sessions that end, objects that are released.
class Arrivals {
 public:
  void add(Json thing);
  /// Waits for so many, not for ever, and takes all that have come.
  Json wait(std::size_t count);
  void clear();

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  Json things_ = Json::array();
};

/// `call`: a node that does the steps of a plan, by way of one kind of client.
class CallingNode {
 public:
  explicit CallingNode(Binding& binding) : binding_(binding) {}
  ~CallingNode() { stop(); }

  /// {do: start, ...} and {do: stop_node} give {done}; {do: step, step} gives what became of it.
  Json answer(const Json& request);

 private:
  // An object that the plan has a name for.
  struct Object {
    Held held;
    std::unique_ptr<Caller> caller;
    std::string client;  ///< name of its client
  };

  void stop();
  Json play(const Json& step);
  Json connect(const Json& step);
  Json find(const Json& step);
  Json find_object_type(const Json& step);
  Json listen(const Json& step);
  Json attributes(const Json& step);
  [[nodiscard]] std::map<std::string, VarValue> credentials(const Json& step) const;
  void authenticate(const Json& step);
  Json local_services(const Json& step);
  Json play_session(const std::string& operation, const Json& step);
  Json play_pipe(const std::string& operation, const Json& step);
  Json play_wire(const std::string& operation, const Json& step);
  Json play_memory(const std::string& operation, const Json& step);
  Json play_generator(const std::string& operation, const Json& step);
  Json set_callback(const Json& step);
  Json keep(const std::string& name, const std::string& client, Held held);
  Object& object(const Json& step);

  Binding& binding_;
  Arrivals arrivals_;
  std::unique_ptr<Node> node_;
  std::map<std::string, std::unique_ptr<ClientBase>> clients_;
  std::map<std::string, Object> objects_;
  std::vector<Subscription> subscriptions_;
  // What steps hold by a handle.
  std::map<std::string, std::unique_ptr<PlannedPipe>> pipes_;
  std::map<std::string, std::unique_ptr<PlannedWire>> wires_;
  std::map<std::string, std::unique_ptr<PlannedGenerator>> generators_;
};

}  // namespace rr::conformance
