// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/decoded_memory.hpp"

#include <utility>

#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/service/room.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {

DecodedMemory::DecodedMemory(ServerEndpoint& endpoint, const Question& question)
    : endpoint_(endpoint),
      request_bytes_(question.entry.elements.size() + quantum),
      may_wait_(!question.batch) {}

[[gnu::hot]] bool DecodedMemory::draw(std::size_t bytes) {
  if (bytes <= free_bytes && bytes_ <= free_bytes - bytes) {
    bytes_ += bytes;
    return true;
  }
  const std::size_t limit = endpoint_.container_limit();
  if (bytes_ > limit || bytes > limit - bytes_) return false;
  if (const std::size_t wanted = bytes_ + bytes; wanted > room_.bytes()) {
    if (!grow_to(wanted, may_wait_ && bytes >= large_text)) return false;
    if (room_.bytes() > many_bytes && !std::exchange(has_given_way_, true)) {
      channel::Reactor::give_way();
    }
    channel::Reactor::yield();
  }
  bytes_ += bytes;
  return true;
}

bool DecodedMemory::grow_to(std::size_t wanted, bool may_wait) {
  if (room_.bytes() == 0) room_ = channel::Charge(endpoint_.connection().account());
  const std::size_t needed = wanted - room_.bytes();
  const std::size_t rounded = (needed + quantum - 1) / quantum * quantum;
  if (wanted > request_bytes_) return room_.add(rounded) || room_.add(needed);
  const auto draw = [&] { return room_.add_reading(needed); };
  if (room_.add_reading(rounded) || draw()) return true;
  return may_wait && wait_for_room(endpoint_, endpoint_.core()->options().budget.patience, draw);
}

}  // namespace rr::service
