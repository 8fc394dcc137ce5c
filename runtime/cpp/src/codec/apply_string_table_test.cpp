// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "rr/message_tree.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/codec/captures.hpp"
#include "runtime/cpp/src/codec/flags.hpp"

namespace rr {
namespace {

void replace_codes(std::vector<ElementTree>& elements) {
  namespace flag = codec::element_flag;
  for (ElementTree& element : elements) {
    if ((element.flags & flag::name_code) != 0) element.flags ^= flag::name_code | flag::name_text;
    if ((element.flags & flag::type_name_code) != 0) {
      element.flags ^= flag::type_name_code | flag::type_name_text;
    }
    element.name_code = element.type_name_code = 0;
    replace_codes(element.elements);
  }
}

// The message with every code replaced by its text, as it was before the codes were given.
std::vector<std::byte> without_codes(MessageTree tree) {
  namespace flag = codec::entry_flag;
  tree.strings.clear();
  tree.flags &= static_cast<std::uint8_t>(~codec::message_flag::string_table);
  for (EntryTree& entry : tree.entries) {
    if ((entry.flags & flag::path_code) != 0) entry.flags ^= flag::path_code | flag::path_text;
    if ((entry.flags & flag::member_code) != 0) {
      entry.flags ^= flag::member_code | flag::member_text;
    }
    entry.service_path_code = entry.member_code = 0;
    replace_codes(entry.elements);
  }
  return write_tree(tree);
}

// The order of a table is arbitrary (02, section 6.2).
MessageTree with_sorted_table(std::span<const std::byte> bytes) {
  MessageTree tree;
  EXPECT_TRUE(read_tree(bytes, tree));
  std::sort(tree.strings.begin(), tree.strings.end());
  return tree;
}

TEST(ApplyStringTable, GivesTheCodesOfTheRecordings) {
  std::size_t compared = 0;
  for (const captures::Frame& frame : captures::frames("v4st.json")) {
    MessageTree recorded = with_sorted_table(frame.bytes);
    if (recorded.version != MessageVersion::v4) continue;
    ++compared;
    const std::vector<std::byte> plain = without_codes(recorded);
    EXPECT_GT(plain.size(), 0U);
    const std::vector<std::byte> applied = apply_string_table(plain, true, true);
    EXPECT_EQ(with_sorted_table(applied), recorded) << frame.name;
    EXPECT_EQ(applied.size(), frame.bytes.size()) << frame.name;
  }
  EXPECT_EQ(compared, 212U);
}

TEST(ApplyStringTable, LeavesTheContentAsItWas) {
  for (const captures::Frame& frame : captures::frames("properties_structs.v4.json")) {
    MessageTree before;
    ASSERT_TRUE(read_tree(frame.bytes, before));
    for (const bool local : {false, true}) {
      for (const bool standard : {false, true}) {
        MessageTree after;
        ASSERT_TRUE(read_tree(apply_string_table(frame.bytes, local, standard), after));
        EXPECT_EQ(without_codes(after), write_tree(before)) << frame.name;
      }
    }
  }
}

std::vector<std::byte> message_with_names(const std::vector<std::string>& names) {
  Writer writer;
  writer.reset(MessageVersion::v4);
  for (auto name = names.rbegin(); name != names.rend(); ++name) writer.null_element(*name);
  EntryHeader entry;
  entry.service_path = "p";
  entry.member = "m";
  writer.entry(entry, static_cast<std::uint32_t>(names.size()), 0);
  writer.message({}, 1);
  return writer.copy();
}

TEST(ApplyStringTable, StopsWhereTheTableIsFull) {
  std::vector<std::string> names;
  for (int i = 100; i < 300; ++i) names.push_back("name" + std::to_string(i));
  const auto bytes = apply_string_table(message_with_names(names), true, false);
  MessageTree tree;
  ASSERT_TRUE(read_tree(bytes, tree));
  // `m` and `p` take 3 bytes each; of codes up to 252 each name takes 1 + 1 + 7 bytes.
  EXPECT_EQ(tree.strings.size(), 2U + (1024U - 6U) / 9U);
  EXPECT_EQ(tree.entries[0].member_code, 1U);
  EXPECT_EQ(tree.entries[0].service_path_code, 3U);
  EXPECT_EQ(tree.entries[0].elements[0].name_code, 5U);
  EXPECT_EQ(tree.entries[0].elements.back().flags, codec::element_flag::name_text);
  Message message;
  EXPECT_TRUE(read_message(bytes, Limits{}, false, message, nullptr));
}

TEST(ApplyStringTable, WhatItWritesIsNeverTooMuchForAReader) {
  std::vector<std::string> names;
  for (int c = 0; c < 256; ++c) names.emplace_back(1, static_cast<char>(c));
  names.emplace_back("");
  const auto bytes = apply_string_table(message_with_names(names), true, false);
  Message message;
  EXPECT_TRUE(read_message(bytes, Limits{}, false, message, nullptr));
}

TEST(ApplyStringTable, LeavesLongTextsAndOtherMessagesAlone) {
  const auto bytes = message_with_names({std::string(128, 'a'), std::string(129, 'b')});
  MessageTree tree;
  ASSERT_TRUE(read_tree(apply_string_table(bytes, true, false), tree));
  EXPECT_EQ(tree.entries[0].elements[0].name_code, 5U);
  EXPECT_EQ(tree.entries[0].elements[1].flags, codec::element_flag::name_text);

  Writer writer;
  writer.reset(MessageVersion::v2);
  writer.entry({}, 0, 0);
  writer.message({}, 1);
  EXPECT_EQ(apply_string_table(writer.copy(), true, true), writer.copy());
  EXPECT_EQ(apply_string_table(std::span(bytes).first(20), true, true),
            std::vector(bytes.begin(), bytes.begin() + 20));
}

}  // namespace
}  // namespace rr
