// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/stress/roles.hpp"

namespace rr::stress {

using testing::Child;

/// Starts the other processes, kills and stops some of those with clients, and says at the end
/// whether all was well.
class Director {
 public:
  explicit Director(const Options& options);
  /// The result of the program.
  int run();

 private:
  using Clock = std::chrono::steady_clock;
  using Census = std::map<std::string, std::size_t>;

  struct Process {
    std::string name;
    std::unique_ptr<Child> child{};
    std::uint32_t first = 0;
    std::uint32_t count = 0;
    bool is_mortal = false;
    Clock::time_point next_event{};
    std::optional<Census> census{};       ///< the newest
    std::optional<Census> warm_census{};  ///< at the end of the warm-up
    std::string census_text{};
    bool is_paused = false;
    std::uint16_t port = 0;
    Census done{};  ///< of this process
  };

  void start(Process& process);
  void read(Process& process);
  void read_all();
  void look_after(Process& process);
  void run_for(Clock::duration time);
  void pause();
  void wait_until_quiet();
  void compare(const Process& process);
  void end(Process& process);
  void fault(const std::string& what);
  [[nodiscard]] std::size_t total(const std::string& what) const;
  std::size_t ask_census(Process& process);
  [[nodiscard]] Clock::time_point next_event();

  const Options options_;
  std::minstd_rand random_;
  Process service_;
  std::vector<Process> users_;
  std::size_t faults_ = 0;
  std::size_t killed_ = 0;
  std::size_t stopped_ = 0;
};

}  // namespace rr::stress
