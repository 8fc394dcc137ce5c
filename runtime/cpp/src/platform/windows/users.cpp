// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/users.hpp"

#include <windows.h>
#include <winsock2.h>
// After it:
#include <aclapi.h>
#include <lmcons.h>
#include <sddl.h>

#include <algorithm>
#include <array>
#include <vector>

#include "errors.hpp"
#include "rr/mutex.hpp"
#include "runtime/cpp/src/platform/environment.hpp"
#include "sids.hpp"

namespace rr::platform {
namespace {

// What a token says of its user, or an account's identifier, takes.
using SidBytes = std::array<std::byte, 256>;

}  // namespace

UserId number_of(PSID user) {
  if (IsWellKnownSid(user, WinLocalSystemSid) ||
      IsWellKnownSid(user, WinBuiltinAdministratorsSid)) {
    return system_user;
  }
  LPSTR text = nullptr;
  if (!ConvertSidToStringSidA(user, &text)) return ~UserId{0};
  const std::string name = text;
  LocalFree(text);
  static Mutex mutex;
  static std::vector<std::string> names RR_GUARDED_BY(mutex);
  const MutexLock lock(mutex);
  const auto found = std::find(names.begin(), names.end(), name);
  const auto number = static_cast<UserId>(found - names.begin());
  if (found == names.end()) names.push_back(name);
  return number + 1;
}

std::optional<UserId> user_of_process(HANDLE process) {
  HANDLE token = nullptr;
  if (!OpenProcessToken(process, TOKEN_QUERY, &token)) return std::nullopt;
  alignas(TOKEN_USER) SidBytes bytes{};
  DWORD size = 0;
  const BOOL is_known =
      GetTokenInformation(token, TokenUser, bytes.data(), static_cast<DWORD>(bytes.size()), &size);
  CloseHandle(token);
  if (!is_known) return std::nullopt;
  return number_of(reinterpret_cast<TOKEN_USER*>(bytes.data())->User.Sid);
}

UserId current_user() {
  static const UserId user = user_of_process(GetCurrentProcess()).value_or(~UserId{0});
  return user;
}

Account current_account() {
  std::array<wchar_t, UNLEN + 1> name{};
  DWORD size = static_cast<DWORD>(name.size());
  if (!GetUserNameW(name.data(), &size)) name.front() = L'\0';
  return {narrow(name.data()), environment("USERPROFILE")};
}

std::optional<UserId> user_of(const std::string& name) {
  SidBytes sid{};
  DWORD sid_size = static_cast<DWORD>(sid.size());
  std::array<wchar_t, 256> domain{};
  DWORD domain_size = static_cast<DWORD>(domain.size());
  SID_NAME_USE use{};
  if (!LookupAccountNameW(nullptr, wide(name).c_str(), sid.data(), &sid_size, domain.data(),
                          &domain_size, &use)) {
    return std::nullopt;
  }
  return number_of(sid.data());
}

std::optional<UserId> owner_of(const std::string& path) {
  PSID owner = nullptr;
  PSECURITY_DESCRIPTOR descriptor = nullptr;
  if (GetNamedSecurityInfoW(wide(path).data(), SE_FILE_OBJECT, OWNER_SECURITY_INFORMATION, &owner,
                            nullptr, nullptr, nullptr, &descriptor) != ERROR_SUCCESS) {
    return std::nullopt;
  }
  const UserId user = number_of(owner);
  LocalFree(descriptor);
  return user;
}

std::uint64_t process_id() { return GetCurrentProcessId(); }

std::string machine_name() {
  std::array<wchar_t, MAX_COMPUTERNAME_LENGTH + 1> name{};
  DWORD size = static_cast<DWORD>(name.size());
  return GetComputerNameW(name.data(), &size) ? narrow(name.data()) : std::string();
}

}  // namespace rr::platform
