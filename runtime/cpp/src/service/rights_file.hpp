// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "rr/mutex.hpp"
#include "rr/rights.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/endpoint/core.hpp"

namespace rr::service {

/// The file with the rights of a service, which is looked at every second.
class RightsFile final : public channel::Timer, public std::enable_shared_from_this<RightsFile> {
 public:
  using Changed = std::function<void(std::shared_ptr<const Rights>)>;

  RightsFile(std::shared_ptr<endpoint::Core> core, std::string path);
  ~RightsFile();
  /// Throws rr::Error (invalid_configuration).
  std::shared_ptr<const Rights> read();
  /// `changed` is called with what is new, on a thread of the node.
  void watch(Changed changed);

 private:
  // What tells one state of the file from another.
  struct State {
    std::int64_t written = 0;  // nanoseconds
    std::int64_t size = -1;    // there is none
    std::uint64_t file = 0;
    bool operator==(const State&) const = default;
  };
  [[nodiscard]] State state() const;
  void on_timer() override;
  void look();
  void schedule();

  const std::shared_ptr<endpoint::Core> core_;
  const std::string path_;
  Changed changed_;  // set by watch(), before anything is looked at
  Mutex mutex_;
  State seen_ RR_GUARDED_BY(mutex_);
};

}  // namespace rr::service
