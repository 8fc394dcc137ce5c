// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/codec_fuzz.hpp"

#include <cstring>
#include <span>
#include <vector>

#include "rr/message_tree.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/fuzz/promise.hpp"

namespace rr {
namespace {

using Bytes = std::vector<std::byte>;
using fuzz::promise;

void walk(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count) {
  ElementReader reader(decoder, bytes, count);
  Element element;
  while (reader.next(element)) {
    static_cast<void>(element.index());
    if (is_nested(element.type)) {
      walk(decoder, element.payload, element.count);
    } else {
      promise(element.type == ElementType::void_ ||
                  element.payload.size() == element.count * item_size(element.type),
              "the payload is as long as its count says");
    }
  }
  promise(!decoder.failed() && reader.left() == 0 && reader.at_end(),
          "an accepted message can be walked");
}

bool accepts(std::span<const std::byte> bytes, bool standard_strings) {
  Message message;
  const char* what = nullptr;
  if (!read_message(bytes, Limits{}, standard_strings, message, &what)) {
    promise(what != nullptr, "a refusal has a reason");
    return false;
  }
  EntryReader entries(message);
  std::uint32_t count = 0;
  for (Entry entry; entries.next(entry); ++count) {
    Decoder decoder(message.version, &message.strings);
    walk(decoder, entry.elements, entry.element_count);
    Element element;
    find_element(decoder, entry.elements, entry.element_count, "value", element);
  }
  promise(count == message.entry_count, "an accepted message has all its entries");
  return true;
}

void check_beginnings(const Bytes& bytes, bool accepted) {
  for (std::size_t size = bytes.size(); size != 0; size /= 2) {
    const auto begun = std::span(bytes).first(size);
    const bool possible = can_be_message(begun, bytes.size());
    promise(possible || !accepted, "each beginning of a message is one");
    promise(largest_array_offset(begun, bytes.size()) < bytes.size(), "an array is in its message");
  }
}

void check_round_trip(const Bytes& bytes, MessageVersion version) {
  MessageTree tree;
  if (!read_tree(bytes, tree)) return;
  const Bytes written = write_tree(tree);
  // Sizes in longer forms than they need become shorter.
  promise(!written.empty() && written.size() <= bytes.size(), "a tree can be written");
  if (version == MessageVersion::v2) {
    promise(written.size() == bytes.size(), "format 2 has one form of everything");
  }
  MessageTree again;
  promise(read_tree(written, again), "what was written can be read");
  promise(again == tree, "what was read again is the same");
  promise(write_tree(again) == written, "what was written again is the same");
}

}  // namespace

void fuzz_message(const std::uint8_t* data, std::size_t size, MessageVersion version) {
  const auto* begin = reinterpret_cast<const std::byte*>(data);
  Bytes bytes(begin, begin + size);
  if (size >= 10) {
    const auto total = static_cast<std::uint32_t>(size);
    const auto number = static_cast<std::uint16_t>(version);
    std::memcpy(bytes.data(), "RRAC", 4);
    std::memcpy(bytes.data() + 4, &total, sizeof total);
    std::memcpy(bytes.data() + 8, &number, sizeof number);
  }
  const bool accepted = accepts(bytes, true);
  promise(accepted || !accepts(bytes, false), "more codes can only make more known");
  check_beginnings(bytes, accepted);
  check_round_trip(bytes, version);
  if (accepted) {
    promise(accepts(apply_string_table(bytes, true, true), true), "codes can be read");
    promise(accepts(apply_string_table(bytes, true, false), true), "own codes can be read");
  }
}

}  // namespace rr
