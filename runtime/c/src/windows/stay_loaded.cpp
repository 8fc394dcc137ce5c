// SPDX-License-Identifier: Apache-2.0
// Threads of nodes may be in the code of the library when a program frees it: it stays loaded.
#include <windows.h>

namespace {

const bool is_kept = [] {
  static const char own = 0;
  HMODULE module = nullptr;
  return GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_PIN | GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS,
                            reinterpret_cast<const wchar_t*>(&own), &module) != FALSE;
}();

}  // namespace
