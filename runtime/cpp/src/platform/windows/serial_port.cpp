// SPDX-License-Identifier: Apache-2.0
// A read of one byte is always under way while a port is open: it ends when something comes, and
// can be waited for together with wake(). What came with it is then in the driver's queue, and
// taken at once.
#include "runtime/cpp/src/platform/serial_port.hpp"

#include <windows.h>

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "errors.hpp"
#include "rr/error.hpp"
#include "runtime/cpp/src/platform/sockets.hpp"

namespace rr::platform {
namespace {

/// For the driver: at the quickest rate what comes within 40 ms.
constexpr DWORD queue_size = 4096;
/// What a port does not take for so long is lost.
constexpr DWORD send_patience = 1000;

std::string reason(DWORD error) {
  switch (error) {
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
    case ERROR_BUSY:
      return "is in use, by another program or another part of this one";
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
      return "does not exist";
    case ERROR_INVALID_FUNCTION:
    case ERROR_INVALID_HANDLE:
    case ERROR_INVALID_PARAMETER:
    case ERROR_NOT_SUPPORTED:
      return "is no serial port";
    default:
      return "cannot be opened: " + system_error(error).message();
  }
}

bool is_letter(char one) { return (one >= 'A' && one <= 'Z') || (one >= 'a' && one <= 'z'); }
bool is_digit(char one) { return one >= '0' && one <= '9'; }

// False with the reason in GetLastError().
bool set_up(HANDLE port, std::uint32_t baud) {
  DCB settings{};
  settings.DCBlength = sizeof settings;
  if (GetCommState(port, &settings) == FALSE) return false;
  settings = {};
  settings.DCBlength = sizeof settings;
  settings.BaudRate = baud;
  settings.ByteSize = 8;
  settings.Parity = NOPARITY;
  settings.StopBits = ONESTOPBIT;
  settings.fBinary = TRUE;
  // As on Linux: most boards begin anew when somebody opens their port.
  settings.fDtrControl = DTR_CONTROL_ENABLE;
  settings.fRtsControl = RTS_CONTROL_ENABLE;
  settings.XonChar = 0x11;
  settings.XoffChar = 0x13;
  // Without time-outs: a read ends with its byte.
  COMMTIMEOUTS none{};
  (void)SetupComm(port, queue_size, queue_size);
  return SetCommState(port, &settings) != FALSE && SetCommTimeouts(port, &none) != FALSE &&
         PurgeComm(port, PURGE_RXCLEAR | PURGE_TXCLEAR) != FALSE;
}

/// An event that is given to a call which may last.
class Event {
 public:
  explicit Event(bool is_manual) : handle_(CreateEventW(nullptr, is_manual, FALSE, nullptr)) {
    if (handle_ == nullptr) throw Error(ErrorCode::system_resource_error, "no event is free");
  }
  ~Event() { CloseHandle(handle_); }
  Event(const Event&) = delete;
  Event& operator=(const Event&) = delete;

  [[nodiscard]] HANDLE get() const { return handle_; }

 private:
  const HANDLE handle_;
};

OVERLAPPED with_event(const Event& event) {
  OVERLAPPED call{};
  call.hEvent = event.get();
  return call;
}

}  // namespace

// Letters and digits, as `COM3` and `CNCA0` of com0com: another device has to be none by accident.
std::optional<std::string> serial_port_name(const std::string& path) {
  std::string name = path;
  std::replace(name.begin(), name.end(), '\\', '/');
  if (name.starts_with("//./")) {
    name.erase(0, 4);
  } else if (name.starts_with('/')) {
    name.erase(0, 1);
  }
  const auto fits = [](char one) { return is_letter(one) || is_digit(one) || one == '_'; };
  if (name.empty() || !is_letter(name.front()) || !std::all_of(name.begin(), name.end(), fits)) {
    return std::nullopt;
  }
  for (char& one : name) {
    if (one >= 'a' && one <= 'z') one = static_cast<char>(one - 'a' + 'A');
  }
  return name;
}

const char* serial_port_example() { return "COM3"; }

struct SerialPort::System {
  // True, or false with the port broken.
  bool begin_read() {
    reading = with_event(has_come);
    is_reading =
        ReadFile(port, &first, 1, nullptr, &reading) != FALSE || GetLastError() == ERROR_IO_PENDING;
    return is_reading;
  }
  // The call is over, whatever became of it: the system no longer writes there.
  void end(OVERLAPPED& call) const {
    DWORD size = 0;
    CancelIoEx(port, &call);
    GetOverlappedResult(port, &call, &size, TRUE);
  }

  const Event woken{false};
  const Event has_come{true};
  const Event has_left{true};
  HANDLE port = INVALID_HANDLE_VALUE;
  OVERLAPPED reading{};
  bool is_reading = false;
  std::byte first{};
};

SerialPort::SerialPort() : system_(new System) {}

SerialPort::~SerialPort() { close(); }

bool SerialPort::is_open() const { return system_->port != INVALID_HANDLE_VALUE; }

std::string SerialPort::open(const std::string& name, std::uint32_t baud) {
  close();
  system_->port = CreateFileW(wide("\\\\.\\" + name).c_str(), GENERIC_READ | GENERIC_WRITE, 0,
                              nullptr, OPEN_EXISTING, FILE_FLAG_OVERLAPPED, nullptr);
  if (!is_open()) return reason(GetLastError());
  if (set_up(system_->port, baud) && system_->begin_read()) return {};
  const DWORD error = GetLastError();
  close();
  return reason(error);
}

void SerialPort::close() {
  if (!is_open()) return;
  if (system_->is_reading) system_->end(system_->reading);
  system_->is_reading = false;
  CloseHandle(system_->port);
  system_->port = INVALID_HANDLE_VALUE;
}

std::ptrdiff_t SerialPort::receive(std::span<std::byte> room, Time deadline) {
  const HANDLE waits[] = {system_->woken.get(), system_->has_come.get()};
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  const auto limit = static_cast<DWORD>(std::clamp<std::int64_t>(left.count(), 0, 1'000'000'000));
  const DWORD found = WaitForMultipleObjects(is_open() ? 2 : 1, waits, FALSE, limit);
  if (!is_open() || found != WAIT_OBJECT_0 + 1 || room.empty()) return nothing_now;
  DWORD size = 0;
  system_->is_reading = false;
  if (GetOverlappedResult(system_->port, &system_->reading, &size, FALSE) == FALSE) return broken;
  std::size_t have = 0;
  if (size == 1) room[have++] = system_->first;
  // No more than are there, so that the read does not wait.
  DWORD faults = 0;
  COMSTAT state{};
  if (ClearCommError(system_->port, &faults, &state) == FALSE) return broken;
  const auto more = static_cast<DWORD>(std::min<std::size_t>(state.cbInQue, room.size() - have));
  if (more != 0) {
    OVERLAPPED rest = with_event(system_->has_come);
    const BOOL is_done = ReadFile(system_->port, &room[have], more, nullptr, &rest);
    if (is_done == FALSE && GetLastError() != ERROR_IO_PENDING) return broken;
    if (GetOverlappedResult(system_->port, &rest, &size, TRUE) == FALSE) return broken;
    have += size;
  }
  if (!system_->begin_read()) return broken;
  return have == 0 ? nothing_now : static_cast<std::ptrdiff_t>(have);
}

bool SerialPort::send(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    OVERLAPPED call = with_event(system_->has_left);
    const auto size = static_cast<DWORD>(std::min<std::size_t>(bytes.size(), queue_size));
    if (WriteFile(system_->port, bytes.data(), size, nullptr, &call) == FALSE) {
      if (GetLastError() != ERROR_IO_PENDING) return false;
      if (WaitForSingleObject(call.hEvent, send_patience) != WAIT_OBJECT_0) {
        system_->end(call);
        return true;
      }
    }
    DWORD sent = 0;
    if (GetOverlappedResult(system_->port, &call, &sent, TRUE) == FALSE || sent == 0) return false;
    bytes = bytes.subspan(sent);
  }
  return true;
}

void SerialPort::wake() const { SetEvent(system_->woken.get()); }

}  // namespace rr::platform
