// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/wire_rows.hpp"

#include <utility>

#include "compiler/breaking/testing.hpp"

namespace robdef::breaking::testing {

using rr::dynamic::ServedObject;
using rr::dynamic::Value;

void serve_nothing(const ServedObject& object, bool is_new) {
  static_cast<void>(object);
  static_cast<void>(is_new);
}

Serve stores(const Value& value) { return stores(value, value); }

Serve stores(const Value& old_value, const Value& new_value) {
  return [=](const ServedObject& object, bool is_new) {
    object.store("v", is_new ? new_value : old_value);
  };
}

std::string get(Meeting& meeting) { return meeting.object.get("v").to_json(); }

Use gets(const std::string& field) {
  return [=](Meeting& meeting) { return meeting.object.get("v")[field].to_json(); };
}

Use sets(const Value& value) {
  return [=](Meeting& meeting) {
    meeting.object.set("v", value);
    return meeting.served.stored("v").to_json();
  };
}

Use sets(const Value& old_value, const Value& new_value) {
  return [=](Meeting& meeting) {
    meeting.object.set("v", meeting.is_client_new ? new_value : old_value);
    return std::string("set");
  };
}

Row members(std::string name, std::string codes, const std::string& before, const std::string& now,
            Serve serve, Use use, std::string old_client, std::string new_client) {
  return {.name = std::move(name),
          .codes = std::move(codes),
          .before = with_root("", before),
          .now = with_root("", now),
          .serve = std::move(serve),
          .use = std::move(use),
          .old_client = std::move(old_client),
          .new_client = std::move(new_client)};
}

Row types(std::string name, std::string codes, const std::string& before, const std::string& now,
          Serve serve, Use use, std::string old_client, std::string new_client,
          const std::string& type) {
  return {.name = std::move(name),
          .codes = std::move(codes),
          .before = with_root(before + "\nend", "property " + type + " v"),
          .now = with_root(now + "\nend", "property " + type + " v"),
          .serve = std::move(serve),
          .use = std::move(use),
          .old_client = std::move(old_client),
          .new_client = std::move(new_client)};
}

}  // namespace robdef::breaking::testing
