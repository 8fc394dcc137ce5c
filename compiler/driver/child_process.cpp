// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/child_process.hpp"

#include <chrono>

#include "compiler/system/piped_program.hpp"

namespace robdef {
namespace {

constexpr std::size_t longest_errors = 4096;
// How often to look for its end: while its output would tell, and after that.
constexpr std::chrono::milliseconds look_each(50);
constexpr std::chrono::milliseconds look_soon(2);
// How long what it has started may keep its output open.
constexpr std::chrono::seconds after_end(1);

}  // namespace

ChildOutput run_child(const std::vector<std::string>& words, std::size_t limit) {
  using Clock = std::chrono::steady_clock;
  system::PipedProgram program(words);
  ChildOutput output;
  Clock::time_point moved = Clock::now();
  while (program.says_something() || !program.has_ended()) {
    const auto piece = program.move("", program.says_something() ? look_each : look_soon);
    output.out += piece.out;
    output.err += piece.err.substr(0, longest_errors - output.err.size());
    if (output.out.size() > limit) {
      output.is_cut = true;
      program.end();
      break;
    }
    if (!piece.out.empty() || !piece.err.empty()) moved = Clock::now();
    if (program.has_ended() && Clock::now() - moved > after_end) break;
  }
  output.status = program.status();
  return output;
}

}  // namespace robdef
