// SPDX-License-Identifier: Apache-2.0
// Pipes without a name cannot be waited for together: these have names that no other program knows
// in time, since each is made for one client, which is opened at once.
#include "compiler/system/piped_program.hpp"

#include <windows.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <system_error>

namespace robdef::system {
namespace {

constexpr DWORD buffer_size = 65536;
using Buffer = std::array<char, buffer_size>;

// In the words of every system where there are such.
[[noreturn]] void fail(DWORD code) {
  const std::error_code own(static_cast<int>(code), std::system_category());
  const std::error_condition general = own.default_error_condition();
  if (general.category() != std::generic_category()) throw std::system_error(own);
  throw std::system_error(general.value(), general.category());
}

class Handle {
 public:
  Handle() = default;
  explicit Handle(HANDLE handle) : handle_(handle == INVALID_HANDLE_VALUE ? nullptr : handle) {}
  ~Handle() { close(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  void take(HANDLE handle) {
    close();
    handle_ = handle == INVALID_HANDLE_VALUE ? nullptr : handle;
  }
  void close() {
    if (handle_ != nullptr) CloseHandle(handle_);
    handle_ = nullptr;
  }
  [[nodiscard]] bool is_open() const { return handle_ != nullptr; }
  [[nodiscard]] HANDLE get() const { return handle_; }

 private:
  HANDLE handle_ = nullptr;
};

std::wstring pipe_name() {
  static std::atomic<unsigned> count = 0;
  return L"\\\\.\\pipe\\robdef-" + std::to_wstring(GetCurrentProcessId()) + L"-" +
         std::to_wstring(count++);
}

/// A pipe whose own end does not block, with one transfer at a time, and whose other end is for a
/// program.
class Pipe {
 public:
  explicit Pipe(bool is_written) {
    const std::wstring name = pipe_name();
    const DWORD direction = is_written ? PIPE_ACCESS_OUTBOUND : PIPE_ACCESS_INBOUND;
    own_.take(CreateNamedPipeW(name.c_str(),
                               direction | FILE_FLAG_OVERLAPPED | FILE_FLAG_FIRST_PIPE_INSTANCE,
                               PIPE_TYPE_BYTE | PIPE_WAIT | PIPE_REJECT_REMOTE_CLIENTS, 1,
                               buffer_size, buffer_size, 0, nullptr));
    if (!own_.is_open()) fail(GetLastError());
    SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
    other_.take(CreateFileW(name.c_str(), is_written ? GENERIC_READ : GENERIC_WRITE, 0, &inherited,
                            OPEN_EXISTING, 0, nullptr));
    if (!other_.is_open()) fail(GetLastError());
    event_.take(CreateEventW(nullptr, TRUE, FALSE, nullptr));
    if (!event_.is_open()) fail(GetLastError());
  }
  ~Pipe() { close(); }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close() {
    // The system writes into the buffer until a transfer has ended.
    if (is_moving_) {
      CancelIoEx(own_.get(), &transfer_);
      DWORD count = 0;
      GetOverlappedResult(own_.get(), &transfer_, &count, TRUE);
      is_moving_ = false;
    }
    own_.close();
  }
  void close_other() { other_.close(); }

  void begin_read() {
    if (is_moving_ || !own_.is_open()) return;
    begin();
    settle(ReadFile(own_.get(), buffer_.data(), buffer_size, nullptr, &transfer_));
  }
  void begin_write(std::string_view text) {
    if (is_moving_ || !own_.is_open()) return;
    const std::size_t size = std::min(text.size(), buffer_.size());
    std::copy_n(text.data(), size, buffer_.data());
    begin();
    settle(WriteFile(own_.get(), buffer_.data(), static_cast<DWORD>(size), nullptr, &transfer_));
  }
  /// The bytes of a transfer that has ended; 0: none has.
  std::size_t moved() {
    if (!is_moving_) return 0;
    DWORD count = 0;
    if (GetOverlappedResult(own_.get(), &transfer_, &count, FALSE)) {
      is_moving_ = false;
      return count;
    }
    if (GetLastError() == ERROR_IO_INCOMPLETE) return 0;
    is_moving_ = false;
    close();
    return 0;
  }

  [[nodiscard]] bool is_open() const { return own_.is_open(); }
  [[nodiscard]] bool is_moving() const { return is_moving_; }
  [[nodiscard]] HANDLE event() const { return event_.get(); }
  [[nodiscard]] HANDLE other() const { return other_.get(); }
  [[nodiscard]] const char* data() const { return buffer_.data(); }

 private:
  void begin() {
    transfer_ = {};
    transfer_.hEvent = event_.get();
    is_moving_ = true;
  }
  void settle(BOOL has_begun) {
    if (has_begun || GetLastError() == ERROR_IO_PENDING) return;
    is_moving_ = false;
    close();
  }

  Handle own_;
  Handle other_;
  Handle event_;
  OVERLAPPED transfer_{};
  bool is_moving_ = false;
  Buffer buffer_;
};

std::wstring wide(std::string_view text) {
  const int size = static_cast<int>(text.size());
  const int room = MultiByteToWideChar(CP_UTF8, 0, text.data(), size, nullptr, 0);
  std::wstring result(static_cast<std::size_t>(room), L'\0');
  MultiByteToWideChar(CP_UTF8, 0, text.data(), size, result.data(), room);
  return result;
}

// Along PATH. A name without a point gets `.exe`: others are not programs but for a shell.
std::wstring place_of(const std::wstring& program) {
  std::wstring place(32'768, L'\0');
  const DWORD size = SearchPathW(nullptr, program.c_str(), L".exe",
                                 static_cast<DWORD>(place.size()), place.data(), nullptr);
  if (size == 0) fail(GetLastError());
  place.resize(size);
  return place;
}

// Programs take their command line apart by these rules: backslashes count double where a quote
// follows.
std::wstring quoted(const std::wstring& word) {
  std::wstring result = L"\"";
  std::size_t backslashes = 0;
  for (const wchar_t letter : word) {
    if (letter == L'"') result.append(backslashes + 1, L'\\');
    backslashes = letter == L'\\' ? backslashes + 1 : 0;
    result += letter;
  }
  result.append(backslashes, L'\\');
  return result + L'"';
}

/// Of all handles that may be inherited the program gets these.
class Inherited {
 public:
  explicit Inherited(std::array<HANDLE, 3>& handles) {
    SIZE_T size = 0;
    InitializeProcThreadAttributeList(nullptr, 1, 0, &size);
    room_.resize(size);
    if (!InitializeProcThreadAttributeList(list(), 1, 0, &size)) fail(GetLastError());
    if (!UpdateProcThreadAttribute(list(), 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, handles.data(),
                                   sizeof handles, nullptr, nullptr)) {
      const DWORD why = GetLastError();
      DeleteProcThreadAttributeList(list());
      fail(why);
    }
  }
  ~Inherited() { DeleteProcThreadAttributeList(list()); }
  Inherited(const Inherited&) = delete;
  Inherited& operator=(const Inherited&) = delete;

  LPPROC_THREAD_ATTRIBUTE_LIST list() {
    return reinterpret_cast<LPPROC_THREAD_ATTRIBUTE_LIST>(room_.data());
  }

 private:
  std::vector<char> room_;
};

HANDLE start(const std::vector<std::string>& words, const Pipe& in, const Pipe& out,
             const Pipe& errors) {
  const std::wstring place = place_of(wide(words.at(0)));
  std::wstring line;
  for (const std::string& word : words) line += (line.empty() ? L"" : L" ") + quoted(wide(word));
  std::array<HANDLE, 3> handles{in.other(), out.other(), errors.other()};
  Inherited inherited(handles);
  STARTUPINFOEXW wanted{};
  wanted.StartupInfo.cb = sizeof wanted;
  wanted.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
  wanted.StartupInfo.hStdInput = in.other();
  wanted.StartupInfo.hStdOutput = out.other();
  wanted.StartupInfo.hStdError = errors.other();
  wanted.lpAttributeList = inherited.list();
  PROCESS_INFORMATION made{};
  if (!CreateProcessW(place.c_str(), line.data(), nullptr, nullptr, TRUE,
                      EXTENDED_STARTUPINFO_PRESENT, nullptr, nullptr, &wanted.StartupInfo, &made)) {
    fail(GetLastError());
  }
  CloseHandle(made.hThread);
  return made.hProcess;
}

}  // namespace

struct PipedProgram::State {
  explicit State(const std::vector<std::string>& words) : process(start(words, in, out, errors)) {
    in.close_other();
    out.close_other();
    errors.close_other();
  }

  // Until a transfer or, when there is none, the process ends.
  void wait(std::chrono::milliseconds most) const {
    std::array<HANDLE, 3> events{};
    DWORD count = 0;
    for (const Pipe* pipe : {&in, &out, &errors}) {
      if (pipe->is_moving()) events.at(count++) = pipe->event();
    }
    if (count == 0) events.at(count++) = process.get();
    WaitForMultipleObjects(count, events.data(), FALSE, static_cast<DWORD>(most.count()));
  }

  Pipe in{true};
  Pipe out{false};
  Pipe errors{false};
  const Handle process;
  bool has_ended = false;
};

PipedProgram::PipedProgram(const std::vector<std::string>& words)
    : state_(std::make_unique<State>(words)) {}

PipedProgram::~PipedProgram() {
  if (has_ended()) return;
  end();
  WaitForSingleObject(state_->process.get(), INFINITE);
}

PipedProgram::Moved PipedProgram::move(std::string_view input, std::chrono::milliseconds most) {
  State& state = *state_;
  if (input.empty()) {
    state.in.close();
  } else {
    state.in.begin_write(input);
  }
  state.out.begin_read();
  state.errors.begin_read();
  state.wait(most);
  Moved moved;
  moved.written = state.in.moved();
  moved.out = {state.out.data(), state.out.moved()};
  moved.err = {state.errors.data(), state.errors.moved()};
  return moved;
}

bool PipedProgram::says_something() const {
  return state_->out.is_open() || state_->errors.is_open();
}

bool PipedProgram::has_ended() {
  if (!state_->has_ended) {
    state_->has_ended = WaitForSingleObject(state_->process.get(), 0) == WAIT_OBJECT_0;
  }
  return state_->has_ended;
}

void PipedProgram::end() {
  if (!has_ended()) TerminateProcess(state_->process.get(), 1);
}

int PipedProgram::status() {
  WaitForSingleObject(state_->process.get(), INFINITE);
  state_->has_ended = true;
  DWORD code = 0;
  GetExitCodeProcess(state_->process.get(), &code);
  return static_cast<int>(code);
}

std::string PipedProgram::failure() {
  const auto code = static_cast<DWORD>(status());
  return code == 0 ? "" : "failed with exit status " + std::to_string(code);
}

}  // namespace robdef::system
