// SPDX-License-Identifier: Apache-2.0
#include "compiler/plugin/program.hpp"

#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "compiler/diagnostics/excerpt.hpp"
#include "compiler/plugin/plugin.hpp"
#include "compiler/system/piped_program.hpp"

namespace robdef::plugin {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t longest_line = 4096;
constexpr std::size_t most_lines = 10'000;
// How often to look for its end: while its output would tell, and after that.
constexpr std::chrono::milliseconds look_each(50);
constexpr std::chrono::milliseconds look_soon(2);

[[noreturn]] void give_up(const std::string& what) { throw PluginError(what); }

/// What a program says to people, line by line.
class Lines {
 public:
  explicit Lines(std::ostream& err) : err_(err) {}

  void take(std::string_view text) {
    for (const char c : text) {
      if (c == '\n') {
        end_line();
      } else if (line_.size() < longest_line) {
        line_ += c;
      }
    }
  }
  void end() {
    if (!line_.empty()) end_line();
  }

 private:
  void end_line() {
    if (line_.ends_with('\r')) line_.pop_back();  // as programs for Windows end a line
    if (count_++ < most_lines) {
      err_ << printable(std::exchange(line_, {})) << '\n' << std::flush;
    } else {
      line_.clear();
      if (count_ == most_lines + 1) err_ << "robdef: further lines are left out\n" << std::flush;
    }
  }

  std::ostream& err_;
  std::string line_;
  std::size_t count_ = 0;
};

/// Moves bytes in three directions until there is nothing left to move.
class Conversation {
 public:
  Conversation(system::PipedProgram& program, std::string_view input, const Limits& limits,
               std::ostream& err)
      : program_(program), input_(input), limits_(limits), lines_(err) {}

  Printed run() {
    Clock::time_point moved = Clock::now();
    while (program_.says_something() || !program_.has_ended()) {
      if (move_some()) moved = Clock::now();
      const auto silence = Clock::now() - moved;
      const bool has_ended = program_.has_ended();
      if (silence <= (has_ended ? limits_.after_end : limits_.silence)) continue;
      if (has_ended) break;
      give_up("did nothing for " +
              std::to_string(std::chrono::ceil<std::chrono::seconds>(limits_.silence).count()) +
              " s, and was ended");
    }
    lines_.end();
    return std::move(printed_);
  }

 private:
  bool move_some() {
    const system::PipedProgram::Moved moved =
        program_.move(input_, program_.says_something() ? look_each : look_soon);
    printed_.read += moved.written;
    input_.remove_prefix(moved.written);
    if (moved.out.size() > limits_.output - printed_.text.size()) {
      give_up("printed more than " + std::to_string(limits_.output) + " bytes, and was ended");
    }
    printed_.text += moved.out;
    lines_.take(moved.err);
    return moved.written != 0 || !moved.out.empty() || !moved.err.empty();
  }

  system::PipedProgram& program_;
  std::string_view input_;
  const Limits& limits_;
  Lines lines_;
  Printed printed_;
};

}  // namespace

Printed run_program(const std::string& program, std::string_view input, const Limits& limits,
                    std::ostream& err) {
  std::optional<system::PipedProgram> running;
  try {
    running.emplace(std::vector<std::string>{program});
  } catch (const std::system_error& error) {
    give_up("cannot be started: " + error.code().message());
  }
  Printed printed = Conversation(*running, input, limits, err).run();
  if (const std::string failure = running->failure(); !failure.empty()) give_up(failure);
  return printed;
}

}  // namespace robdef::plugin
