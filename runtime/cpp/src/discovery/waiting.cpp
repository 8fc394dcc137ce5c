// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/waiting.hpp"

#include <array>
#include <random>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/reactor.hpp"
#include "runtime/cpp/src/platform/random.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::discovery {

void wait_for_either(const channel::Interruption& wake, channel::Time deadline) {
  const channel::Interruption* const own = channel::Interruption::current();
  using platform::ready::input;
  std::array<platform::Awaited, 2> wanted{
      {{wake.descriptor(), input}, {own != nullptr ? own->descriptor() : -1, input}}};
  channel::Reactor::about_to_wait();
  while (!wake.is_interrupted()) {
    if (own != nullptr && own->is_interrupted()) {
      throw Error(ErrorCode::operation_cancelled, "looking was given up");
    }
    if (!platform::wait_for_any(wanted, deadline)) return;
  }
}

channel::Milliseconds random_between(int least, int most) {
  platform::RandomNumbers numbers;
  return channel::Milliseconds(std::uniform_int_distribution<int>(least, most)(numbers));
}

}  // namespace rr::discovery
