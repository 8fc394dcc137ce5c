// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <unordered_map>

#include "runtime/cpp/src/codec/exact.hpp"
#include "runtime/cpp/src/codec/parse.hpp"

namespace rr {
namespace {

using codec::StringCode;

constexpr std::size_t uint_x_size(std::size_t value) {
  return value < 253 ? 1 : value <= 0xFFFF ? 3 : 5;
}

// Gives texts their codes, in the order in which they come. Source: 02, section 6.2.
class Codes {
 public:
  Codes(bool local, bool standard) : local_(local), standard_(standard) {}

  // Swaps the flag of a text for that of a code, where there is one.
  void replace(std::string_view text, std::uint8_t text_flag, std::uint8_t code_flag,
               std::uint8_t& flags, std::uint32_t& code) {
    if ((flags & text_flag) == 0 || (flags & code_flag) != 0 || text.size() > longest_text) return;
    const auto found = code_of(text);
    if (!found) return;
    code = *found;
    flags = static_cast<std::uint8_t>((flags & ~text_flag) | code_flag);
  }

  // The message's own strings, the newest first, as the reference mostly writes them.
  std::vector<StringCode> own() && {
    std::reverse(own_.begin(), own_.end());
    return std::move(own_);
  }

 private:
  static constexpr std::size_t longest_text = 128;
  static constexpr std::size_t table_bytes = 1024;

  std::optional<std::uint32_t> code_of(std::string_view text) {
    if (standard_) {
      if (const auto code = standard_code(text)) return code;
    }
    if (!local_) return std::nullopt;
    if (const auto known = codes_.find(text); known != codes_.end()) return known->second;
    const auto code = static_cast<std::uint32_t>(2 * own_.size() + 1);
    const std::size_t size = uint_x_size(code) + uint_x_size(text.size()) + text.size();
    if (bytes_ + size > table_bytes || own_.size() == StringTable::capacity) return std::nullopt;
    bytes_ += size;
    own_.push_back({code, text});
    codes_.emplace(text, code);
    return code;
  }

  bool local_;
  bool standard_;
  std::size_t bytes_ = 0;
  std::vector<StringCode> own_;
  std::unordered_map<std::string_view, std::uint32_t> codes_;
};

// An element in the order of the bytes, with where those nested in it end.
struct Item {
  Element element;
  std::size_t behind_nested = 0;  // index of the first item that is not nested in it
  std::size_t end = 0;            // position of the writer before the item
};

void collect(Decoder& decoder, std::span<const std::byte> bytes, std::uint32_t count, Codes& codes,
             std::vector<Item>& items) {
  namespace flag = codec::element_flag;
  ElementReader reader(decoder, bytes, count);
  Element element;
  while (reader.next(element)) {
    codes.replace(element.name, flag::name_text, flag::name_code, element.flags, element.name_code);
    codes.replace(element.type_name, flag::type_name_text, flag::type_name_code, element.flags,
                  element.type_name_code);
    const std::size_t index = items.size();
    items.push_back({.element = element});
    if (is_nested(element.type)) collect(decoder, element.payload, element.count, codes, items);
    items[index].behind_nested = items.size();
  }
}

// The reverse of the order of the bytes is the order in which a Writer wants them: all that is
// nested in an element, last first, then its header.
void write_items(Writer& writer, std::span<Item> items) {
  for (std::size_t left = items.size(); left != 0; --left) {
    const std::size_t index = left - 1;
    Item& item = items[index];
    item.end = writer.position();
    if (is_nested(item.element.type)) {
      const bool empty = item.behind_nested == left;
      codec::write_element_header(writer, item.element,
                                  empty ? item.end : items[item.behind_nested - 1].end);
    } else {
      writer.prepend_array(item.element.payload, {});
      codec::write_element_header(writer, item.element, item.end);
    }
  }
}

}  // namespace

std::vector<std::byte> apply_string_table(std::span<const std::byte> message, bool local,
                                          bool standard) {
  Message header;
  Limits limits;
  limits.message_size = UINT32_MAX;
  std::vector<std::byte> unchanged(message.begin(), message.end());
  if (!read_message(message, limits, standard, header, nullptr)) return unchanged;
  if (header.version != MessageVersion::v4) return unchanged;
  if ((header.flags & codec::message_flag::string_table) != 0) return unchanged;

  namespace flag = codec::entry_flag;
  Codes codes(local, standard);
  Decoder decoder(header.version, &header.strings);
  std::vector<Entry> entries;
  std::vector<std::vector<Item>> elements;
  EntryReader reader(header);
  for (Entry entry; reader.next(entry);) {
    codes.replace(entry.member, flag::member_text, flag::member_code, entry.flags,
                  entry.member_code);
    codes.replace(entry.service_path, flag::path_text, flag::path_code, entry.flags,
                  entry.service_path_code);
    collect(decoder, entry.elements, entry.element_count, codes, elements.emplace_back());
    entries.push_back(entry);
  }

  Writer writer;
  writer.reset(MessageVersion::v4);
  while (!entries.empty()) {
    const std::size_t end = writer.position();
    write_items(writer, elements.back());
    codec::write_entry_header(writer, entries.back(), end);
    entries.pop_back();
    elements.pop_back();
  }
  const std::vector<StringCode> own = std::move(codes).own();
  if (!own.empty()) header.flags |= codec::message_flag::string_table;
  codec::write_message_header(writer, header, own);
  return writer.copy();
}

}  // namespace rr
