// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "rr/definition.hpp"
#include "rr/holding.hpp"
#include "rr/mutex.hpp"
#include "rr/sequence.hpp"
#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/connection.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/service/object_tree.hpp"

namespace rr::service {

/// A generator that a client steps through. What is not constant is changed under the lock of its
/// Generators; the source is used by the thread whose step it is.
struct ClientGenerator {
  enum class State : std::uint8_t { open, closed, aborted, ended };

  std::shared_ptr<const ServedObject> object;  // lives longer than a coroutine of its
  const Member* member;
  std::shared_ptr<GeneratorSource> source;
  const Holding* result;     // null for void
  const Holding* parameter;  // null for void
  State state = State::open;
  channel::Time last_used{};
  std::uint32_t next_step = 0;     // the number of the next one that comes
  std::uint32_t current_step = 0;  // of the one whose turn it is
  channel::Charge charge{};        // for what a coroutine takes, about
};

/// The generators of one client by their numbers (07, section 8). None is destroyed under the lock,
/// nor while a step of it runs.
class Generators {
 public:
  /// Returns its number. Throws rr::Error: connection_error when the client has gone,
  /// out_of_system_resource when `limit` of them are open or it holds too much, and what `check`
  /// throws, which is asked when end_if() would find it.
  std::int32_t add(const std::shared_ptr<ClientGenerator>& generator, std::size_t limit,
                   const std::function<void()>& check);
  void remove(std::int32_t index);

  /// One request to a generator, while this exists: those that come meanwhile wait for its end.
  class Use {
   public:
    /// Throws rr::Error (invalid_operation) when the object has no generator of this number.
    Use(Generators& generators, const ServedObject& object, std::int32_t index,
        channel::Connection& connection);
    ~Use();
    Use(const Use&) = delete;
    Use& operator=(const Use&) = delete;

    ClientGenerator& operator*() const { return *generator_; }
    ClientGenerator* operator->() const { return generator_.get(); }
    [[nodiscard]] ClientGenerator::State state() const;
    /// As the client wishes: `closed` or `aborted`. The number stays known for a while.
    void close(ClientGenerator::State state);
    /// Forgets the generator, which goes away with this.
    void end();

   private:
    Generators& generators_;
    const std::int32_t index_;
    std::shared_ptr<ClientGenerator> generator_;
  };

  /// Those for which `is_over(path, member)` holds end. Returns how many.
  using Choice = std::function<bool(std::string_view, std::string_view)>;
  std::size_t end_if(const Choice& is_over);
  /// Those of an object that is released, and of those below it, end.
  void release_path(std::string_view path);
  /// All end; no other comes. Their last moments are left in `deferred`.
  void end(channel::DeferredCallbacks& deferred);
  /// Those that nobody has used for so long end; their last moments are left in `deferred`.
  void drop_unused(channel::Time now, channel::Milliseconds timeout,
                   channel::DeferredCallbacks& deferred);

 private:
  using Numbered = std::unordered_map<std::int32_t, std::shared_ptr<ClientGenerator>>;

  /// What was forgotten, which is to be destroyed without the lock; null for an unknown number.
  [[nodiscard]] std::shared_ptr<ClientGenerator> forget(std::int32_t index) RR_REQUIRES(mutex_);
  /// The same with all for which `is_over` holds.
  [[nodiscard]] std::vector<std::shared_ptr<ClientGenerator>> forget_if(
      const std::function<bool(const ClientGenerator&)>& is_over) RR_REQUIRES(mutex_);

  Mutex mutex_;
  Condition stepped_;
  bool has_ended_ RR_GUARDED_BY(mutex_) = false;
  Numbered generators_ RR_GUARDED_BY(mutex_);
  std::deque<std::int32_t> closed_ RR_GUARDED_BY(mutex_);  // of these, oldest first
};

}  // namespace rr::service
