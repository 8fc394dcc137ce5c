// SPDX-License-Identifier: Apache-2.0
// The only source that sees the TOML library.
#include "compiler/project/toml_file.hpp"

#include <algorithm>
#include <cstdint>

#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace robdef::project {
namespace {

/// Makes byte offsets of the library's lines and columns, which count code points.
class Places {
 public:
  Places(const Source& source, SourceId id) : text_(source.text()), id_(id) {
    starts_.push_back(text_.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
    for (std::size_t at = 0; at < text_.size(); ++at) {
      if (text_[at] == '\n') starts_.push_back(at + 1);
    }
  }

  [[nodiscard]] Span span(const toml::source_region& region) const {
    const std::uint32_t begin = offset(region.begin);
    return {id_, begin, std::max(begin, offset(region.end))};
  }

 private:
  [[nodiscard]] std::uint32_t offset(toml::source_position place) const {
    if (place.line == 0) return 0;
    if (place.line > starts_.size()) return static_cast<std::uint32_t>(text_.size());
    std::size_t at = starts_[place.line - 1];
    for (toml::source_index column = 1; column < place.column && at < text_.size(); ++column) {
      if (text_[at] == '\n') break;
      ++at;
      while (at < text_.size() && (static_cast<unsigned char>(text_[at]) & 0xC0U) == 0x80U) ++at;
    }
    return static_cast<std::uint32_t>(at);
  }

  std::string_view text_;
  SourceId id_;
  std::vector<std::size_t> starts_;
};

Value value_of(const toml::node& node, const Places& places) {
  Value value;
  value.span = places.span(node.source());
  if (const auto* const text = node.as_string()) {
    value.kind = Value::Kind::text;
    value.text = text->get();
  } else if (const auto* const flag = node.as_boolean()) {
    value.kind = Value::Kind::flag;
    value.is_true = flag->get();
  } else if (const auto* const list = node.as_array()) {
    value.kind = Value::Kind::list;
    for (const toml::node& item : *list) value.items.push_back(value_of(item, places));
  } else if (const auto* const table = node.as_table()) {
    value.kind = Value::Kind::table;
    for (const auto& [key, item] : *table) {
      value.entries.push_back(
          {std::string(key.str()), places.span(key.source()), value_of(item, places)});
    }
    std::ranges::sort(value.entries, {}, [](const Value::Entry& one) { return one.span.begin; });
  }
  return value;
}

}  // namespace

Value parse_toml(const Source& source, SourceId id, Report& report) {
  const Places places(source, id);
  const toml::parse_result result = toml::parse(std::string_view(source.text()));
  if (result) return value_of(result.table(), places);
  const toml::parse_error& error = result.error();
  report.add(Code::R0801, places.span(error.source()), "the project file is not valid TOML")
      .label(std::string(error.description()));
  Value empty;
  empty.kind = Value::Kind::table;
  return empty;
}

}  // namespace robdef::project
