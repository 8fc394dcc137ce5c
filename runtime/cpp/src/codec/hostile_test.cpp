// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>

#include "rr/message_tree.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/codec/allocations.hpp"
#include "runtime/cpp/src/codec/captures.hpp"

namespace rr {
namespace {

// Visits everything; gives a number that depends on all that was read.
std::size_t walk(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count) {
  std::size_t sum = 0;
  ElementReader reader(decoder, bytes, count);
  Element element;
  while (reader.next(element)) {
    sum += element.name.size() + element.type_name.size() + element.metadata.size() +
           element.payload.size() + static_cast<std::size_t>(element.index().value_or(1));
    if (is_nested(element.type)) sum += walk(decoder, element.payload, element.count);
  }
  EXPECT_TRUE(decoder.failed() || reader.at_end());
  return sum;
}

// True when the message is accepted; all of it has then been visited without a failure.
bool read_all(std::span<const std::byte> bytes, std::size_t& sum) {
  Message message;
  if (!read_message(bytes, Limits{}, true, message, nullptr)) return false;
  EntryReader entries(message);
  Entry entry;
  std::uint32_t left = message.entry_count;
  while (entries.next(entry)) {
    --left;
    Decoder decoder(message.version, &message.strings);
    sum += walk(decoder, entry.elements, entry.element_count);
    EXPECT_FALSE(decoder.failed());
  }
  EXPECT_EQ(left, 0U);
  return true;
}

TEST(Hostile, ReadingAllocatesNothing) {
  const auto frames = captures::frames("v4st.json");
  const auto more = captures::frames("properties_pods.v2.json");
  std::size_t sum = 0;
  std::size_t accepted = 0;
  const std::size_t before = allocations();
  for (const captures::Frame& frame : frames) accepted += read_all(frame.bytes, sum) ? 1U : 0U;
  for (const captures::Frame& frame : more) accepted += read_all(frame.bytes, sum) ? 1U : 0U;
  EXPECT_EQ(allocations(), before);
  EXPECT_EQ(accepted, frames.size() + more.size());
  EXPECT_GT(sum, 10'000U);
}

TEST(Hostile, AReusedWriterAllocatesNothing) {
  Writer writer;
  const std::vector<std::byte> array(Writer::attach_threshold);
  const auto write = [&] {
    writer.reset(MessageVersion::v4);
    writer.string_element("text", "some text");
    const std::size_t end = writer.position();
    writer.prepend_array(array, {});
    writer.element("array", ElementType::uint8, {}, Writer::attach_threshold, end);
    writer.entry({}, 2, 0);
    writer.message({}, 1);
    return writer.pieces().size();
  };
  write();
  const std::size_t before = allocations();
  for (int i = 0; i < 100; ++i) write();
  EXPECT_EQ(allocations(), before);
}

// One frame of each kind that the recordings have, told apart by version, types and sizes.
std::vector<captures::Frame> selection() {
  std::vector<captures::Frame> chosen;
  std::set<std::string> kinds;
  for (const char* file :
       {"special_requests.v2.json", "special_requests.v4.json", "properties_pods.v4.json",
        "properties_varvalues.v2.json", "properties_varvalues.v4.json", "functions.v4st.json"}) {
    for (captures::Frame& frame : captures::frames(file)) {
      if (frame.bytes.size() > 300) continue;
      std::string kind = frame.decoded.at("header").dump().substr(0, 30);
      for (const auto& entry : frame.decoded.at("entries")) {
        kind += entry.at("entry_type").dump() + ' ';
        for (const auto& element : entry.at("elements")) kind += element.at("type").dump() + ' ';
      }
      if (kinds.insert(kind).second) chosen.push_back(std::move(frame));
    }
  }
  return chosen;
}

TEST(Hostile, EveryPrefixIsRefused) {
  std::size_t sum = 0;
  for (const captures::Frame& frame : selection()) {
    for (std::size_t size = 0; size < frame.bytes.size(); ++size) {
      // A buffer of its own, so that a sanitizer sees a step over the end.
      std::vector<std::byte> prefix(frame.bytes.begin(),
                                    frame.bytes.begin() + static_cast<std::ptrdiff_t>(size));
      EXPECT_FALSE(read_all(prefix, sum)) << frame.name << ", " << size << " bytes";
      // The same with a size that says that this is all.
      if (size < smallest_message) continue;
      const auto stated = static_cast<std::uint32_t>(size);
      std::memcpy(prefix.data() + 4, &stated, sizeof stated);
      EXPECT_FALSE(read_all(prefix, sum)) << frame.name << ", " << size << " bytes";
      can_be_message(prefix, frame.bytes.size());
      largest_array_offset(prefix, frame.bytes.size());
    }
  }
}

TEST(Hostile, EveryChangedByteIsRefusedOrRead) {
  std::size_t accepted = 0;
  std::size_t refused = 0;
  std::size_t sum = 0;
  const auto frames = selection();
  EXPECT_GE(frames.size(), 60U);
  for (const captures::Frame& frame : frames) {
    std::vector<std::byte> bytes = frame.bytes;
    for (std::byte& changed : bytes) {
      const std::byte original = changed;
      for (const int value : {0, 1, 5, 64, 127, 253, 254, 255}) {
        changed = static_cast<std::byte>(value);
        ++(read_all(bytes, sum) ? accepted : refused);
        MessageTree tree;
        const bool is_message = read_tree(bytes, tree);
        EXPECT_FALSE(is_message && write_tree(tree).empty()) << frame.name;
        can_be_message(bytes, bytes.size());
        EXPECT_LT(largest_array_offset(bytes, bytes.size()), bytes.size());
      }
      changed = original;
    }
  }
  EXPECT_GT(accepted, 1000U);
  EXPECT_GT(refused, 1000U);
}

TEST(Hostile, CountsAreNotBelieved) {
  // 2^32-1 elements, announced in an entry and in a list of 5 bytes more than their headers.
  const auto entry =
      captures::from_hex("52524143 1b000000 0400 0c 00 0f 05 6f00 00 00 feffffffff 05 00 0000 00");
  const auto list = captures::from_hex(
      "52524143 21000000 0400 0c 00 15 05 6f00 00 00 01 0e 00 6c00 feffffffff 05 00 0000 00");
  const auto strings =
      captures::from_hex("52524143 18000000 0400 11 20 feffffffff 07 05 6f00 00 00 00");
  std::size_t sum = 0;
  const std::size_t before = allocations();
  EXPECT_FALSE(read_all(entry, sum));
  EXPECT_FALSE(read_all(list, sum));
  EXPECT_FALSE(read_all(strings, sum));
  EXPECT_EQ(allocations(), before);
}

TEST(Hostile, ATableOfTooManyStringsIsRefused) {
  const auto message = [](std::uint32_t count) {
    MessageTree tree;
    tree.version = MessageVersion::v4;
    tree.flags = 0x20;
    for (std::uint32_t i = 0; i < count; ++i) tree.strings.emplace_back(2 * i + 1, "s");
    tree.entries.emplace_back();
    return write_tree(tree);
  };
  std::size_t sum = 0;
  EXPECT_TRUE(read_all(message(StringTable::capacity), sum));
  EXPECT_FALSE(read_all(message(StringTable::capacity + 1), sum));
}

TEST(Hostile, ManyElementsWithCodesOfAFullTableAreRead) {
  // None of the codes is where a writer that counts 1, 3, 5, ... would have put it.
  MessageTree tree;
  tree.version = MessageVersion::v4;
  tree.flags = 0x20;
  for (std::uint32_t i = 0; i < StringTable::capacity; ++i) {
    tree.strings.emplace_back(0x10001 + 2 * i, "s");
  }
  ElementTree element;
  element.flags = 0x02;
  element.name_code = 0x10101;
  EntryTree entry;
  entry.elements.assign(100'000, element);
  tree.entries.push_back(std::move(entry));
  const std::vector<std::byte> bytes = write_tree(tree);
  std::size_t sum = 0;
  EXPECT_TRUE(read_all(bytes, sum));
}

TEST(Hostile, EmptyInputIsHarmless) {
  std::size_t sum = 0;
  EXPECT_FALSE(read_all({}, sum));
  EXPECT_EQ(message_size({}, Limits{}), 0U);
  EXPECT_TRUE(can_be_message({}, 100));
  EXPECT_EQ(largest_array_offset({}, 100), 0U);
  MessageTree tree;
  EXPECT_FALSE(read_tree({}, tree));
  ElementTree element;
  EXPECT_FALSE(read_element_tree({}, MessageVersion::v4, element));
  EXPECT_TRUE(apply_string_table({}, true, true).empty());
}

}  // namespace
}  // namespace rr
