// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/codec/captures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "rr/message_tree.hpp"
#include "rr/reader.hpp"
#include "runtime/cpp/src/codec/parse.hpp"

namespace rr {
namespace {

using nlohmann::json;

// What a recording calls an element: its name, or else its number.
void expect_same_name(const ElementTree& tree, const json& decoded) {
  if (decoded.contains("name")) {
    EXPECT_EQ(tree.name, decoded.at("name").get<std::string>());
  } else {
    EXPECT_EQ(tree.number, decoded.at("number").get<std::int32_t>());
  }
  EXPECT_EQ(tree.name_code, decoded.value("name_code", 0U));
  EXPECT_EQ(tree.type_name, decoded.value("type_name", ""));
  EXPECT_EQ(tree.type_name_code, decoded.value("type_name_code", 0U));
  EXPECT_EQ(tree.metadata, decoded.value("metadata", ""));
}

void expect_same_elements(const std::vector<ElementTree>& trees, const json& decoded) {
  ASSERT_EQ(trees.size(), decoded.size());
  for (std::size_t i = 0; i < trees.size(); ++i) {
    expect_same_name(trees[i], decoded[i]);
    EXPECT_EQ(static_cast<int>(trees[i].type), decoded[i].at("type").get<int>());
    EXPECT_EQ(trees[i].count, decoded[i].at("count").get<std::uint32_t>());
    EXPECT_EQ(trees[i].flags, decoded[i].value("flags", 0));
    if (decoded[i].contains("elements")) {
      expect_same_elements(trees[i].elements, decoded[i].at("elements"));
    }
  }
}

void expect_same_header(const MessageTree& tree, const json& header) {
  EXPECT_EQ(static_cast<int>(tree.version), header.at("version").get<int>());
  EXPECT_EQ(tree.flags, header.value("flags", 0));
  EXPECT_EQ(tree.sender_name, header.value("sender_node_name", ""));
  EXPECT_EQ(tree.receiver_name, header.value("receiver_node_name", ""));
  EXPECT_EQ(tree.sender_endpoint, header.value("sender_endpoint", 0U));
  EXPECT_EQ(tree.receiver_endpoint, header.value("receiver_endpoint", 0U));
  EXPECT_EQ(tree.sender_node.is_any(), header.value("sender_node_id", "any") == "any");
  EXPECT_EQ(tree.receiver_node.is_any(), header.value("receiver_node_id", "any") == "any");
  EXPECT_EQ(tree.priority, header.value("priority", 0));
  EXPECT_EQ(tree.metadata, header.value("metadata", ""));
  EXPECT_EQ(tree.message_id, header.value("message_id", 0));
  EXPECT_EQ(tree.message_res_id, header.value("message_res_id", 0));
  EXPECT_EQ(tree.extended, captures::from_hex(header.value("extended", "")));
  const json strings = header.value("string_table", json::array());
  ASSERT_EQ(tree.strings.size(), strings.size());
  for (std::size_t i = 0; i < strings.size(); ++i) {
    EXPECT_EQ(tree.strings[i].first, strings[i][0].get<std::uint32_t>());
    EXPECT_EQ(tree.strings[i].second, strings[i][1].get<std::string>());
  }
}

// A recording shows `?5` for a code that stands for nothing.
std::string shown(const std::string& text, std::uint32_t code, const std::string& decoded) {
  return decoded == "?" + std::to_string(code) ? decoded : text;
}

void expect_same_message(const MessageTree& tree, const json& decoded) {
  expect_same_header(tree, decoded.at("header"));
  const json& entries = decoded.at("entries");
  ASSERT_EQ(tree.entries.size(), entries.size());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const EntryTree& entry = tree.entries[i];
    const json& wanted = entries[i];
    const std::string member = wanted.at("member");
    EXPECT_EQ(static_cast<int>(entry.type), wanted.at("entry_type").get<int>());
    EXPECT_EQ(entry.service_path, wanted.at("service_path").get<std::string>());
    EXPECT_EQ(entry.service_path_code, wanted.value("service_path_code", 0U));
    EXPECT_EQ(shown(entry.member, entry.member_code, member), member);
    EXPECT_EQ(entry.member_code, wanted.value("member_code", 0U));
    EXPECT_EQ(entry.request_id, wanted.at("request_id").get<std::uint32_t>());
    EXPECT_EQ(entry.error, wanted.at("error").get<int>());
    EXPECT_EQ(entry.metadata, wanted.value("metadata", ""));
    EXPECT_EQ(entry.flags, wanted.value("flags", 0));
    expect_same_elements(entry.elements, wanted.at("elements"));
  }
}

TEST(Captures, EveryFrameIsReadAsRecordedAndWrittenBackByteForByte) {
  const auto frames = captures::frames();
  EXPECT_EQ(frames.size(), 5542U);
  for (const captures::Frame& frame : frames) {
    SCOPED_TRACE(frame.name);
    MessageTree tree;
    ASSERT_TRUE(read_tree(frame.bytes, tree));
    expect_same_message(tree, frame.decoded);
    ASSERT_EQ(write_tree(tree), frame.bytes);
    if (::testing::Test::HasFailure()) return;
  }
}

// The frames that a service closed the connection for, or stopped reading at.
bool is_refused(const std::string& name) {
  static const std::set<std::string> names = {
      "special_requests.v2 frame 76", "special_requests.v4 frame 76",     // no entries
      "special_requests.v4 frame 102", "special_requests.v4 frame 107"};  // unknown codes
  return names.contains(name);
}

TEST(Captures, EveryFrameThatWasServedIsAccepted) {
  for (const captures::Frame& frame : captures::frames()) {
    Message message;
    const char* what = "";
    EXPECT_EQ(read_message(frame.bytes, Limits{}, frame.string_table, message, &what),
              !is_refused(frame.name))
        << frame.name << ": " << what;
    EXPECT_TRUE(can_be_message(std::span(frame.bytes).first(frame.bytes.size() / 2 + 8),
                               frame.bytes.size()) ||
                is_refused(frame.name))
        << frame.name;
  }
}

// What a thread that handles a message later needs of it.
TEST(Captures, AcceptedFramesAreReadOnceMoreWithoutACheck) {
  std::size_t accepted = 0;
  for (const captures::Frame& frame : captures::frames()) {
    SCOPED_TRACE(frame.name);
    Message before;
    Entry first_before;
    if (!read_message(frame.bytes, Limits{}, frame.string_table, before, first_before)) continue;
    ++accepted;
    Message message;
    Entry first;
    ASSERT_TRUE(codec::reread_message(frame.bytes, frame.string_table, message, first));
    EXPECT_EQ(message.version, before.version);
    EXPECT_EQ(message.sender_node, before.sender_node);
    EXPECT_EQ(message.sender_endpoint, before.sender_endpoint);
    EXPECT_EQ(message.message_id, before.message_id);
    EXPECT_EQ(message.entry_count, before.entry_count);
    EXPECT_EQ(message.entries.data(), before.entries.data());
    EXPECT_EQ(message.entries.size(), before.entries.size());
    EXPECT_EQ(first.type, first_before.type);
    EXPECT_EQ(first.service_path, first_before.service_path);
    EXPECT_EQ(first.member, first_before.member);
    EXPECT_EQ(first.request_id, first_before.request_id);
    EXPECT_EQ(first.element_count, first_before.element_count);
    EXPECT_EQ(first.elements.data(), first_before.elements.data());
    EXPECT_EQ(first.elements.size(), first_before.elements.size());
  }
  EXPECT_EQ(accepted, 5538U);
}

void expect_values_written_back(MessageVersion version, std::size_t count) {
  const auto values = captures::values(version);
  EXPECT_EQ(values.size(), count);
  for (const captures::Value& value : values) {
    ElementTree tree;
    ASSERT_TRUE(read_element_tree(value.bytes, version, tree)) << value.name;
    EXPECT_EQ(write_element_tree(tree, version), value.bytes) << value.name;
  }
}

TEST(Captures, EveryValueIsWrittenBackByteForByte) {
  expect_values_written_back(MessageVersion::v2, 257);
  expect_values_written_back(MessageVersion::v4, 261);
}

// What a connection does with bytes that come in: messages one after the other, until one is
// refused or the rest is still to come.
bool is_refused(std::span<const std::byte> bytes) {
  while (bytes.size() >= smallest_message) {
    const std::size_t size = message_size(bytes, Limits{});
    if (size == 0) return true;
    if (size > bytes.size()) return !can_be_message(bytes, size);
    Message message;
    if (!read_message(bytes.first(size), Limits{}, false, message, nullptr)) return true;
    bytes = bytes.subspan(size);
  }
  return false;
}

// Where ours differs from the reference: a size of the header that is not its own is refused, and
// so are deep nestings, which end the reference's process when they are deep enough.
bool is_stricter(const std::string& name) {
  static const std::set<std::string> names = {
      "header size 0",         "header size 5",         "header size one too large",
      "header size 252",       "lists nested 100 deep", "lists nested 1000 deep",
      "lists nested 5000 deep"};
  return names.contains(name);
}

TEST(Captures, MalformedInputIsRefusedAndTheControlsAreNot) {
  const auto cases = captures::malformed();
  EXPECT_EQ(cases.size(), 281U);
  std::size_t refused = 0;
  for (const captures::Malformed& item : cases) {
    const bool expected = item.result == "closed" || is_stricter(item.name);
    EXPECT_EQ(is_refused(item.bytes), expected)
        << item.name << ", format " << static_cast<int>(item.version) << ", " << item.result;
    refused += expected ? 1U : 0U;
  }
  EXPECT_EQ(refused, 194U + 11U);
}

}  // namespace
}  // namespace rr
