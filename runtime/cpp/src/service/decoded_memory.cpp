// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/service/decoded_memory.hpp"

#include <utility>

#include "runtime/cpp/src/channel/account.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/service/server_endpoint.hpp"

namespace rr::service {

DecodedMemory::~DecodedMemory() {
  const auto& account = endpoint_.connection().account();
  if (drawn_ != 0 && account) account->give_back(drawn_);
}

bool DecodedMemory::draw(std::size_t bytes) {
  if (bytes <= free_bytes && bytes_ <= free_bytes - bytes) {
    bytes_ += bytes;
    return true;
  }
  const std::size_t limit = endpoint_.container_limit();
  if (bytes_ > limit || bytes > limit - bytes_) return false;
  if (const std::size_t wanted = bytes_ + bytes; wanted > drawn_) {
    const auto& account = endpoint_.connection().account();
    std::size_t more = (wanted - drawn_ + quantum - 1) / quantum * quantum;
    if (account && !account->draw(more)) {
      more = wanted - drawn_;
      if (!account->draw(more)) return false;
    }
    drawn_ += more;
    if (drawn_ > many_bytes && !std::exchange(has_given_way_, true)) channel::Reactor::give_way();
  }
  bytes_ += bytes;
  return true;
}

}  // namespace rr::service
