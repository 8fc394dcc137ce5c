// SPDX-License-Identifier: Apache-2.0
#include "errors.hpp"

#include <windows.h>
#include <winsock2.h>

#include <array>
#include <utility>

namespace rr::platform {
namespace {

// Those that something above the seam asks for.
constexpr std::array<std::pair<int, std::errc>, 19> known = {{
    {WSAEWOULDBLOCK, std::errc::operation_would_block},
    {WSAEADDRINUSE, std::errc::address_in_use},
    // Another socket has the port for itself.
    {WSAEACCES, std::errc::address_in_use},
    {WSAEADDRNOTAVAIL, std::errc::address_not_available},
    {WSAEAFNOSUPPORT, std::errc::address_family_not_supported},
    {WSAECONNREFUSED, std::errc::connection_refused},
    {WSAECONNRESET, std::errc::connection_reset},
    {WSAETIMEDOUT, std::errc::timed_out},
    {WSAEMFILE, std::errc::too_many_files_open},
    {WSAENOBUFS, std::errc::no_buffer_space},
    {WSAENETUNREACH, std::errc::network_unreachable},
    {WSAEHOSTUNREACH, std::errc::host_unreachable},
    {ERROR_FILE_NOT_FOUND, std::errc::no_such_file_or_directory},
    {ERROR_PATH_NOT_FOUND, std::errc::no_such_file_or_directory},
    {ERROR_ACCESS_DENIED, std::errc::permission_denied},
    {ERROR_FILE_EXISTS, std::errc::file_exists},
    {ERROR_ALREADY_EXISTS, std::errc::file_exists},
    {ERROR_LOCK_VIOLATION, std::errc::resource_unavailable_try_again},
    {ERROR_NOT_SUPPORTED, std::errc::not_supported},
}};

class WindowsCategory final : public std::error_category {
 public:
  [[nodiscard]] const char* name() const noexcept override { return "windows"; }

  [[nodiscard]] std::string message(int number) const override {
    std::array<wchar_t, 512> text{};
    const DWORD size = FormatMessageW(FORMAT_MESSAGE_FROM_SYSTEM | FORMAT_MESSAGE_IGNORE_INSERTS,
                                      nullptr, static_cast<DWORD>(number), 0, text.data(),
                                      static_cast<DWORD>(text.size()), nullptr);
    std::string message = size == 0 ? std::string() : narrow(text.data());
    while (!message.empty() && (message.back() == '\n' || message.back() == '\r' ||
                                message.back() == ' ' || message.back() == '.')) {
      message.pop_back();
    }
    return message.empty() ? "error " + std::to_string(number) + " of Windows" : message;
  }

  [[nodiscard]] std::error_condition default_error_condition(int number) const noexcept override {
    for (const auto& [own, general] : known) {
      if (own == number) return std::make_error_condition(general);
    }
    return {number, *this};
  }
};

}  // namespace

std::error_code system_error(unsigned long number) {
  static const WindowsCategory category;
  return {static_cast<int>(number), category};
}

std::error_code last_system_error() { return system_error(GetLastError()); }
std::error_code last_socket_error() {
  return system_error(static_cast<unsigned long>(WSAGetLastError()));
}

std::wstring wide(const std::string& text) {
  const int size = static_cast<int>(text.size());
  const int room = MultiByteToWideChar(CP_UTF8, 0, text.data(), size, nullptr, 0);
  std::wstring result(static_cast<std::size_t>(room), L'\0');
  MultiByteToWideChar(CP_UTF8, 0, text.data(), size, result.data(), room);
  return result;
}

std::string narrow(const wchar_t* text) {
  // Both count the final zero.
  const int room = WideCharToMultiByte(CP_UTF8, 0, text, -1, nullptr, 0, nullptr, nullptr);
  if (room <= 1) return {};
  std::string result(static_cast<std::size_t>(room), '\0');
  WideCharToMultiByte(CP_UTF8, 0, text, -1, result.data(), room, nullptr, nullptr);
  result.pop_back();
  return result;
}

}  // namespace rr::platform
