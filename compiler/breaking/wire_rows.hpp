// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rr/dynamic.hpp"
#include "rr/dynamic_service.hpp"
#include "rr/node.hpp"

namespace robdef::breaking::testing {

/// An old program and a new one, of which one serves an object and the other uses it.
struct Meeting {
  rr::dynamic::ServedObject served;
  rr::dynamic::Object object;  ///< that the client has
  rr::dynamic::Client& client;
  rr::dynamic::Definitions client_types;  ///< that the client was made for
  bool is_client_new = false;
  bool is_service_new = false;
  std::function<rr::dynamic::Client(const std::string& user)> connect_as;
};

/// Two versions of a definition with an object, and what programs do with it. `use` gives a text
/// that is the same when both sides are of one version.
struct Row {
  std::string name;
  std::string codes;  ///< that compare() finds
  std::string before;
  std::string now;
  std::function<void(const rr::dynamic::ServedObject&, bool is_new)> serve;
  std::function<std::string(Meeting&)> use;
  std::string old_client;  ///< works, refused: ERROR, or silent: and the value that came
  std::string new_client;  ///< of an old service, likewise
  /// Of the object that is served.
  std::string old_root = "x.t.Root";
  std::string new_root = "x.t.Root";
  std::string old_wanted{};  ///< type that old clients ask for; empty: as served
  bool has_users = false;
  /// The client has no types of its own, but takes those of the service, as with MATLAB and a URL:
  /// what `use` does is of its own version still.
  bool takes_types = false;
};

/// Values, and the types that they are of.
std::vector<Row> value_rows();
std::vector<Row> record_rows();
/// Members and objects.
std::vector<Row> member_rows();
std::vector<Row> object_rows();
/// What works and means something else.
std::vector<Row> meaning_rows();

// What rows are made of.

using Serve = std::function<void(const rr::dynamic::ServedObject&, bool)>;
using Use = std::function<std::string(Meeting&)>;

/// Does nothing.
void serve_nothing(const rr::dynamic::ServedObject& object, bool is_new);
/// Keeps a value in the property `v`.
Serve stores(const rr::dynamic::Value& value);
Serve stores(const rr::dynamic::Value& old_value, const rr::dynamic::Value& new_value);
/// Gets the property `v`, as JSON.
std::string get(Meeting& meeting);
/// Gets a field of it.
Use gets(const std::string& field);
/// Sets the property `v`; what the service has then.
Use sets(const rr::dynamic::Value& value);
/// Sets the property `v` to what is of the client's version, and is content when nothing fails.
Use sets(const rr::dynamic::Value& old_value, const rr::dynamic::Value& new_value);
/// Two versions of the members of Root.
Row members(std::string name, std::string codes, const std::string& before, const std::string& now,
            Serve serve, Use use, std::string old_client, std::string new_client);
/// Two versions of a type T that the property `v` has.
Row types(std::string name, std::string codes, const std::string& before, const std::string& now,
          Serve serve, Use use, std::string old_client, std::string new_client,
          const std::string& type = "T");

}  // namespace robdef::breaking::testing
