// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <system_error>

namespace rr::platform {

/// An error of Windows or Winsock, comparable with std::errc.
std::error_code system_error(unsigned long number);
/// That of the calling thread's last call.
std::error_code last_system_error();
std::error_code last_socket_error();

/// UTF-8, as all texts of the runtime, to what the functions of Windows take, and back.
std::wstring wide(const std::string& text);
std::string narrow(const wchar_t* text);

}  // namespace rr::platform
