// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "runtime/cpp/src/codec/parse.hpp"

namespace rr {
namespace codec {
namespace {

constexpr std::size_t common_start = 10;  // magic, message size, version
constexpr std::uint32_t most_entries = 0xFFFF;

// Source: 01, section 2. `in` starts behind the version.
const char* parse_header_v2(Cursor in, Message& message) {
  const Cursor whole{in.at - common_start, in.end};
  std::uint16_t header_size = 0;
  if (!in.number(header_size) || header_size > whole.left()) return "header size";
  in.end = whole.at + header_size;
  std::uint16_t entry_count = 0;
  if (in.at > in.end || !in.number(message.sender_node.bytes) ||
      !in.number(message.receiver_node.bytes) || !in.number(message.sender_endpoint) ||
      !in.number(message.receiver_endpoint) || !in.string16(message.sender_name) ||
      !in.string16(message.receiver_name) || !in.string16(message.metadata) ||
      !in.number(entry_count) || !in.number(message.message_id) ||
      !in.number(message.message_res_id)) {
    return "header longer than its size";
  }
  if (in.at != in.end) return "header shorter than its size";
  message.entry_count = entry_count;
  message.entries = {in.at, whole.end};
  return nullptr;
}

// Source: 02, section 6.1. Even codes and repeated ones are tolerated, but never used.
const char* parse_strings(Cursor& in, Message& message) {
  if (!in.uint_x(message.string_count)) return "string table";
  const std::byte* const begin = in.at;
  for (std::uint32_t i = 0; i < message.string_count; ++i) {
    std::uint32_t code = 0;
    std::string_view text;
    if (!in.uint_x(code) || !in.xstring(text)) return "string table";
    if (code % 2 != 0 && !message.strings.add(code, text)) return "too many strings";
  }
  message.string_entries = {begin, in.at};
  return nullptr;
}

// Source: 02, section 2. `in` starts behind the version.
const char* parse_header_v4(Cursor in, Message& message) {
  const Cursor whole{in.at - common_start, in.end};
  std::uint32_t header_size = 0;
  if (!in.uint_x(header_size) || header_size > whole.left()) return "header size";
  in.end = whole.at + header_size;
  if (in.at >= in.end) return "header longer than its size";
  const auto flags = std::to_integer<std::uint8_t>(*in.at++);
  message.flags = flags;
  message.has_routing = message.routing = (flags & message_flag::routing) != 0;
  message.has_endpoints = (flags & message_flag::endpoints) != 0;
  if (message.has_routing &&
      (!in.number(message.sender_node.bytes) || !in.number(message.receiver_node.bytes) ||
       !in.xstring(message.sender_name) || !in.xstring(message.receiver_name))) {
    return "routing fields";
  }
  if (message.has_endpoints &&
      (!in.uint_x(message.sender_endpoint) || !in.uint_x(message.receiver_endpoint))) {
    return "endpoint fields";
  }
  if ((flags & message_flag::priority) != 0 && !in.number(message.priority)) return "priority";
  if ((flags & message_flag::meta) != 0 &&
      (!in.xstring(message.metadata) || !in.number(message.message_id) ||
       !in.number(message.message_res_id))) {
    return "message metadata";
  }
  if ((flags & message_flag::string_table) != 0) {
    if (const char* wrong = parse_strings(in, message)) return wrong;
  }
  message.entry_count = 1;
  if ((flags & message_flag::multiple_entries) != 0 &&
      (!in.uint_x(message.entry_count) || message.entry_count > most_entries)) {
    return "entry count";
  }
  if ((flags & message_flag::extended) != 0 && !in.xbytes(message.extended)) {
    return "message extended field";
  }
  if (in.at != in.end) return "header shorter than its size";
  message.entries = {in.at, whole.end};
  return nullptr;
}

}  // namespace

const char* parse_header(std::span<const std::byte> bytes, const Limits& limits, Message& message) {
  if (bytes.size() < smallest_message) return "too short for a message";
  const std::size_t size = message_size(bytes, limits);
  if (size == 0) return "not a message, or one over the limit";
  if (size != bytes.size()) return "message size";
  return parse_begun_header(bytes, size, message);
}

[[gnu::hot]] const char* parse_begun_header(std::span<const std::byte> begun, std::size_t whole,
                                            Message& message) {
  if (begun.size() < smallest_message || begun.size() > whole) return "too short for a message";
  const bool is_v2 = std::to_integer<int>(begun[8]) == 2;
  static_cast<MessageHeader&>(message) = {};
  message.version = is_v2 ? MessageVersion::v2 : MessageVersion::v4;
  message.flags = 0;
  message.has_routing = true;
  message.has_endpoints = true;
  message.priority = 0;
  message.extended = {};
  message.string_count = 0;
  message.string_entries = {};
  const Cursor in{begun.data() + common_start, begun.data() + begun.size()};
  return is_v2 ? parse_header_v2(in, message) : parse_header_v4(in, message);
}

[[gnu::hot]] const char* check_message(std::span<const std::byte> bytes, const Limits& limits,
                                       UnknownCode unknown, Message& message, Entry& first,
                                       void (*progress)()) {
  if (const char* wrong = parse_header(bytes, limits, message)) return wrong;
  if (message.entry_count == 0 && unknown == UnknownCode::refuse) return "no entries";
  Cursor entries{message.entries.data(), message.entries.data() + message.entries.size()};
  const MessageVersion version = message.version;
  if (message.entry_count * least_entry(version) > entries.left()) return "more entries than bytes";
  Entry other;
  for (std::uint32_t i = 0; i < message.entry_count; ++i) {
    Entry& entry = i == 0 ? first : other;
    const char* wrong =
        unknown == UnknownCode::refuse
            ? parse_entry<UnknownCode::refuse>(version, entries, &message.strings, entry)
            : parse_entry<UnknownCode::keep>(version, entries, &message.strings, entry);
    if (wrong == nullptr) {
      wrong = check_elements(version, entry.elements, entry.element_count, &message.strings,
                             limits.depth, unknown, progress);
    }
    if (wrong != nullptr) return wrong;
  }
  return entries.left() == 0 ? nullptr : "bytes after the last entry";
}

[[gnu::hot]] bool reread_message(std::span<const std::byte> bytes, bool standard_strings,
                                 Message& message, Entry& first) {
  message.strings.reset(standard_strings);
  if (parse_begun_header(bytes, bytes.size(), message) != nullptr) return false;
  Cursor entries{message.entries.data(), message.entries.data() + message.entries.size()};
  return parse_entry<UnknownCode::refuse>(message.version, entries, &message.strings, first) ==
         nullptr;
}

}  // namespace codec

[[gnu::hot]] std::size_t message_size(std::span<const std::byte> bytes, const Limits& limits) {
  codec::Cursor in{bytes.data(), bytes.data() + bytes.size()};
  std::uint32_t magic = 0;
  std::uint32_t size = 0;
  std::uint16_t version = 0;
  constexpr std::uint32_t rrac = 0x43415252;  // "RRAC" as it lies
  if (!in.number(magic) || !in.number(size) || !in.number(version)) return 0;
  if (magic != rrac || size < smallest_message || size > limits.message_size) return 0;
  return version == 2 || version == 4 ? size : 0;
}

namespace {

// The size of the header as it says itself, once that has been received.
std::uint32_t stated_header_size(codec::Cursor in, bool is_v2) {
  std::uint32_t size = 0;
  if (!is_v2) return in.uint_x(size) ? size : 0;
  std::uint16_t narrow = 0;
  return in.number(narrow) ? narrow : 0;
}

}  // namespace

bool can_be_message(std::span<const std::byte> begun, std::size_t whole) {
  if (begun.size() < smallest_message) return true;
  if (begun.size() > whole) return false;
  const bool is_v2 = std::to_integer<int>(begun[8]) == 2;
  const std::byte* const begin = begun.data();
  const std::byte* const end = begin + begun.size();
  const std::uint32_t header = stated_header_size({begin + codec::common_start, end}, is_v2);
  if (header > whole) return false;
  if (header > begun.size()) return true;

  Message message;
  message.strings.reset(false);
  if (codec::parse_begun_header(begun, whole, message) != nullptr) return false;
  const std::size_t least = codec::least_entry(message.version);
  codec::Cursor entries{message.entries.data(), end};
  std::size_t rest = whole - static_cast<std::size_t>(entries.at - begin);
  for (std::uint32_t left = message.entry_count; left != 0; --left) {
    if (rest < left * least) return false;
    codec::Cursor in = entries;
    std::uint32_t size = 0;
    if (is_v2 ? !in.number(size) : !in.uint_x(size)) {
      // Not received yet, unless it has the form that no field may have.
      return is_v2 || in.left() == 0 || *in.at != std::byte{0xFF};
    }
    if (size < least || size > rest) return false;
    rest -= size;
    if (size > entries.left()) return left == 1 ? rest == 0 : rest >= (left - 1) * least;
    entries.at += size;
  }
  return message.entry_count != 0 && rest == 0;
}

[[gnu::hot]] bool read_message(std::span<const std::byte> bytes, const Limits& limits,
                               bool standard_strings, Message& message, const char** what) {
  message.strings.reset(standard_strings);
  Entry first;
  const char* wrong =
      codec::check_message(bytes, limits, codec::UnknownCode::refuse, message, first);
  if (wrong != nullptr && what != nullptr) *what = wrong;
  return wrong == nullptr;
}

[[gnu::hot]] bool read_message(std::span<const std::byte> bytes, const Limits& limits,
                               bool standard_strings, Message& message, Entry& first,
                               void (*progress)()) {
  message.strings.reset(standard_strings);
  return codec::check_message(bytes, limits, codec::UnknownCode::refuse, message, first,
                              progress) == nullptr;
}

bool EntryReader::next(Entry& entry) {
  if (left_ == 0) return false;
  codec::Cursor cursor{at_, end_};
  // Accepted once by read_message; a failure would mean that the bytes have changed since.
  if (codec::parse_entry<codec::UnknownCode::refuse>(message_->version, cursor, &message_->strings,
                                                     entry) != nullptr) {
    left_ = 0;
    return false;
  }
  at_ = cursor.at;
  --left_;
  return true;
}

}  // namespace rr
