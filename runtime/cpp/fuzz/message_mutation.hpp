// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <iterator>
#include <random>
#include <vector>

#include "runtime/cpp/fuzz/conversation.hpp"

namespace rr::fuzz {

/// Changes some of `size` bytes, of which there may be `max_size` then; returns how many there are.
using MutateBytes = std::size_t(std::uint8_t* data, std::size_t size, std::size_t max_size);

/// Choices that depend on a seed only.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}

  [[nodiscard]] std::uint32_t below(std::size_t end) {
    return static_cast<std::uint32_t>((engine_() >> 5) % end);
  }
  [[nodiscard]] bool one_in(std::uint32_t count) { return below(count) == 0; }
  template <class List>
  [[nodiscard]] auto& pick(List& list) {
    return *(std::begin(list) + below(std::size(list)));
  }

 private:
  std::minstd_rand engine_;
};

/// Changes one message and keeps its form: what comes of it gets past the codec, to what the
/// entries ask for.
class MessageMutation {
 public:
  MessageMutation(Random& random, MutateBytes* mutate_bytes)
      : random_(&random), mutate_bytes_(mutate_bytes) {}

  /// Makes one change. Parts of `other` may be taken over.
  void mutate(MessageTree& message, const MessageTree& other);
  /// A request for a member of the service.
  MessageTree random_request();

 private:
  using Elements = std::vector<ElementTree>;

  void mutate_header(MessageTree& message);
  void mutate_strings(MessageTree& message);
  void mutate_entries(std::vector<EntryTree>& entries, const std::vector<EntryTree>& others);
  void mutate_entry(EntryTree& entry);
  void mutate_elements(Elements& elements, const Elements& others, int depth);
  void mutate_element(ElementTree& element);
  void mutate_payload(ElementTree& element);
  void mutate_text(std::string& text);
  void wrap(ElementTree& element);
  Elements random_elements(std::string_view first_name);

  Random* random_;
  MutateBytes* mutate_bytes_;
};

}  // namespace rr::fuzz
