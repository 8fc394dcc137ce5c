// SPDX-License-Identifier: Apache-2.0
// Datagrams of discovery: what is accepted comes back the same when it is written and read again.
#include <string_view>

#include "runtime/cpp/fuzz/promise.hpp"
#include "runtime/cpp/src/discovery/packets.hpp"

using rr::fuzz::promise;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view packet(reinterpret_cast<const char*>(data), size);
  static const rr::channel::Address sender = rr::channel::resolve("10.0.0.5", 1).front();
  if (const auto read = rr::discovery::read_announcement(packet, sender)) {
    promise(read->url.size() <= rr::discovery::longest_url, "a URL is not longer than it may be");
    const auto again =
        rr::discovery::read_announcement(rr::discovery::write_announcement(*read), sender);
    promise(again.has_value(), "what was accepted can be written");
    promise(again->node == read->node && again->name == read->name && again->url == read->url &&
                again->nonce == read->nonce,
            "and says the same");
  }
  if (const auto asker = rr::discovery::read_request(packet)) {
    promise(rr::discovery::read_request(rr::discovery::write_request(*asker)) == asker,
            "who asks stays the same");
  }
  return 0;
}
