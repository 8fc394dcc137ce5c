// SPDX-License-Identifier: Apache-2.0
#include "cli/live/line_reader.hpp"

#include <iostream>
#include <utility>

#include "cli/live/line_editor.hpp"
#include "cli/system/terminal.hpp"

namespace robdef::live {
namespace {

class PlainReader final : public LineReader {
 public:
  explicit PlainReader(bool is_terminal) : is_terminal_(is_terminal) {}
  std::optional<std::string> read(const std::string& prompt) override {
    if (is_terminal_) std::cout << prompt << std::flush;
    std::string line;
    if (!std::getline(std::cin, line)) return std::nullopt;
    return line;
  }
  [[nodiscard]] bool is_terminal() const override { return is_terminal_; }

 private:
  const bool is_terminal_;
};

}  // namespace

std::unique_ptr<LineReader> make_line_reader(Completer completer) {
  const bool is_terminal = system::reads_from_terminal() && system::writes_to_terminal();
  if (!is_terminal) return std::make_unique<PlainReader>(false);
  auto editor = make_line_editor(std::move(completer));
  return editor != nullptr ? std::move(editor) : std::make_unique<PlainReader>(true);
}

}  // namespace robdef::live
