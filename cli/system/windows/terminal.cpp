// SPDX-License-Identifier: Apache-2.0
#include "cli/system/terminal.hpp"

#include <windows.h>
// After it:
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <shellapi.h>
#include <sys/stat.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <random>

namespace robdef::system {
namespace {

namespace fs = std::filesystem;

HANDLE open_console(const wchar_t* name) {
  return CreateFileW(name, GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE,
                     nullptr, OPEN_EXISTING, 0, nullptr);
}

bool is_console(DWORD stream) {
  DWORD mode = 0;
  return GetConsoleMode(GetStdHandle(stream), &mode) != FALSE;
}

class SilentConsole {
 public:
  SilentConsole() : in_(open_console(L"CONIN$")), out_(open_console(L"CONOUT$")) {
    is_there_ = out_ != INVALID_HANDLE_VALUE && GetConsoleMode(in_, &before_) != FALSE &&
                SetConsoleMode(in_, ENABLE_LINE_INPUT | ENABLE_PROCESSED_INPUT) != FALSE;
  }
  ~SilentConsole() {
    if (is_there_) SetConsoleMode(in_, before_);
    if (in_ != INVALID_HANDLE_VALUE) CloseHandle(in_);
    if (out_ != INVALID_HANDLE_VALUE) CloseHandle(out_);
  }
  SilentConsole(const SilentConsole&) = delete;
  SilentConsole& operator=(const SilentConsole&) = delete;

  [[nodiscard]] bool is_there() const { return is_there_; }
  void print(const std::string& text) const {
    const std::wstring wide = fs::path(text).wstring();
    DWORD written = 0;
    WriteConsoleW(out_, wide.data(), static_cast<DWORD>(wide.size()), &written, nullptr);
  }
  [[nodiscard]] std::string read_line() const {
    std::wstring line;
    std::array<wchar_t, 256> piece{};
    DWORD size = 0;
    while (ReadConsoleW(in_, piece.data(), static_cast<DWORD>(piece.size()), &size, nullptr) &&
           size != 0) {
      line.append(piece.data(), size);
      if (line.ends_with(L'\n')) break;
    }
    while (line.ends_with(L'\n') || line.ends_with(L'\r')) line.pop_back();
    return fs::path(line).string();
  }

 private:
  HANDLE in_;
  HANDLE out_;
  DWORD before_ = 0;
  bool is_there_ = false;
};

}  // namespace

bool writes_to_terminal() { return is_console(STD_OUTPUT_HANDLE); }
bool reads_from_terminal() { return is_console(STD_INPUT_HANDLE); }

std::optional<std::string> ask_silently(const std::string& question) {
  const SilentConsole console;
  if (!console.is_there()) return std::nullopt;
  console.print(question + ": ");
  std::string answer = console.read_line();
  console.print("\r\n");
  return answer;
}

// Descriptors of the C library are handed on, too.
std::optional<std::string> line_from_descriptor(int descriptor) {
  std::string line;
  for (char letter = 0;;) {
    const int size = _read(descriptor, &letter, 1);
    if (size < 0) return std::nullopt;
    if (size == 0 || letter == '\n') return line;
    line += letter;
  }
}

void open_in_browser(const std::string& address) {
  ShellExecuteW(nullptr, L"open", fs::path(address).wstring().c_str(), nullptr, nullptr,
                SW_SHOWNORMAL);
}

// Its folder is the user's.
std::string make_temporary_file() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  if (error) return "";
  std::random_device random;
  for (int attempt = 0; attempt < 16; ++attempt) {
    const fs::path path = folder / ("robdef-" + std::to_string(random()));
    const int file =
        _wopen(path.c_str(), _O_CREAT | _O_EXCL | _O_RDWR | _O_BINARY, _S_IREAD | _S_IWRITE);
    if (file < 0) continue;
    _close(file);
    return path.string();
  }
  return "";
}

}  // namespace robdef::system
