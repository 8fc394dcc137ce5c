// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/interruption.hpp"

#include <string>
#include <utility>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

thread_local const Interruption* current_interruption = nullptr;

}  // namespace

Interruption::Interruption(std::error_code error) : bell_(error) {
  if (error) {
    throw Error(ErrorCode::system_resource_error, "an interruption: " + error.message());
  }
}

void Interruption::interrupt() {
  if (!is_interrupted_.exchange(true)) bell_.ring();
}

Interruption::Scope::Scope(const Interruption& interruption)
    : outer_(std::exchange(current_interruption, &interruption)) {}

Interruption::Scope::~Scope() { current_interruption = outer_; }

const Interruption* Interruption::current() { return current_interruption; }

}  // namespace rr::channel
