// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/random.hpp"

#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace rr::platform {

void fill_random(std::span<std::byte> bytes) {
  if (::getentropy(bytes.data(), bytes.size()) != 0) {
    throw std::system_error(errno, std::generic_category(), "random bytes");
  }
}

}  // namespace rr::platform
