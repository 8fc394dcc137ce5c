// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/waiting.hpp"

#include <poll.h>

#include <array>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/channel/socket.hpp"

namespace rr::discovery {

void wait_for_either(const channel::Interruption& wake, channel::Time deadline) {
  const channel::Interruption* const own = channel::Interruption::current();
  std::array<pollfd, 2> wanted{
      {{wake.descriptor(), POLLIN, 0}, {own != nullptr ? own->descriptor() : -1, POLLIN, 0}}};
  channel::Reactor::about_to_wait();
  while (!wake.is_interrupted()) {
    if (own != nullptr && own->is_interrupted()) {
      throw Error(ErrorCode::operation_cancelled, "looking was given up");
    }
    if (poll(wanted.data(), wanted.size(), channel::poll_milliseconds(deadline)) == 0) return;
  }
}

}  // namespace rr::discovery
