// SPDX-License-Identifier: Apache-2.0
#include "rr/writer.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <utility>

#include "runtime/cpp/src/codec/back.hpp"
#include "runtime/cpp/src/codec/exact.hpp"
#include "runtime/cpp/src/codec/flags.hpp"

namespace rr {
namespace {

using codec::Back;

constexpr std::size_t longest_text = 65535;
constexpr std::size_t longest_message = std::numeric_limits<std::uint32_t>::max();
constexpr std::size_t first_buffer = 1024;
// Of a buffer, for the next message: most threads have a writer, and a node many threads.
constexpr std::size_t most_kept = std::size_t{256} * 1024;
// Room for the fields of a header that are not texts or extended bytes, in either format.
constexpr std::size_t element_fields = 40;
constexpr std::size_t entry_fields = 48;
constexpr std::size_t message_fields = 96;

constexpr const char* too_long = "text over 65,535 bytes, or message over 4 GiB";

constexpr bool fits(std::string_view text) { return text.size() <= longest_text; }

// A number as format 2 spells it.
struct Decimal {
  std::array<char, 12> digits;
  std::string_view text;

  explicit Decimal(std::int32_t number) {
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    text = {digits.data(), static_cast<std::size_t>(end - digits.data())};
  }
};

}  // namespace

Writer::Writer() = default;
Writer::~Writer() = default;

[[gnu::hot]] void Writer::reset(MessageVersion version) {
  if (capacity() > most_kept) {
    last_large_ = capacity();
    buffer_ = {};
    end_ = nullptr;
  }
  begin_ = end_;
  attached_bytes_ = 0;
  attaches_texts_ = false;
  attachments_.clear();
  version_ = version;
  clear();
}

void Writer::release() {
  if (capacity() > most_kept) reset(version_);
}

void Writer::grow(std::size_t size) {
  const std::size_t kept = used();
  std::size_t larger = std::max({first_buffer, capacity() * 2, kept + size});
  // Large messages often follow one of the same size.
  if (larger > most_kept) larger = std::max(larger, std::exchange(last_large_, 0));
  Allocation buffer = allocate(larger);
  std::byte* const end = buffer.bytes + larger;
  if (kept != 0) std::memcpy(end - kept, begin_, kept);
  buffer_ = std::move(buffer);
  end_ = end;
  begin_ = end - kept;
}

[[gnu::hot]] void Writer::prepend_array(std::span<const std::byte> data, const MemoryRef& owner) {
  if (data.size() < attach_threshold) {
    prepend_bytes(data.data(), data.size());
    return;
  }
  attachments_.push_back({data, owner, used()});
  attached_bytes_ += data.size();
}

[[gnu::hot]] void Writer::element(const ElementName& name, ElementType type,
                                  std::string_view type_name, std::uint32_t count,
                                  std::size_t end) {
  if (version_ == MessageVersion::v2) {
    element_v2(name, type, type_name, {}, count, end);
    return;
  }
  // Texts of elements are longer here than in format 2, which spells their size in two bytes.
  const std::size_t texts = name.text.size() + type_name.size();
  const std::size_t payload = position() - end;
  if (texts > longest_message - element_fields ||
      payload > longest_message - texts - element_fields) {
    fail(ErrorCode::protocol_error, too_long, name.text);
    return;
  }
  Back back{reserve(element_fields + texts)};
  const std::byte* const behind = back.at;
  std::uint8_t flags = 0;
  back.uint_x(count);
  if (!type_name.empty()) {
    back.xstring(type_name);
    flags = codec::element_flag::type_name_text;
  }
  back.number(static_cast<std::uint16_t>(type));
  if (name.is_number) {
    back.int_x(name.number);
    flags |= codec::element_flag::number;
  } else {
    back.xstring(name.text);
    flags |= codec::element_flag::name_text;
  }
  back.u8(flags);
  back.own_size(static_cast<std::uint32_t>(payload + static_cast<std::size_t>(behind - back.at)));
  commit(back.at);
}

[[gnu::hot]] void Writer::element(const ElementName& name, ElementType type,
                                  std::string_view type_name, std::string_view metadata,
                                  std::span<const std::byte> extended, std::uint32_t count,
                                  std::size_t end) {
  if (version_ == MessageVersion::v2) {
    element_v2(name, type, type_name, metadata, count, end);
    return;
  }
  const std::size_t texts = name.text.size() + type_name.size() + metadata.size();
  if (texts > longest_message - element_fields) {
    fail(ErrorCode::protocol_error, too_long, name.text);
    return;
  }
  Element element;
  element.name = name.text;
  element.number = name.number;
  element.type = type;
  element.type_name = type_name;
  element.metadata = metadata;
  element.extended = extended;
  element.count = count;
  element.flags = name.is_number ? codec::element_flag::number : codec::element_flag::name_text;
  if (!type_name.empty()) element.flags |= codec::element_flag::type_name_text;
  if (!metadata.empty()) element.flags |= codec::element_flag::metadata;
  if (!extended.empty()) element.flags |= codec::element_flag::extended;
  codec::write_element_header(*this, element, end);
}

void Writer::element_v2(const ElementName& name, ElementType type, std::string_view type_name,
                        std::string_view metadata, std::uint32_t count, std::size_t end) {
  const std::size_t texts = name.text.size() + type_name.size() + metadata.size();
  const std::size_t payload = position() - end;
  if (!fits(name.text) || !fits(type_name) || !fits(metadata) ||
      payload > longest_message - texts - element_fields) {
    fail(ErrorCode::protocol_error, too_long, name.text);
    return;
  }
  Back back{reserve(element_fields + texts)};
  const std::byte* const behind = back.at;
  back.number(count);
  back.string16(metadata);
  back.string16(type_name);
  back.number(static_cast<std::uint16_t>(type));
  if (name.is_number) {
    back.string16(Decimal(name.number).text);
  } else {
    back.string16(name.text);
  }
  const auto header = static_cast<std::size_t>(behind - back.at) + sizeof(std::uint32_t);
  back.number(static_cast<std::uint32_t>(payload + header));
  commit(back.at);
}

[[gnu::hot]] void Writer::string_element(const ElementName& name, std::string_view text) {
  const std::size_t end = position();
  if (text.size() > longest_message) {
    fail(ErrorCode::protocol_error, too_long, name.text);
    return;
  }
  if (attaches_texts_) {
    prepend_array(std::as_bytes(std::span(text)), MemoryRef());
  } else {
    prepend_bytes(text.data(), text.size());
  }
  element(name, ElementType::string, {}, static_cast<std::uint32_t>(text.size()), end);
}

[[gnu::hot]] void Writer::entry(const EntryHeader& header, std::uint32_t element_count,
                                std::size_t end) {
  const std::size_t texts =
      header.service_path.size() + header.member.size() + header.metadata.size();
  const std::size_t elements = position() - end;
  if (!fits(header.service_path) || !fits(header.member) || !fits(header.metadata) ||
      elements > longest_message - texts - entry_fields) {
    fail(ErrorCode::protocol_error, too_long, header.member);
    return;
  }
  reserve(entry_fields + texts);
  if (version_ == MessageVersion::v2) {
    entry_v2(header, element_count, elements);
  } else {
    entry_v4(header, element_count, elements);
  }
}

void Writer::entry_v2(const EntryHeader& header, std::uint32_t element_count,
                      std::size_t elements) {
  if (element_count > 0xFFFF) {
    fail(ErrorCode::protocol_error, "more than 65,535 elements", header.member);
    return;
  }
  Back back{begin_};
  const std::byte* const behind = back.at;
  back.number(static_cast<std::uint16_t>(element_count));
  back.string16(header.metadata);
  back.number(header.error);
  back.number(header.request_id);
  back.string16(header.member);
  back.string16(header.service_path);
  back.number(std::uint16_t{0});
  back.number(static_cast<std::uint16_t>(header.type));
  const auto own = static_cast<std::size_t>(behind - back.at) + sizeof(std::uint32_t);
  back.number(static_cast<std::uint32_t>(elements + own));
  commit(back.at);
}

[[gnu::hot]] void Writer::entry_v4(const EntryHeader& header, std::uint32_t element_count,
                                   std::size_t elements) {
  // Path and member are always there, even when empty (02, section 3).
  std::uint8_t flags = codec::entry_flag::path_text | codec::entry_flag::member_text;
  Back back{begin_};
  const std::byte* const behind = back.at;
  back.uint_x(element_count);
  if (!header.metadata.empty()) {
    back.xstring(header.metadata);
    flags |= codec::entry_flag::metadata;
  }
  if (header.error != 0) {
    back.number(header.error);
    flags |= codec::entry_flag::error;
  }
  if (header.request_id != 0) {
    back.uint_x(header.request_id);
    flags |= codec::entry_flag::request_id;
  }
  back.xstring(header.member);
  back.xstring(header.service_path);
  back.number(static_cast<std::uint16_t>(header.type));
  back.u8(flags);
  back.own_size(static_cast<std::uint32_t>(elements + static_cast<std::size_t>(behind - back.at)));
  commit(back.at);
}

[[gnu::hot]] void Writer::message(const MessageHeader& header, std::uint32_t entry_count) {
  const std::size_t texts =
      header.sender_name.size() + header.receiver_name.size() + header.metadata.size();
  if (!fits(header.sender_name) || !fits(header.receiver_name) || !fits(header.metadata) ||
      entry_count > 0xFFFF || position() > longest_message - texts - message_fields) {
    fail(ErrorCode::protocol_error, "text over 65,535 bytes, or too many entries");
    return;
  }
  if (version_ == MessageVersion::v2) {
    message_v2(header, entry_count);
  } else {
    message_v4(header, entry_count);
  }
}

namespace {

constexpr std::array<char, 4> magic = {'R', 'R', 'A', 'C'};

}  // namespace

void Writer::message_v2(const MessageHeader& header, std::uint32_t entry_count) {
  const std::size_t texts =
      header.sender_name.size() + header.receiver_name.size() + header.metadata.size();
  constexpr std::size_t header_without_texts = 64;
  if (texts > 0xFFFF - header_without_texts) {  // HeaderSize is a u16
    fail(ErrorCode::protocol_error, "message header over 65,535 bytes");
    return;
  }
  Back back{reserve(message_fields + texts)};
  back.number(header.message_res_id);
  back.number(header.message_id);
  back.number(static_cast<std::uint16_t>(entry_count));
  back.string16(header.metadata);
  back.string16(header.receiver_name);
  back.string16(header.sender_name);
  back.number(header.receiver_endpoint);
  back.number(header.sender_endpoint);
  back.number(header.receiver_node.bytes);
  back.number(header.sender_node.bytes);
  back.number(static_cast<std::uint16_t>(header_without_texts + texts));
  back.number(std::uint16_t{2});
  back.number(static_cast<std::uint32_t>(position() + header_without_texts + texts));
  back.number(magic);
  commit(back.at);
}

[[gnu::hot]] void Writer::message_v4(const MessageHeader& header, std::uint32_t entry_count) {
  Back back{reserve(message_fields + header.sender_name.size() + header.receiver_name.size() +
                    header.metadata.size())};
  const std::byte* const behind = back.at;
  std::uint8_t flags = 0;
  if (entry_count != 1) {
    back.uint_x(entry_count);
    flags |= codec::message_flag::multiple_entries;
  }
  if (!header.metadata.empty() || header.message_id != 0 || header.message_res_id != 0) {
    back.number(header.message_res_id);
    back.number(header.message_id);
    back.xstring(header.metadata);
    flags |= codec::message_flag::meta;
  }
  if (header.routing) {
    back.uint_x(header.receiver_endpoint);
    back.uint_x(header.sender_endpoint);
    back.xstring(header.receiver_name);
    back.xstring(header.sender_name);
    back.number(header.receiver_node.bytes);
    back.number(header.sender_node.bytes);
    flags |= codec::message_flag::routing | codec::message_flag::endpoints;
  }
  back.u8(flags);
  constexpr std::size_t before_size = 10;  // magic, message size, version
  const auto others = static_cast<std::size_t>(behind - back.at) + before_size;
  back.own_size(static_cast<std::uint32_t>(others));
  back.number(std::uint16_t{4});
  const auto written = static_cast<std::size_t>(behind - back.at) + 8;
  back.number(static_cast<std::uint32_t>(position() + written));
  back.number(magic);
  commit(back.at);
}

[[gnu::hot]] std::span<const Piece> Writer::pieces() {
  pieces_.clear();
  const std::byte* at = begin_;
  const auto add_until = [&](const std::byte* stop) {
    if (stop != at) pieces_.push_back({at, static_cast<std::size_t>(stop - at)});
    at = stop;
  };
  for (auto attachment = attachments_.rbegin(); attachment != attachments_.rend(); ++attachment) {
    add_until(end_ - attachment->position);
    pieces_.push_back({attachment->data.data(), attachment->data.size(), true});
  }
  add_until(end_);
  return pieces_;
}

MemoryRef Writer::owner(const Piece& piece) const {
  for (const Attachment& attachment : attachments_) {
    if (attachment.data.data() == piece.data) return attachment.owner;
  }
  return {};
}

std::vector<std::byte> Writer::copy() {
  std::vector<std::byte> bytes;
  bytes.reserve(size());
  for (const Piece& piece : pieces()) {
    bytes.insert(bytes.end(), piece.data, piece.data + piece.size);
  }
  return bytes;
}

}  // namespace rr
