// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "runtime/arduino/bench/simulated_board.hpp"

/// For tests: a simulated board at a port of this machine, a pseudo terminal, in the machine's time
/// or slower.
namespace rr::serial::testing {

class PluggedBoard {
 public:
  /// Throws std::runtime_error when there is no such program or no terminal.
  explicit PluggedBoard(const std::string& elf, std::uint32_t baud = 115200);
  ~PluggedBoard();
  PluggedBoard(const PluggedBoard&) = delete;
  PluggedBoard& operator=(const PluggedBoard&) = delete;

  /// Of the port: a link, as those below /dev/serial, to the terminal that there is at the time.
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Pulls the cable: the port is gone, and so is the board's power.
  void unplug();
  /// The port comes back, and the program begins.
  void plug();
  /// The same with another program.
  void plug(const std::string& elf);

  void reset() { resets_ = true; }
  /// A cable that carries nothing.
  void set_silent(bool is_silent) { is_silent_ = is_silent; }
  void set_voltage(double volts);
  std::uint8_t peek(std::uint16_t address);

 private:
  struct Terminal;

  void run();
  void exchange();

  const std::uint32_t baud_;
  std::string folder_;
  std::string path_;
  std::mutex mutex_;
  std::unique_ptr<SimulatedBoard> board_;
  std::unique_ptr<Terminal> terminal_;  // null: unplugged
  std::atomic<bool> stops_ = false;
  std::atomic<bool> resets_ = false;
  std::atomic<bool> is_silent_ = false;
  std::thread thread_;
};

}  // namespace rr::serial::testing
