// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/search.hpp"

#include <string_view>

#include "compiler/output/json.hpp"

namespace robdef::docs {
namespace {

// In JSON these characters are in strings only, where escapes mean the same.
std::string for_script(std::string_view json) {
  std::string text;
  for (const char c : json) {
    if (c == '<') {
      text += "\\u003c";
    } else if (c == '>') {
      text += "\\u003e";
    } else if (c == '&') {
      text += "\\u0026";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

std::string search_index(const std::string& page, const std::string& name,
                         const std::vector<Found>& entries) {
  JsonWriter json(JsonWriter::Layout::one_line);
  json.begin_object().member("page", page).member("name", name).key("entries").begin_array();
  for (const Found& entry : entries) {
    json.begin_array().value(entry.kind).value(entry.name).value(entry.anchor);
    json.value(entry.words).end_array();
  }
  json.end_array().end_object();
  return for_script(std::move(json).text());
}

}  // namespace robdef::docs
