// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/buffer.hpp"
#include "rr/latch.hpp"
#include "rr/visibility.hpp"
#include "rr/writer.hpp"

/// Reading messages without allocating: everything here is a view of the received bytes.
namespace RR_VISIBLE rr {

class TypeRegistry;

/// The strings that format 4 codes stand for in one message: the message's own table, and the
/// standard one when the connection agreed on it (02, section 6).
class StringTable {
 public:
  /// At most this many strings of its own may a message bring; one with more is refused. Writers
  /// stop at 1,024 bytes, which hold fewer.
  static constexpr std::size_t capacity = 256;

  /// A table without strings, and without the standard codes. Not defaulted: value-initialization
  /// would clear the 4 kB of entries for every message.
  StringTable() {}  // NOLINT(modernize-use-equals-default)
  /// Uses the standard codes too.
  explicit StringTable(bool standard) : standard_(standard) {}
  /// Copies the strings' places, not the texts: both tables view the same message.
  StringTable(const StringTable& other) { *this = other; }
  /// Copies the strings' places, not the texts: both tables view the same message.
  StringTable& operator=(const StringTable& other);
  ~StringTable() = default;

  /// Forgets the message's own strings.
  void reset(bool standard) {
    size_ = 0;
    standard_ = standard;
  }
  /// False when the table is full or the code is even. The first text of a code stays.
  bool add(std::uint32_t code, std::string_view text);
  /// Nothing for an unknown code.
  [[nodiscard]] std::optional<std::string_view> find(std::uint32_t code) const;

 private:
  struct Entry {
    std::uint32_t code;
    std::uint32_t size;
    const char* text;
  };
  std::size_t size_ = 0;
  bool standard_ = false;
  Entry entries_[capacity];  // by ascending code; left uninitialized, as most messages have none
};

/// The text of a standard code, or nothing (02, section 6.3).
std::optional<std::string_view> standard_string(std::uint32_t code);
/// The lowest standard code of a text, or nothing.
std::optional<std::uint32_t> standard_code(std::string_view text);

/// One element as it lies in the message.
struct Element {
  std::string_view name;    ///< empty for a numbered element of format 4
  std::int32_t number = 0;  ///< with has_number: place in a list, or key of an int32 map
  bool has_name = false;    ///< whether it has a name
  bool has_number = false;  ///< format 4 only
  ElementType type = ElementType::void_;  ///< what it is
  std::string_view type_name;             ///< qualified, of structs, pods and namedarrays
  std::string_view metadata;              ///< mostly empty
  std::span<const std::byte> extended;    ///< what a later version of the format may add
  std::uint32_t count = 0;             ///< items, nested elements, or string bytes; void: anything
  std::span<const std::byte> payload;  ///< packed items, or nested elements back to back
  std::uint8_t flags = 0;              ///< format 4, as received
  std::uint32_t name_code = 0;         ///< with ELEMENT_NAME_CODE
  std::uint32_t type_name_code = 0;    ///< with ELEMENT_TYPE_NAME_CODE

  /// The number, or the name read as a decimal int32; nothing when it is neither.
  [[nodiscard]] std::optional<std::int32_t> index() const;
  /// The payload of a string.
  [[nodiscard]] std::string_view text() const {
    return {reinterpret_cast<const char*>(payload.data()), payload.size()};
  }
};

/// What the memory of decoded lists, maps and structs is taken from.
class ContainerBudget {
 public:
  /// False, and nothing happens, when so many bytes more are too many.
  [[nodiscard]] virtual bool draw(std::size_t bytes) = 0;

 protected:
  ~ContainerBudget() = default;
};

/// Items of an array that are elsewhere than the rest of their message.
struct DisplacedItems {
  std::span<const std::byte> gap{};  ///< in the message, in their place; never looked at
  const std::byte* items = nullptr;  ///< the first byte of as many
};

/// What reading the values of one message has in common, and the first thing that went wrong.
/// Nothing here throws; after a failure everything that is read is empty.
class Decoder : public Latch {
 public:
  /// For elements of one version of the format. `strings` is the message's table, `owner` keeps the
  /// bytes, `types` has the named types of varvalues; each may be empty. What is pointed to must
  /// outlive the decoder.
  explicit Decoder(MessageVersion version, const StringTable* strings = nullptr,
                   MemoryRef owner = {}, const TypeRegistry* types = nullptr)
      : version_(version), strings_(strings), owner_(std::move(owner)), types_(types) {}

  /// The version of the format.
  [[nodiscard]] MessageVersion version() const { return version_; }
  /// The message's table of strings; null for none.
  [[nodiscard]] const StringTable* strings() const { return strings_; }
  /// Keeps the received bytes alive when set; arrays may then be slices of them.
  [[nodiscard]] const MemoryRef& owner() const { return owner_; }
  /// Where named types of a varvalue are found; may be null.
  [[nodiscard]] const TypeRegistry* types() const { return types_; }

  /// Without a budget.
  static constexpr std::size_t container_limit = std::size_t{36} * 1024 * 1024;
  /// Lists, maps and structs may be much larger in memory than on the wire. The items of one
  /// message may take `container_limit` bytes, or what the budget gives. False, with the failure
  /// latched, when `bytes` more are over it.
  bool reserve(std::size_t bytes, std::string_view element) {
    if (bytes <= reserved_) [[likely]] {
      reserved_ -= bytes;
      return true;
    }
    return reserve_more(bytes, element);
  }
  /// Must outlive the decoder. Before anything is read.
  void set_budget(ContainerBudget& budget);
  /// For the runtime: items that are elsewhere, where `owner` keeps them. `displaced` must outlive
  /// the decoder. Before anything is read.
  void set_displaced(std::span<const DisplacedItems> displaced, MemoryRef owner) {
    displaced_ = displaced;
    displaced_owner_ = std::move(owner);
  }
  /// For the runtime: where the payload of an array is.
  struct Located {
    std::span<const std::byte> items;  ///< its bytes
    const MemoryRef* owner;            ///< null: arrays have to be copied
    bool is_displaced;                 ///< another process may change them at any time
  };
  /// For the runtime: as it says.
  [[nodiscard]] Located locate(std::span<const std::byte> payload) const {
    if (!displaced_.empty()) [[unlikely]]
      return locate_displaced(payload);
    return {payload, owner_ ? &owner_ : nullptr, false};
  }
  /// How many bytes of arrays were copied, not sliced, so far.
  [[nodiscard]] std::size_t copied_array_bytes() const { return copied_array_bytes_; }
  /// For the runtime: adds to copied_array_bytes().
  void count_copied_array(std::size_t bytes) { copied_array_bytes_ += bytes; }

 private:
  bool reserve_more(std::size_t bytes, std::string_view element);
  [[nodiscard]] Located locate_displaced(std::span<const std::byte> payload) const;

  MessageVersion version_;
  const StringTable* strings_;
  MemoryRef owner_;
  const TypeRegistry* types_;
  std::size_t reserved_ = container_limit;  // and not used yet
  ContainerBudget* budget_ = nullptr;
  std::size_t copied_array_bytes_ = 0;
  std::span<const DisplacedItems> displaced_;
  MemoryRef displaced_owner_;
};

/// Walks sibling elements. Each call of next() checks that the element's parts lie inside it and it
/// inside its parent; what lies inside a nested payload is checked when that is walked.
class ElementReader {
 public:
  /// Walks `count` elements back to back. The decoder and the bytes must outlive the reader.
  ElementReader(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count)
      : decoder_(&decoder), at_(bytes.data()), end_(bytes.data() + bytes.size()), left_(count) {}
  /// The elements nested in one.
  ElementReader(Decoder& decoder, const Element& parent)
      : ElementReader(decoder, parent.payload, parent.count) {}

  /// False at the end, and on malformed bytes, which fails the decoder (protocol_error).
  bool next(Element& element);

  /// If the next element is exactly `prefix` and one item of `T`, reads it and moves on. Otherwise
  /// nothing happens and the caller takes the general way. Format 4 only.
  template <class T>
  bool match(const ScalarPrefix& prefix, T& value) {
    const std::size_t size = prefix.length + sizeof(T);
    if (left_ == 0 || static_cast<std::size_t>(end_ - at_) < size || !prefix.starts(at_)) {
      return false;
    }
    std::memcpy(&value, at_ + prefix.length, sizeof(T));
    at_ += size;
    --left_;
    return true;
  }

  /// If the next element is like `prefix` but for size and count, and short, gives its items, each
  /// of `item_size` bytes, and moves on. Otherwise nothing happens and the caller takes the general
  /// way. Format 4 only.
  bool match_packed(const ScalarPrefix& prefix, std::size_t item_size,
                    std::span<const std::byte>& items, std::uint32_t& count) {
    const auto room = static_cast<std::size_t>(end_ - at_);
    if (left_ == 0 || room == 0) return false;
    // Sizes and counts of one byte: larger ones have a mark there that does not fit the sum.
    const auto size = std::to_integer<std::size_t>(at_[0]);
    if (size > room || size < prefix.length || size > 252 || !prefix.starts_packed(at_))
      return false;
    count = std::to_integer<std::uint32_t>(at_[prefix.length - 1]);
    if (prefix.length + count * item_size != size) return false;
    items = {at_ + prefix.length, size - prefix.length};
    at_ += size;
    --left_;
    return true;
  }

  /// How many elements are left.
  [[nodiscard]] std::uint32_t left() const { return left_; }
  /// True when all bytes were used up: to be asked after the last element.
  [[nodiscard]] bool at_end() const { return at_ == end_; }

 private:
  bool next_v2(Element& element);
  bool next_v4(Element& element);
  bool stop(const char* wrong);

  Decoder* decoder_;
  const std::byte* at_;
  const std::byte* end_;
  std::uint32_t left_;
};

/// Finds an element by name among siblings, from the start. Used when they are not in the order
/// that is expected. False when there is none; the decoder fails only on malformed bytes.
bool find_element(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count,
                  std::string_view name, Element& element);

/// One entry as it lies in the message.
struct Entry : EntryHeader {
  std::uint8_t flags = 0;               ///< format 4, as received
  std::uint32_t service_path_code = 0;  ///< with its flag: instead of the path
  std::uint32_t member_code = 0;        ///< with its flag: instead of the member
  std::span<const std::byte> extended;  ///< what a later version of the format may add
  std::uint32_t element_count = 0;      ///< of the elements below
  std::span<const std::byte> elements;  ///< back to back
};

/// A whole received message. `routing` says the same as `has_routing`.
struct Message : MessageHeader {
  MessageVersion version = MessageVersion::v2;  ///< of the format
  std::uint8_t flags = 0;                       ///< format 4, as received
  bool has_routing = true;                      ///< ids and names were there (always in format 2)
  bool has_endpoints = true;                    ///< endpoints were there (always in format 2)
  std::uint16_t priority = 0;                   ///< 0 in format 2
  std::span<const std::byte> extended;          ///< what a later version of the format may add
  std::uint32_t string_count = 0;               ///< entries of the message's own string table
  std::span<const std::byte> string_entries;    ///< the same as received, codes and texts
  std::uint32_t entry_count = 0;                ///< of the entries below
  std::span<const std::byte> entries;           ///< back to back
  StringTable strings;                          ///< its own strings, and the standard ones
};

/// No message is shorter (01, section 6).
inline constexpr std::size_t smallest_message = 16;

/// The size that the first 10 bytes of a message announce; 0 when they are no message within the
/// limits (magic, size, version). `bytes` must have at least 10 bytes.
std::size_t message_size(std::span<const std::byte> bytes, const Limits& limits);

/// Whether a message of `whole` bytes can start with `begun`: false as soon as its header or the
/// sizes of its entries contradict that, so that no reader waits for bytes that will not come. True
/// is no promise. Source: 01, section 9.
bool can_be_message(std::span<const std::byte> begun, std::size_t whole);

/// Reads and checks a whole message: every length, every nested element down to the limit of depth,
/// every string code. False, with `*what` (unless null) a literal that says why, when anything does
/// not fit; the connection is then to be closed. A message without entries fails too.
/// `message` views `bytes`. Sources: 01, section 9; 02, section 10.
bool read_message(std::span<const std::byte> bytes, const Limits& limits, bool standard_strings,
                  Message& message, const char** what);
/// The same, with the first entry at hand, which saves reading it again. `progress`, unless null,
/// is called now and then while a message with very many elements is checked.
bool read_message(std::span<const std::byte> bytes, const Limits& limits, bool standard_strings,
                  Message& message, Entry& first, void (*progress)() = nullptr);

/// The check that read_message makes of every element, for elements from elsewhere: `count` of them
/// must fill `bytes` exactly, at all depths. Without it a walk of nested elements has no limit of
/// depth. On failure the decoder fails too.
bool check_elements(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count,
                    const Limits& limits);

/// Walks the entries of a message that read_message accepted.
class EntryReader {
 public:
  /// Walks all entries. The message must outlive the reader.
  explicit EntryReader(const Message& message)
      : message_(&message),
        at_(message.entries.data()),
        end_(message.entries.data() + message.entries.size()),
        left_(message.entry_count) {}
  /// Goes on behind `count` entries, where another reader of the same bytes was at `offset`.
  EntryReader(const Message& message, std::size_t count, std::size_t offset)
      : EntryReader(message) {
    at_ += offset;
    left_ -= static_cast<std::uint32_t>(count);
  }
  /// False at the end.
  bool next(Entry& entry);
  /// Of the next entry, in Message::entries.
  [[nodiscard]] std::size_t offset() const {
    return static_cast<std::size_t>(at_ - message_->entries.data());
  }

 private:
  const Message* message_;
  const std::byte* at_;
  const std::byte* end_;
  std::uint32_t left_;
};

/// Where in a partly received message the payload of its largest array starts, so that the receiver
/// can place its buffer for that payload to be aligned; 0 when no array is in sight. Only arrays
/// whose items are wider than a byte count. A guess: `begun` has not been checked.
std::size_t largest_array_offset(std::span<const std::byte> begun, std::size_t whole);

/// Rewrites a finished format 4 message with a string table: standard codes where `standard`, and
/// the message's own table (at most 1,024 bytes) where `local` (02, section 6.2). Bytes that are no
/// such message, or that have a table already, come back as they are.
std::vector<std::byte> apply_string_table(std::span<const std::byte> message, bool local,
                                          bool standard);

}  // namespace rr
