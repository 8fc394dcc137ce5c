// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/cpp/fuzz/conversation.hpp"
#include "runtime/cpp/fuzz/message_mutation.hpp"

namespace rr::fuzz {

/// Changes inputs as a whole: which messages they have, in which order.
class ConversationMutation {
 public:
  ConversationMutation(std::uint32_t seed, MutateBytes* mutate_bytes)
      : random_(seed), mutate_bytes_(mutate_bytes) {}

  Bytes mutate(std::span<const std::byte> input);
  /// Something of both.
  Bytes cross(std::span<const std::byte> first, std::span<const std::byte> second);

 private:
  using Parts = std::vector<Bytes>;

  void add_beginning(Parts& parts);
  void add_request(Parts& parts);
  void rearrange(Parts& parts);
  void mutate_raw(Bytes& part);
  void mutate_message(Bytes& part, const Parts& others);

  Random random_;
  MutateBytes* mutate_bytes_;
};

}  // namespace rr::fuzz
