// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/latch.hpp"
#include "rr/node_id.hpp"
#include "rr/visibility.hpp"
#include "rr/wire.hpp"

namespace RR_VISIBLE rr {

/// How an element is called: a name, or a number (list items, int32 keys, pod items), which format
/// 2 spells as decimal text.
struct ElementName {
  std::string_view text;    ///< empty for a number
  std::int32_t number = 0;  ///< the number
  bool is_number = false;   ///< whether it is called by its number

  /// Called by a name, which must stay while the element is written.
  constexpr ElementName(std::string_view name) : text(name) {}  // NOLINT: a name is its text
  /// Called by a name.
  constexpr ElementName(const char* name) : text(name) {}  // NOLINT
  /// Called by a name, which must stay while the element is written.
  constexpr ElementName(const std::string& name) : text(name) {}  // NOLINT
  /// Called by a number.
  constexpr explicit ElementName(std::int32_t index) : number(index), is_number(true) {}
};

/// The bytes of a format 4 element that holds one number, all but the number itself: size, flags,
/// name, type, count. Known when a definition is compiled, so that writing a field is one copy and
/// reading it one comparison. Right-aligned in the block, because messages are written backwards.
struct ScalarPrefix {
  /// Room in the block, in bytes.
  static constexpr std::size_t capacity = 32;
  /// The prefix, at the end of the block.
  std::array<std::byte, capacity> bytes{};
  std::uint8_t length = 0;  ///< 0: the name is too long, use the general path

  /// No prefix: the general path is used.
  consteval ScalarPrefix() = default;
  /// Source: 02, section 4.
  consteval ScalarPrefix(std::string_view name, ElementType type) {
    const std::size_t total = 1 + 1 + 1 + name.size() + 2 + 1;
    if (total > capacity || item_size(type) == 0) return;
    length = static_cast<std::uint8_t>(total);
    std::size_t at = capacity - total;
    const auto put = [&](std::size_t value) { bytes[at++] = static_cast<std::byte>(value); };
    put(total + item_size(type));
    put(0x01);
    put(name.size());
    for (const char c : name) put(static_cast<unsigned char>(c));
    put(static_cast<std::size_t>(type) & 0xFF);
    put(static_cast<std::size_t>(type) >> 8);
    put(1);
  }

  /// Whether `data`, of at least `length` bytes, starts with the prefix.
  [[nodiscard]] bool starts(const std::byte* data) const {
    return length != 0 && same(data, bytes.data() + (capacity - length), length);
  }
  /// The same, whatever the size and the count are.
  [[nodiscard]] bool starts_packed(const std::byte* data) const {
    return length != 0 &&
           same(data + 1, bytes.data() + (capacity - length) + 1, std::size_t{length} - 2);
  }

 private:
  // Word by word, since a call of memcmp costs more than this. `size` is 5 to 32.
  static bool same(const std::byte* a, const std::byte* b, std::size_t size) {
    const auto word = [](const std::byte* from, auto value) {
      std::memcpy(&value, from, sizeof value);
      return value;
    };
    if (size < 8) {
      return word(a, 0U) == word(b, 0U) && word(a + size - 4, 0U) == word(b + size - 4, 0U);
    }
    constexpr std::uint64_t wide = 0;
    if (size > 16) {
      if (word(a, wide) != word(b, wide) || word(a + 8, wide) != word(b + 8, wide)) return false;
      if (size > 24 && word(a + 16, wide) != word(b + 16, wide)) return false;
    }
    return word(a, wide) == word(b, wide) && word(a + size - 8, wide) == word(b + size - 8, wide);
  }
};

/// Fields of an entry in both formats (01 section 3, 02 section 3).
struct EntryHeader {
  EntryType type = EntryType::null;  ///< which request, answer or packet
  std::string_view service_path{};   ///< of the object
  std::string_view member{};         ///< its name; empty where there is none
  std::uint32_t request_id = 0;      ///< which request an answer is for
  std::uint16_t error = 0;           ///< an ErrorCode; 0: none
  std::string_view metadata{};       ///< mostly empty
};

/// Fields of a message header in both formats. `routing` false leaves ids, names and endpoints out
/// of a format 4 header (02, section 7).
struct MessageHeader {
  NodeId sender_node{};                 ///< the sender's id
  NodeId receiver_node{};               ///< zero for any
  std::string_view sender_name{};       ///< empty for none
  std::string_view receiver_name{};     ///< empty for any
  std::uint32_t sender_endpoint = 0;    ///< number of the session's end at the sender
  std::uint32_t receiver_endpoint = 0;  ///< the same at the receiver
  std::string_view metadata{};          ///< mostly empty
  std::uint16_t message_id = 0;         ///< counts the messages of a sender
  std::uint16_t message_res_id = 0;     ///< which message this one answers; 0: none
  bool routing = true;                  ///< whether ids, names and endpoints are there
};

/// A piece of a finished message, in sending order.
struct Piece {
  const std::byte* data = nullptr;  ///< the first byte
  std::size_t size = 0;             ///< bytes
  bool is_attached = false;         ///< one large payload, and nothing else
};

/// Builds one message, last byte first. Sizes stand in front of what they measure, and in format 4
/// their own length depends on it; written backwards, every size is known when it is needed, so
/// one pass without a second buffer is enough. Elements are therefore written in reverse order,
/// each one's payload before its header:
///
///   const auto end = writer.position();
///   writer.prepend_bytes(&x, sizeof x);
///   writer.element("x", ElementType::double_, {}, 1, end);
///   writer.entry(header, 1, end);
///   writer.message(header, 1);
///
/// Large arrays are attached, not copied. Never throws for what it is given: the first thing that
/// cannot be written (a name over 65,535 bytes) is latched, and the message is not to be sent.
/// The buffer is kept between messages, so that a steady stream of them allocates nothing.
class Writer : public Latch {
 public:
  /// Payloads at least this large are gathered instead of copied.
  static constexpr std::size_t attach_threshold = 16 * 1024;

  /// An empty writer. It allocates with the first message.
  Writer();
  ~Writer();
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  /// Forgets what was written, keeps the buffer.
  void reset(MessageVersion version);
  /// The version that reset() has chosen.
  [[nodiscard]] MessageVersion version() const { return version_; }

  /// When the message has been sent, and nothing of it is needed any more: a large buffer goes.
  void release();
  /// Until reset(): what is written stays until the message has been sent, texts too, so that large
  /// ones need not be copied.
  void attach_texts() { attaches_texts_ = true; }

  /// Bytes written so far: a mark to measure from.
  [[nodiscard]] std::size_t position() const { return attached_bytes_ + used(); }

  /// Makes room for `size` bytes before everything written so far; the caller fills them.
  std::byte* prepend(std::size_t size) {
    if (size > room()) grow(size);
    begin_ -= size;
    return begin_;
  }
  /// Copies bytes before everything written so far.
  void prepend_bytes(const void* data, std::size_t size) {
    if (size != 0) std::memcpy(prepend(size), data, size);
  }
  /// Makes room for up to `size` bytes and returns where they end: the caller writes backwards from
  /// there, any number of them, and hands the front to commit() before it calls anything else.
  std::byte* reserve(std::size_t size) {
    if (size > room()) grow(size);
    return begin_;
  }
  /// What was written since reserve() begins here.
  void commit(std::byte* begin) { begin_ = begin; }
  /// Copies, or for large data keeps a reference: with an owner the data is kept alive by it,
  /// without one it must stay until the message has been sent, or reset().
  void prepend_array(std::span<const std::byte> data, const MemoryRef& owner);

  /// A whole element of one number in format 4 by its prepared prefix.
  template <class T>
  void prepend_scalar(const ScalarPrefix& prefix, T value) {
    if (ScalarPrefix::capacity + sizeof value > room()) grow(ScalarPrefix::capacity + sizeof value);
    begin_ -= sizeof value;
    std::memcpy(begin_, &value, sizeof value);
    std::memcpy(begin_ - ScalarPrefix::capacity, prefix.bytes.data(), ScalarPrefix::capacity);
    begin_ -= prefix.length;
  }

  /// Puts the header in front of an element whose payload was written since position() was `end`.
  void element(const ElementName& name, ElementType type, std::string_view type_name,
               std::uint32_t count, std::size_t end);
  /// The same with metadata and extended bytes (format 4), as a capture may have them.
  void element(const ElementName& name, ElementType type, std::string_view type_name,
               std::string_view metadata, std::span<const std::byte> extended, std::uint32_t count,
               std::size_t end);
  /// An element that is null.
  void null_element(const ElementName& name) {
    element(name, ElementType::void_, {}, 0, position());
  }
  /// A string element.
  void string_element(const ElementName& name, std::string_view text);

  /// Puts the header in front of an entry whose elements were written since position() was `end`.
  void entry(const EntryHeader& header, std::uint32_t element_count, std::size_t end);
  /// As Latch::message(): why writing has failed.
  using Latch::message;
  /// Puts the message header in front of all entries. The message is complete.
  void message(const MessageHeader& header, std::uint32_t entry_count);

  /// The finished message in sending order; valid until reset().
  std::span<const Piece> pieces();
  /// What keeps one of these pieces alive by itself; empty for what the writer holds and for
  /// borrowed arrays.
  [[nodiscard]] MemoryRef owner(const Piece& piece) const;
  /// Total bytes.
  [[nodiscard]] std::size_t size() const { return position(); }
  /// One contiguous copy, for tests, queues and transcoding.
  [[nodiscard]] std::vector<std::byte> copy();

 private:
  struct Attachment {
    std::span<const std::byte> data;
    MemoryRef owner;
    std::size_t position = 0;  ///< bytes in the buffer behind it
  };

  [[nodiscard]] std::size_t used() const { return static_cast<std::size_t>(end_ - begin_); }
  [[nodiscard]] std::size_t room() const {
    return static_cast<std::size_t>(begin_ - buffer_.bytes);
  }
  [[nodiscard]] std::size_t capacity() const {
    return static_cast<std::size_t>(end_ - buffer_.bytes);
  }
  void grow(std::size_t size);
  void element_v2(const ElementName& name, ElementType type, std::string_view type_name,
                  std::string_view metadata, std::uint32_t count, std::size_t end);
  void entry_v2(const EntryHeader& header, std::uint32_t element_count, std::size_t elements);
  void entry_v4(const EntryHeader& header, std::uint32_t element_count, std::size_t elements);
  void message_v2(const MessageHeader& header, std::uint32_t entry_count);
  void message_v4(const MessageHeader& header, std::uint32_t entry_count);

  Allocation buffer_;
  std::byte* begin_ = nullptr;
  std::byte* end_ = nullptr;
  std::size_t last_large_ = 0;  // capacity of a buffer that was too large to keep
  std::size_t attached_bytes_ = 0;
  bool attaches_texts_ = false;
  std::vector<Attachment> attachments_;
  std::vector<Piece> pieces_;
  MessageVersion version_ = MessageVersion::v4;
};

}  // namespace rr
