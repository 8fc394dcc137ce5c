// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/handler_memory.hpp"

#include <algorithm>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/service/room.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {

HandlerMemory::HandlerMemory(ServerEndpoint& endpoint, const Question& question,
                             std::size_t expected)
    : endpoint_(endpoint), expected_(expected), may_wait_(!question.batch) {
  watched_.emplace(static_cast<codec::LargeAllocations*>(this));
}

void HandlerMemory::expect() {
  if (expected_ != 0) grow_to(expected_);
}

channel::Charge HandlerMemory::end() {
  watched_.reset();
  return std::move(room_);
}

void HandlerMemory::before(std::size_t bytes) {
  grow_to(used_ + bytes);
  used_ += bytes;
}

void HandlerMemory::freed(std::size_t bytes) noexcept { used_ -= std::min(used_, bytes); }

void HandlerMemory::grow_to(std::size_t bytes) {
  const std::size_t wanted = std::min(bytes, endpoint_.core()->pools().sessions->limit() / 4);
  if (wanted <= room_.bytes()) return;
  if (room_.bytes() == 0) room_ = channel::Charge(endpoint_.connection().account());
  const std::size_t more = wanted - room_.bytes();
  const auto draw = [&] { return may_wait_ ? room_.add_making(more) : room_.add(more); };
  if (draw()) return;
  if (may_wait_ && wait_for_room(endpoint_, endpoint_.core()->options().budget.patience, draw)) {
    return;
  }
  throw Error(ErrorCode::out_of_system_resource, "there is no room for what is to be answered");
}

}  // namespace rr::service
