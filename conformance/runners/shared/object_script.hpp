// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <rr/service.hpp>
#include <rr/skeleton.hpp>
#include <semaphore>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "conformance/harness/json.hpp"

namespace rr::conformance {

/// What one object is told to do, a node of service.json, and its state, whatever its members are
/// made of. Used by any thread. Functions that drive other members are known by their names:
/// `fire_<event>`, `send_<pipe>`, `close_<pipe>`, `received_count`, `send_<wire>`, `close_<wire>`,
/// `last_<wire>`, `call_<callback>`, `release_child`; with `_later` behind it a function does so
/// when it has been answered. Behind `call_X_later` comes the event `answered_X`, if there is one.
/// An outcome with `does` says so for a function of any name; null: it does nothing of the kind.
class ObjectScript {
 public:
  explicit ObjectScript(Json node) : node_(std::move(node)) {}
  ObjectScript(const ObjectScript&) = delete;
  ObjectScript& operator=(const ObjectScript&) = delete;
  virtual ~ObjectScript() = default;

  /// Called when the service reaches its object.
  void attached(ServiceContext& context) { context_ = &context; }

  /// What the script says about a member that is no function.
  Json told(std::string_view kind, std::string_view name);
  /// Null for a property that has none yet.
  Json value_of(std::string_view property);
  void set_value(std::string_view property, Json value);
  /// What the next call of a function gives; `result_type` names the type that it is to be of.
  Json outcome(std::string_view function, const Json& parameters, std::string_view result_type);
  /// The outcome itself: that of a generator function is for ScriptedSteps.
  Json next_outcome(std::string_view function, const Json& parameters);

  /// The object that an objref gives; `index` is null for one without index. Null when the script
  /// has no such object. Throws rr::Error (invalid_argument) for an unknown index.
  std::shared_ptr<rr::Skeleton> child(std::string_view objref, const Json& index = nullptr);

  /// Throws what the `throw` of an outcome says.
  [[noreturn]] void raise_told(const Json& what, const Json& parameters = Json::array()) const;

  /// The monitor of the object, which those have that have a member without lock.
  static bool has_monitor(const ObjectType& type);
  bool enter_monitor(std::chrono::milliseconds timeout) {
    return monitor_.try_acquire_for(timeout);
  }
  void exit_monitor() { monitor_.release(); }

 protected:
  /// Does what a function is for; it is told the type that the function is to give.
  using Action = std::function<Json(std::string_view result_type)>;
  /// Not while the object is used.
  void add_action(const std::string& function, Action action) {
    actions_[function] = std::move(action);
  }
  void count_packet() { ++received_; }
  [[nodiscard]] int packet_count() const { return received_; }
  /// Does it once what happens now has been answered; nobody is left to be told what it throws, so
  /// the error output is, by this name.
  void do_later(std::string name, std::function<void()> what);
  /// Who is served: whose call this is, or put this off.
  [[nodiscard]] static std::uint32_t client();
  /// Waits for what has been put off. First in the destructor of what that uses.
  void finish();

  /// Reads the parameter of an error.
  [[nodiscard]] virtual VarValue read_parameter(const Json& json) const = 0;
  /// Makes an object of this type that does what the node says.
  [[nodiscard]] virtual std::shared_ptr<rr::Skeleton> make_child(const std::string& type,
                                                                 Json node) const = 0;

 private:
  void release(const std::string& path);
  [[nodiscard]] bool is_known_by_name(std::string_view function);
  std::optional<Json> act(std::string_view name, const Json& parameters,
                          std::string_view result_type);

  std::mutex mutex_;
  Json node_;
  std::map<std::string, Action, std::less<>> actions_;
  std::map<std::string, std::size_t> calls_;
  std::map<std::string, std::shared_ptr<rr::Skeleton>> children_;
  std::atomic<int> received_ = 0;
  ServiceContext* context_ = nullptr;
  std::binary_semaphore monitor_{1};
  std::vector<std::thread> put_off_;
};

/// The steps that a script tells for a generator: `yield` values or `accept` so many, then the end,
/// or instead of it the error `end`.
class ScriptedSteps {
 public:
  ScriptedSteps(const ObjectScript& script, Json steps)
      : script_(script), steps_(std::move(steps)) {}

  /// False at the end.
  bool take();
  /// What the next step gives, null where it gives nothing; nothing at the end.
  std::optional<Json> give();

 private:
  [[nodiscard]] std::size_t count() const;

  const ObjectScript& script_;
  const Json steps_;
  std::size_t step_ = 0;
};

}  // namespace rr::conformance
