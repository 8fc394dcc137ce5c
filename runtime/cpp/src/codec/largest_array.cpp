// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/codec/parse.hpp"

namespace rr {
namespace {

using codec::Cursor;

// In the order of the bytes an element's header is followed by its first nested element, and a
// packed payload by whatever element comes next at any depth: a walk needs no stack.
class Search {
 public:
  Search(const Message& message, const std::byte* begin, std::span<const std::byte> begun,
         std::size_t whole)
      : version_(message.version),
        begin_(begin),
        whole_(whole),
        in_{message.entries.data(), begun.data() + begun.size()} {}

  std::size_t run(std::uint32_t entries) {
    for (std::uint32_t i = 0; i < entries; ++i) {
      const std::byte* const entry = in_.at;
      std::uint32_t size = 0;
      if (!entry_header(size)) break;
      // Entries over the end of the message cannot be right.
      if (size > whole_ - offset(entry)) break;
      const std::size_t end = offset(entry) + size;
      while (offset(in_.at) < end) {
        if (!element()) return found_;
      }
    }
    return found_;
  }

 private:
  [[nodiscard]] std::size_t offset(const std::byte* at) const {
    return static_cast<std::size_t>(at - begin_);
  }

  bool skip_text() {
    std::string_view text;
    return version_ == MessageVersion::v2 ? in_.string16(text) : in_.xstring(text);
  }

  bool skip_fields(std::uint8_t flags, std::uint8_t text, std::uint8_t code) {
    std::uint32_t ignored = 0;
    return ((flags & text) == 0 || skip_text()) && ((flags & code) == 0 || in_.uint_x(ignored));
  }

  bool entry_header(std::uint32_t& size) {
    std::span<const std::byte> skipped;
    if (version_ == MessageVersion::v2) {
      return in_.number(size) && in_.bytes(4, skipped) && skip_text() && skip_text() &&
             in_.bytes(6, skipped) && skip_text() && in_.bytes(2, skipped);
    }
    namespace flag = codec::entry_flag;
    std::uint8_t flags = 0;
    std::uint32_t number = 0;
    return in_.uint_x(size) && in_.number(flags) && in_.bytes(2, skipped) &&
           skip_fields(flags, flag::path_text, flag::path_code) &&
           skip_fields(flags, flag::member_text, flag::member_code) &&
           ((flags & flag::request_id) == 0 || in_.uint_x(number)) &&
           ((flags & flag::error) == 0 || in_.bytes(2, skipped)) &&
           ((flags & flag::metadata) == 0 || skip_text()) &&
           ((flags & flag::extended) == 0 || in_.xbytes(skipped)) && in_.uint_x(number);
  }

  bool element_header(std::uint16_t& type, std::uint32_t& count) {
    if (version_ == MessageVersion::v2) {
      std::uint32_t size = 0;
      return in_.number(size) && skip_text() && in_.number(type) && skip_text() && skip_text() &&
             in_.number(count);
    }
    namespace flag = codec::element_flag;
    std::uint32_t size = 0;
    std::uint8_t flags = 0;
    std::int32_t number = 0;
    std::span<const std::byte> skipped;
    return in_.uint_x(size) && in_.number(flags) &&
           skip_fields(flags, flag::name_text, flag::name_code) &&
           ((flags & flag::number) == 0 || in_.int_x(number)) && in_.number(type) &&
           skip_fields(flags, flag::type_name_text, flag::type_name_code) &&
           ((flags & flag::metadata) == 0 || skip_text()) &&
           ((flags & flag::extended) == 0 || in_.xbytes(skipped)) && in_.uint_x(count);
  }

  // False where the begun bytes end, or make no sense.
  bool element() {
    std::uint16_t type = 0;
    std::uint32_t count = 0;
    if (!element_header(type, count)) return false;
    if (type >= codec::payload_kinds.size()) return false;
    const std::uint8_t kind = codec::payload_kinds[type];
    if (kind >= codec::nested_kind) return kind == codec::nested_kind;
    const std::uint64_t size = std::uint64_t{count} * kind;
    if (size > whole_ - offset(in_.at)) return false;
    if (kind > 1 && size > largest_) {
      largest_ = size;
      found_ = offset(in_.at);
    }
    if (size > in_.left()) return false;
    in_.at += size;
    return true;
  }

  MessageVersion version_;
  const std::byte* begin_;
  std::size_t whole_;
  Cursor in_;
  std::uint64_t largest_ = 0;
  std::size_t found_ = 0;
};

}  // namespace

std::size_t largest_array_offset(std::span<const std::byte> begun, std::size_t whole) {
  Message message;
  message.strings.reset(false);
  if (codec::parse_begun_header(begun, whole, message) != nullptr) return 0;
  return Search(message, begun.data(), begun, whole).run(message.entry_count);
}

}  // namespace rr
