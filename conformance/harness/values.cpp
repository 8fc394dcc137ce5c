// SPDX-License-Identifier: Apache-2.0
#include "conformance/harness/values.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

namespace rr::conformance {
namespace {

bool is_varvalue(const Json& json) {
  return json.is_object() && json.size() == 2 && json.contains("type") && json.contains("value");
}

bool is_multi_array(const Json& json) {
  return json.is_object() && json.size() == 2 && json.contains("dims") && json.contains("array");
}

// Nine digits are enough for any single.
bool is_short_decimal(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value);
  return std::strtod(text, nullptr) == value;
}

bool same_number(const Json& a, const Json& b) {
  if (a.is_number_integer() && b.is_number_integer()) return a == b;
  const double x = a.get<double>();
  const double y = b.get<double>();
  if (x == y) return std::signbit(x) == std::signbit(y);
  // A single is a short decimal that gives its bits, of which there may be several, or the double
  // that it is.
  const auto narrow_x = static_cast<float>(x);
  const auto narrow_y = static_cast<float>(y);
  const auto is_single = [](double wide, float narrow) {
    return static_cast<double>(narrow) == wide || is_short_decimal(wide);
  };
  return narrow_x == narrow_y && is_single(x, narrow_x) && is_single(y, narrow_y);
}

// A list of [key, value] is a map.
bool is_map(const Json& json) {
  if (!json.is_array() || json.empty()) return false;
  for (const Json& item : json) {
    if (!item.is_array() || item.size() != 2) return false;
    if (!item[0].is_string() && !item[0].is_number_integer()) return false;
  }
  return true;
}

bool same_list(const Json& a, const Json& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (!same_value(a[i], b[i])) return false;
  }
  return true;
}

std::string without_suffix(const std::string& type, std::string_view suffix) {
  return type.substr(0, type.size() - suffix.size());
}

// The items of `recorded`, a container of `item` in a varvalue, each as the varvalue it arrives as.
Json as_varvalues(const Json& items, const std::string& item, bool is_list) {
  if (item == "varvalue" || items.is_null()) return items;
  Json result = items;
  for (Json& each : result) {
    Json& value = is_list ? each : each[1];
    if (!value.is_null()) value = {{"type", item}, {"value", value}};
  }
  return result;
}

bool same_varvalue(const Json& recorded, const Json& got) {
  const std::string before = recorded["type"];
  const std::string now = got["type"];
  if (before == now) return same_value(recorded["value"], got["value"]);
  if (now == before + "[]" || (now == "int32[]" && got["value"].is_array())) {
    const Json& list = got["value"];
    return list.is_array() && list.size() == 1 && same_value(recorded["value"], list[0]);
  }
  for (const std::string_view suffix : {"{list}", "{int32}", "{string}"}) {
    if (!before.ends_with(suffix) || now != "varvalue" + std::string(suffix)) continue;
    return same_value(
        as_varvalues(recorded["value"], without_suffix(before, suffix), suffix == "{list}"),
        got["value"]);
  }
  return false;
}

bool same_object(const Json& recorded, const Json& got) {
  if (recorded.size() != got.size()) return false;
  for (const auto& [key, value] : recorded.items()) {
    if (!got.contains(key) || !same_value(value, got[key])) return false;
  }
  return true;
}

}  // namespace

bool same_things(const Json& recorded, const Json& got) {
  if (!recorded.is_array() || !got.is_array() || recorded.size() != got.size()) return false;
  std::vector<bool> taken(got.size());
  for (const Json& wanted : recorded) {
    std::size_t i = 0;
    while (i < got.size() && (taken[i] || !same_value(wanted, got[i]))) ++i;
    if (i == got.size()) return false;
    taken[i] = true;
  }
  return true;
}

bool same_value(const Json& recorded, const Json& got) {
  if (recorded.is_number() && got.is_number()) return same_number(recorded, got);
  if (is_varvalue(recorded) && is_varvalue(got)) return same_varvalue(recorded, got);
  if (recorded.is_object() && got.is_object()) return same_object(recorded, got);
  // A field of a pod with several dimensions was recorded as it travels: without them.
  if (recorded.is_array() && is_multi_array(got)) return same_list(recorded, got["array"]);
  if (recorded.is_array() && got.is_array()) {
    return same_list(recorded, got) ||
           (is_map(recorded) && is_map(got) && same_things(recorded, got));
  }
  const auto is_single = [](const Json& json) { return json.is_number() || json.is_boolean(); };
  if (recorded.is_array() && recorded.size() == 1 && is_single(got)) {
    return same_value(recorded[0], got);
  }
  if (got.is_array() && got.size() == 1 && is_single(recorded)) return same_value(recorded, got[0]);
  return recorded == got;
}

std::string said(const Json& json, std::size_t limit) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace).substr(0, limit);
}

}  // namespace rr::conformance
