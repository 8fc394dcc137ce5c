// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/diagnostics/report.hpp"
#include "compiler/diagnostics/source.hpp"

/// TOML as tables, lists and texts whose places are known.
namespace robdef::project {

/// A value. What it is decides which part means something.
struct Value {
  enum class Kind { text, flag, list, table, other };
  /// A key of a table, with its value.
  struct Entry;

  Kind kind = Kind::other;
  std::string text;  ///< text
  bool is_true = false;
  std::vector<Value> items;    ///< list
  std::vector<Entry> entries;  ///< table, in the order of the file
  Span span;
};

struct Value::Entry {
  std::string key;
  Span span;  ///< of the key
  Value value;
};

/// The table that a source is. Reports R0801, and gives an empty one then.
Value parse_toml(const Source& source, SourceId id, Report& report);

}  // namespace robdef::project
