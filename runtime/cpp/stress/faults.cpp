// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/stress/faults.hpp"

#include <unistd.h>

#include <cstddef>

namespace rr::stress {

void Lines::write(const std::string& line) {
  const std::string text = line + '\n';
  const std::lock_guard lock(mutex_);
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t now = ::write(STDOUT_FILENO, text.data() + done, text.size() - done);
    if (now <= 0) return;
    done += static_cast<std::size_t>(now);
  }
}

}  // namespace rr::stress
