// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/pipe_cursor.hpp"

namespace rr::channel {

void PipeCursor::begin(std::uint64_t turn, std::uint64_t position) {
  const MutexLock lock(mutex_);
  if (words_) Steps::begin(*words_, turn, position);
}

void PipeCursor::advance(std::uint64_t position) {
  const MutexLock lock(mutex_);
  if (words_) Steps::advance(*words_, position);
}

bool PipeCursor::ask(const Steps::Words& ring, const Steps::Until& until, std::uint64_t position) {
  const MutexLock lock(mutex_);
  return !words_ || Steps::ask(ring, until, *words_, ++asked_, position);
}

void PipeCursor::detach() {
  const MutexLock lock(mutex_);
  words_.reset();
}

}  // namespace rr::channel
