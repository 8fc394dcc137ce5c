// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/handler_memory.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/time.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {
namespace {

// What finds no room is tried again: the answers of others are sent within milliseconds.
constexpr channel::Milliseconds period{2};

}  // namespace

HandlerMemory::HandlerMemory(ServerEndpoint& endpoint, const Question& question,
                             std::size_t expected)
    : endpoint_(endpoint), may_wait_(!question.batch) {
  if (expected != 0) grow_to(expected);
  watched_.emplace(static_cast<codec::LargeAllocations*>(this));
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
  if (room_.add(more)) return;
  if (may_wait_) channel::Reactor::about_to_wait();
  const channel::Time until = channel::Clock::now() + endpoint_.core()->options().budget.patience;
  while (!room_.add(more)) {
    if (!may_wait_ || channel::Clock::now() >= until || endpoint_.connection().is_closed()) {
      throw Error(ErrorCode::out_of_system_resource, "there is no room for what is to be answered");
    }
    std::this_thread::sleep_for(period);
  }
}

}  // namespace rr::service
