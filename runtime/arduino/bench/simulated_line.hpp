// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/arduino/bench/bad_line.hpp"
#include "runtime/arduino/bench/simulated_board.hpp"
#include "runtime/cpp/src/serial/frames.hpp"
#include "runtime/cpp/src/serial/host_link.hpp"

/// For tests: a host and a simulated board on one line, in the board's time: repeatable to the
/// cycle.
namespace rr::serial::testing {

/// Finds the frames that a line has damaged and whose CRC is right nevertheless: one of 65,536 of
/// those that only the CRC can find, which no end of the line can know of.
class ForgeryWatch {
 public:
  /// What one end has sent, and what the other one receives of it.
  void take(const std::vector<std::uint8_t>& sent, const std::vector<std::uint8_t>& received);
  [[nodiscard]] unsigned count() const { return count_; }

 private:
  FrameFinder sent_finder_;
  FrameFinder received_finder_;
  std::deque<Frame> sent_;  // lately
  unsigned count_ = 0;
};

class SimulatedLine {
 public:
  SimulatedLine(const std::string& elf, std::uint32_t baud, const BadLine::Rates& rates = {},
                unsigned seed = 1);

  /// A session with the board, within a second.
  Outcome hello();
  /// Whatever a request is answered with; `patience` in the board's time.
  Outcome ask(Kind kind, std::vector<std::uint8_t> body,
              Time patience = std::chrono::milliseconds(2000));
  /// Lets time pass.
  void run(Time time);
  /// Text `number`, whole.
  std::string text(std::uint8_t number);

  void end_noise();
  /// Damaged frames with a right CRC, both ways.
  [[nodiscard]] unsigned forgeries() const { return there_watch_.count() + back_watch_.count(); }
  /// Called after each step of time; for what happens meanwhile.
  std::function<void()> meanwhile{};

  SimulatedBoard board;
  HostLink host;
  std::vector<Unasked> unasked{};
  std::uint64_t bytes = 0;  ///< on the line, both ways

 private:
  void step(Time until);
  Outcome wait();

  BadLine there_;
  BadLine back_;
  ForgeryWatch there_watch_;
  ForgeryWatch back_watch_;
  std::uint16_t session_ = 0;
};

std::vector<std::uint8_t> bytes_of_double(double value);
double double_in(const std::vector<std::uint8_t>& bytes, std::size_t at);

}  // namespace rr::serial::testing
