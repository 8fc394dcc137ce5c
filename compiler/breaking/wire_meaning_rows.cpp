// SPDX-License-Identifier: Apache-2.0
// What works, and means something else than it did.
#include "compiler/breaking/testing.hpp"
#include "compiler/breaking/wire_rows.hpp"
#include "rr/error.hpp"
#include "rr/locks.hpp"

namespace robdef::breaking::testing {
namespace {

using rr::dynamic::List;
using rr::dynamic::ServedObject;
using rr::dynamic::StringMap;
using rr::dynamic::Value;

// The client sets a value of an enum by its name; the name that it has at the service.
Use names(const std::string& name) {
  return [=](Meeting& meeting) {
    meeting.object.set("v", name);
    return meeting.served.stored("v").text();
  };
}

// The client sets the constant that it knows; whether that is the service's.
std::string go_home(Meeting& meeting) {
  const auto home = [](const rr::dynamic::Definitions& types) {
    return types.constants("x.t").front().second.as<std::int32_t>();
  };
  meeting.object.set("v", home(meeting.client_types));
  return meeting.served.stored("v").as<std::int32_t>() == home(meeting.served.types())
             ? "home"
             : "elsewhere";
}

Row constant(const std::string& name, const std::string& before, const std::string& now) {
  return {.name = name,
          .codes = "R0773",
          .before = with_root("constant int32 HOME " + before, "property int32 v"),
          .now = with_root("constant int32 HOME " + now, "property int32 v"),
          .serve = stores(0),
          .use = go_home,
          .old_client = "silent: elsewhere",
          .new_client = "silent: elsewhere"};
}

Row exception() {
  return {.name = "an exception with another name",
          .codes = "R0774",
          .before = with_root("exception Jam", "function void f()"),
          .now = with_root("exception Stuck", "function void f()"),
          .serve =
              [](const ServedObject& object, bool is_new) {
                object.on_call("f", [=](const List&) -> Value {
                  throw rr::Error(rr::ErrorCode::remote_error, is_new ? "x.t.Stuck" : "x.t.Jam",
                                  "it does not move");
                });
              },
          .use = [](Meeting& meeting) -> std::string {
            try {
              meeting.object.call("f");
            } catch (const rr::Error& error) {
              return error.name() == (meeting.is_client_new ? "x.t.Stuck" : "x.t.Jam")
                         ? "caught"
                         : "another error: " + error.name();
            }
            return "no error";
          },
          .old_client = "silent: another error: x.t.Stuck",
          .new_client = "silent: another error: x.t.Jam"};
}

// One user locks the object, another uses it.
std::string use_while_locked(Meeting& meeting) {
  rr::lock(meeting.object.stub());
  const rr::dynamic::Client other = meeting.connect_as("another");
  try {
    other->call("f");
  } catch (const rr::Error& error) {
    return error.code() == rr::ErrorCode::object_locked_error ? "locked out" : error.what();
  }
  return "done";
}

Row lock(const std::string& name, const std::string& before, const std::string& now,
         const std::string& old_client, const std::string& new_client) {
  Row row = members(
      name, "R0775", "function void f()" + before, "function void f()" + now,
      [](const ServedObject& object, bool) {
        object.on_call("f", [](const List&) { return Value(); });
      },
      use_while_locked, old_client, new_client);
  row.has_users = true;
  return row;
}

// What one client has set, after another has set something else.
std::string set_beside_another(Meeting& meeting) {
  meeting.object.set("v", 1.0);
  const rr::dynamic::Client other = meeting.connect_as("another");
  other->set("v", 2.0);
  return get(meeting);
}

// Whether the pipe is one on which packets may be lost, as the client wants.
std::string connect_pipe(Meeting& meeting) {
  return meeting.object.pipe("v").connect({.unreliable = true}).is_unreliable() ? "unreliable"
                                                                                : "reliable";
}

Row parameters() {
  Row row = members(
      "parameters in another order, given by position", "R0778",
      "function double f(double pan, double tilt)", "function double f(double tilt, double pan)",
      [](const ServedObject& object, bool is_new) {
        object.on_call("f", [=](const List& arguments) {
          return is_new ? arguments[1] : arguments[0];  // pan
        });
      },
      [](Meeting& meeting) {
        return meeting.object.call("f", {1.0, 2.0}).to_json();
      },
      "silent: 2", "silent: 1");
  row.takes_types = true;
  return row;
}

}  // namespace

std::vector<Row> meaning_rows() {
  const std::string modes = "enum T\nidle = 0,\nbusy = 1,\npaused = 2";
  return {
      types("a value of an enum with another number", "R0771 R0771", modes,
            "enum T\nidle = 0,\npaused = 1,\nbusy = 2", stores(0), names("busy"), "silent: paused",
            "silent: paused"),
      types(
          "a value of an enum that is gone", "R0772", modes, "enum T\nidle = 0,\npaused = 2",
          stores(0),
          [](Meeting& meeting) { return names(meeting.is_client_new ? "idle" : "busy")(meeting); },
          "silent: 1", "works"),
      types(
          "a value of an enum with another name", "R0742", modes,
          "enum T\nidle = 0,\nworking = 1,\npaused = 2", stores(1),
          [](Meeting& meeting) { return std::to_string(meeting.object.get("v").as<int>()); },
          "works", "works"),
      constant("a constant with another value", "1", "2"),
      exception(),
      lock("a function that is no longer nolock", " [nolock]", "", "silent: locked out",
           "silent: done"),
      lock("a function that is now nolock", "", " [nolock]", "silent: done", "silent: locked out"),
      members("a property that is no longer perclient", "R0776", "property double v [perclient]",
              "property double v", stores(0.0), set_beside_another, "silent: 2", "silent: 1"),
      members("a pipe that is now unreliable", "R0777", "pipe double v",
              "pipe double v [unreliable]", serve_nothing, connect_pipe, "works",
              "silent: reliable"),
      parameters(),
  };
}

}  // namespace robdef::breaking::testing
