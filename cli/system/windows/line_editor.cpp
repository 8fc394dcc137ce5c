// SPDX-License-Identifier: Apache-2.0
// Editing and history are the console's own; there is no completion. Its letters are read as
// UTF-16: as bytes it gives those of one code page.
#include "cli/live/line_editor.hpp"

#include <windows.h>

#include <array>
#include <filesystem>
#include <iostream>

namespace robdef::live {
namespace {

class Console final : public LineReader {
 public:
  std::optional<std::string> read(const std::string& prompt) override {
    std::cout << prompt << std::flush;
    std::wstring line;
    std::array<wchar_t, 512> piece{};
    const HANDLE input = GetStdHandle(STD_INPUT_HANDLE);
    while (!line.ends_with(L'\n')) {
      DWORD size = 0;
      if (!ReadConsoleW(input, piece.data(), static_cast<DWORD>(piece.size()), &size, nullptr) ||
          size == 0) {
        return std::nullopt;
      }
      line.append(piece.data(), size);
    }
    constexpr wchar_t end_of_input = 26;  // Ctrl-Z, at the beginning of a line
    if (line.front() == end_of_input) return std::nullopt;
    while (line.ends_with(L'\n') || line.ends_with(L'\r')) line.pop_back();
    return std::filesystem::path(line).string();
  }
  [[nodiscard]] bool is_terminal() const override { return true; }
};

}  // namespace

std::unique_ptr<LineReader> make_line_editor(Completer /*completer*/) {
  return std::make_unique<Console>();
}

}  // namespace robdef::live
