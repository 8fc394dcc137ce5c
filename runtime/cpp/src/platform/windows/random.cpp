// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/random.hpp"

#include <windows.h>
// After it, whose types it takes.
#include <bcrypt.h>

#include <system_error>

namespace rr::platform {

void fill_random(std::span<std::byte> bytes) {
  if (bytes.empty()) return;  // which has no address
  const NTSTATUS status =
      BCryptGenRandom(nullptr, reinterpret_cast<PUCHAR>(bytes.data()),
                      static_cast<ULONG>(bytes.size()), BCRYPT_USE_SYSTEM_PREFERRED_RNG);
  if (status != 0) throw std::system_error(status, std::system_category(), "random bytes");
}

}  // namespace rr::platform
