// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/interruption.hpp"

#include <sys/eventfd.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

thread_local const Interruption* current_interruption = nullptr;

}  // namespace

Interruption::Interruption() : event_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!event_) {
    throw Error(ErrorCode::system_resource_error, std::string("eventfd: ") + std::strerror(errno));
  }
}

void Interruption::interrupt() {
  if (!is_interrupted_.exchange(true)) eventfd_write(event_.get(), 1);
}

Interruption::Scope::Scope(const Interruption& interruption)
    : outer_(std::exchange(current_interruption, &interruption)) {}

Interruption::Scope::~Scope() { current_interruption = outer_; }

const Interruption* Interruption::current() { return current_interruption; }

}  // namespace rr::channel
