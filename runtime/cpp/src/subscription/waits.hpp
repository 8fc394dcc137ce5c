// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/stub.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"

namespace rr::subscription {

/// Something that has a stub at times, and those who wait for it.
class Waits {
 public:
  explicit Waits(std::shared_ptr<endpoint::Core> core) : core_(std::move(core)) {}
  virtual ~Waits() = default;

  /// The stub if there is one. Throws rr::Error when it has another type.
  virtual std::shared_ptr<Stub> find(const ObjectType* type) = 0;
  /// Throws rr::Error (connection_error) when there is none.
  std::shared_ptr<Stub> need(const ObjectType* type);
  /// Throws rr::Error (operation_timeout; invalid_operation when closed).
  std::shared_ptr<Stub> wait(const ObjectType* type, std::chrono::milliseconds limit);
  void start_wait(const ObjectType* type, std::chrono::milliseconds limit,
                  std::unique_ptr<Completion> completion);

 protected:
  [[nodiscard]] virtual bool has_ended() const = 0;
  [[nodiscard]] virtual std::optional<Error> why_none() const = 0;
  /// What `find` gives, or has_ended(), may be another now. Not under the locks that these take.
  void changed();
  [[nodiscard]] const std::shared_ptr<endpoint::Core>& core() const { return core_; }
  /// Keeps this.
  virtual std::shared_ptr<Waits> share() = 0;

 private:
  class Waiting;
  void forget(const Waiting& waiting);
  [[nodiscard]] Error error_for(ErrorCode code, std::string text) const;

  const std::shared_ptr<endpoint::Core> core_;
  Mutex waiting_mutex_;
  Condition waiting_changed_;
  std::uint64_t changes_ RR_GUARDED_BY(waiting_mutex_) = 0;
  std::vector<std::shared_ptr<Waiting>> waiting_ RR_GUARDED_BY(waiting_mutex_);
};

}  // namespace rr::subscription
