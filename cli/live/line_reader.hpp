// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace robdef::live {

/// What stands before the cursor may be continued with: whole last words.
using Completer = std::function<std::vector<std::string>(const std::string& before)>;

/// Where the lines of the prompt come from.
class LineReader {
 public:
  LineReader() = default;
  virtual ~LineReader() = default;
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;
  /// Without the line's end; nothing at the end of the input.
  virtual std::optional<std::string> read(const std::string& prompt) = 0;
  /// Whether somebody sits there.
  [[nodiscard]] virtual bool is_terminal() const = 0;
};

/// Reads standard input: at a terminal with editing, history and completion where libedit is
/// installed.
std::unique_ptr<LineReader> make_line_reader(Completer completer);

}  // namespace robdef::live
