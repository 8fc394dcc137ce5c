// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <ostream>
#include <string>
#include <string_view>

/// A program that reads a text and prints one.
namespace robdef::plugin {

struct Limits {
  std::size_t output = 0;  ///< bytes that it may print
  /// How long it may take without reading or printing anything.
  std::chrono::milliseconds silence{std::chrono::minutes(5)};
  /// How long its output is read after its end, when another process keeps that open.
  std::chrono::milliseconds after_end{1000};
};

struct Printed {
  std::string text;
  std::size_t read = 0;  ///< bytes of the input that it took
};

/// Runs a program without arguments, gives it `input`, and reads what it prints at the same time,
/// so that neither waits for the other. Its standard error goes to `err`, made printable. Throws
/// PluginError when it cannot be started, fails, is killed, or goes beyond the limits; it is ended
/// then. The message does not name the program.
Printed run_program(const std::string& program, std::string_view input, const Limits& limits,
                    std::ostream& err);

}  // namespace robdef::plugin
