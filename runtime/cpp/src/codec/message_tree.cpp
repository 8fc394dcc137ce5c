// SPDX-License-Identifier: Apache-2.0
#include "rr/message_tree.hpp"

#include <limits>

#include "runtime/cpp/src/codec/exact.hpp"
#include "runtime/cpp/src/codec/parse.hpp"

namespace rr {
namespace {

using codec::Cursor;
using codec::UnknownCode;

std::vector<std::byte> owned(std::span<const std::byte> bytes) {
  return {bytes.begin(), bytes.end()};
}

const char* parse_element(MessageVersion version, Cursor& in, const StringTable& strings,
                          Element& element) {
  return version == MessageVersion::v2
             ? codec::parse_element_v2(in.at, in.end, element)
             : codec::parse_element_v4<UnknownCode::keep>(in.at, in.end, &strings, element);
}

// The bytes have been checked, so that nothing here fails and the recursion is bounded.
std::vector<ElementTree> read_elements(MessageVersion version, std::span<const std::byte> bytes,
                                       std::uint32_t count, const StringTable& strings) {
  std::vector<ElementTree> trees(count);
  Cursor in{bytes.data(), bytes.data() + bytes.size()};
  Element element;
  for (ElementTree& tree : trees) {
    if (parse_element(version, in, strings, element) != nullptr) break;
    tree.flags = element.flags;
    tree.name = element.name;
    tree.name_code = element.name_code;
    tree.number = element.number;
    tree.type = element.type;
    tree.type_name = element.type_name;
    tree.type_name_code = element.type_name_code;
    tree.metadata = element.metadata;
    tree.extended = owned(element.extended);
    tree.count = element.count;
    if (is_nested(element.type)) {
      tree.elements = read_elements(version, element.payload, element.count, strings);
    } else {
      tree.payload = owned(element.payload);
    }
  }
  return trees;
}

void read_strings(const Message& message, MessageTree& tree) {
  Cursor in{message.string_entries.data(),
            message.string_entries.data() + message.string_entries.size()};
  for (std::uint32_t i = 0; i < message.string_count; ++i) {
    std::uint32_t code = 0;
    std::string_view text;
    if (!in.uint_x(code) || !in.xstring(text)) return;
    tree.strings.emplace_back(code, text);
  }
}

void read_header(const Message& message, MessageTree& tree) {
  tree = {};
  tree.version = message.version;
  tree.flags = message.flags;
  tree.sender_node = message.sender_node;
  tree.receiver_node = message.receiver_node;
  tree.sender_name = message.sender_name;
  tree.receiver_name = message.receiver_name;
  tree.sender_endpoint = message.sender_endpoint;
  tree.receiver_endpoint = message.receiver_endpoint;
  tree.priority = message.priority;
  tree.metadata = message.metadata;
  tree.message_id = message.message_id;
  tree.message_res_id = message.message_res_id;
  tree.extended = owned(message.extended);
  read_strings(message, tree);
}

EntryTree read_entry(const Message& message, const Entry& entry) {
  EntryTree tree;
  tree.flags = entry.flags;
  tree.type = entry.type;
  tree.service_path = entry.service_path;
  tree.service_path_code = entry.service_path_code;
  tree.member = entry.member;
  tree.member_code = entry.member_code;
  tree.request_id = entry.request_id;
  tree.error = entry.error;
  tree.metadata = entry.metadata;
  tree.extended = owned(entry.extended);
  tree.elements =
      read_elements(message.version, entry.elements, entry.element_count, message.strings);
  return tree;
}

void write_element(Writer& writer, const ElementTree& tree) {
  const std::size_t end = writer.position();
  Element element;
  element.flags = tree.flags;
  element.name = tree.name;
  element.name_code = tree.name_code;
  element.number = tree.number;
  element.type = tree.type;
  element.type_name = tree.type_name;
  element.type_name_code = tree.type_name_code;
  element.metadata = tree.metadata;
  element.extended = tree.extended;
  if (is_nested(tree.type)) {
    for (auto nested = tree.elements.rbegin(); nested != tree.elements.rend(); ++nested) {
      write_element(writer, *nested);
    }
    element.count = static_cast<std::uint32_t>(tree.elements.size());
  } else if (const std::size_t size = item_size(tree.type); size != 0) {
    writer.prepend_array(tree.payload, {});
    element.count = static_cast<std::uint32_t>(tree.payload.size() / size);
    if (tree.payload.size() % size != 0) {
      writer.fail(ErrorCode::protocol_error, "part of an item", tree.name);
    }
  } else {
    element.count = tree.count;
    if (tree.type != ElementType::void_ || !tree.payload.empty()) {
      writer.fail(ErrorCode::protocol_error, "payload of a null", tree.name);
    }
  }
  codec::write_element_header(writer, element, end);
}

void write_entry(Writer& writer, const EntryTree& tree) {
  const std::size_t end = writer.position();
  for (auto element = tree.elements.rbegin(); element != tree.elements.rend(); ++element) {
    write_element(writer, *element);
  }
  Entry entry;
  entry.flags = tree.flags;
  entry.type = tree.type;
  entry.service_path = tree.service_path;
  entry.service_path_code = tree.service_path_code;
  entry.member = tree.member;
  entry.member_code = tree.member_code;
  entry.request_id = tree.request_id;
  entry.error = tree.error;
  entry.metadata = tree.metadata;
  entry.extended = tree.extended;
  entry.element_count = static_cast<std::uint32_t>(tree.elements.size());
  codec::write_entry_header(writer, entry, end);
}

void write_header(Writer& writer, const MessageTree& tree) {
  Message message;
  message.flags = tree.flags;
  message.sender_node = tree.sender_node;
  message.receiver_node = tree.receiver_node;
  message.sender_name = tree.sender_name;
  message.receiver_name = tree.receiver_name;
  message.sender_endpoint = tree.sender_endpoint;
  message.receiver_endpoint = tree.receiver_endpoint;
  message.priority = tree.priority;
  message.metadata = tree.metadata;
  message.message_id = tree.message_id;
  message.message_res_id = tree.message_res_id;
  message.extended = tree.extended;
  message.entry_count = static_cast<std::uint32_t>(tree.entries.size());
  std::vector<codec::StringCode> strings;
  for (const auto& [code, text] : tree.strings) strings.push_back({code, text});
  codec::write_message_header(writer, message, strings);
}

std::vector<std::byte> finished(Writer& writer) {
  return writer.failed() ? std::vector<std::byte>{} : writer.copy();
}

}  // namespace

bool read_tree(std::span<const std::byte> bytes, MessageTree& tree) {
  Message message;
  message.strings.reset(true);
  Limits limits;
  limits.message_size = std::numeric_limits<std::uint32_t>::max();
  Entry first;
  if (codec::check_message(bytes, limits, UnknownCode::keep, message, first) != nullptr)
    return false;
  read_header(message, tree);
  Cursor in{message.entries.data(), message.entries.data() + message.entries.size()};
  Entry entry;
  for (std::uint32_t i = 0; i < message.entry_count; ++i) {
    if (codec::parse_entry<UnknownCode::keep>(message.version, in, &message.strings, entry) !=
        nullptr) {
      return false;
    }
    tree.entries.push_back(read_entry(message, entry));
  }
  return true;
}

std::vector<std::byte> write_tree(const MessageTree& tree) {
  const bool counted = (tree.flags & codec::message_flag::multiple_entries) != 0;
  if (tree.version == MessageVersion::v4 && !counted && tree.entries.size() != 1) return {};
  if (tree.entries.size() > 0xFFFF) return {};
  Writer writer;
  writer.reset(tree.version);
  for (auto entry = tree.entries.rbegin(); entry != tree.entries.rend(); ++entry) {
    write_entry(writer, *entry);
  }
  write_header(writer, tree);
  return finished(writer);
}

bool read_element_tree(std::span<const std::byte> bytes, MessageVersion version,
                       ElementTree& tree) {
  const StringTable strings(true);
  if (codec::check_elements(version, bytes, 1, &strings, Limits::deepest, UnknownCode::keep) !=
      nullptr) {
    return false;
  }
  tree = std::move(read_elements(version, bytes, 1, strings).front());
  return true;
}

std::vector<std::byte> write_element_tree(const ElementTree& tree, MessageVersion version) {
  Writer writer;
  writer.reset(version);
  write_element(writer, tree);
  return finished(writer);
}

}  // namespace rr
