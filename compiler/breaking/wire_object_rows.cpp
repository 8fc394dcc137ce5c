// SPDX-License-Identifier: Apache-2.0
// Objects, what they implement, and how they are found.
#include "compiler/breaking/testing.hpp"
#include "compiler/breaking/wire_rows.hpp"
#include "rr/error.hpp"

namespace robdef::breaking::testing {
namespace {

using rr::dynamic::ServedObject;
using rr::dynamic::Value;

// Objects that an objref `v` leads to.
constexpr const char* leaves =
    "object Leaf\nproperty double p\nend\n"
    "object Other\nproperty double p\nend\n"
    "object Finer\nimplements Leaf\nproperty double p\nend";

// What the service has there.
Serve leads_to(const std::string& old_type, const std::string& new_type) {
  return [=](const ServedObject& object, bool is_new) {
    object.on_object("v", [=, types = object.types()](const Value&) {
      const ServedObject leaf(types, is_new ? new_type : old_type);
      leaf.store("p", 1.0);
      return leaf.skeleton();
    });
  };
}

std::string follow(Meeting& meeting) { return meeting.object.object("v").get("p").to_json(); }

Row reference(std::string name, std::string codes, const std::string& before,
              const std::string& now, Serve serve, Use use, std::string old_client,
              std::string new_client) {
  return {.name = std::move(name),
          .codes = std::move(codes),
          .before = with_root(leaves, "objref " + before + " v"),
          .now = with_root(leaves, "objref " + now + " v"),
          .serve = std::move(serve),
          .use = std::move(use),
          .old_client = std::move(old_client),
          .new_client = std::move(new_client)};
}

Use follows_index(bool old_is_text, bool new_is_text) {
  return [=](Meeting& meeting) {
    const bool is_text = meeting.is_client_new ? new_is_text : old_is_text;
    return (is_text ? meeting.object.object("v", "left") : meeting.object.object("v", 3))
        .get("p")
        .to_json();
  };
}

const std::string members_of_root = "property double v\n";

Row whole(std::string name, std::string codes, const std::string& before, const std::string& now,
          std::string old_client, std::string new_client) {
  return {.name = std::move(name),
          .codes = std::move(codes),
          .before = before,
          .now = now,
          .serve = stores(1.0),
          .use = get,
          .old_client = std::move(old_client),
          .new_client = std::move(new_client)};
}

}  // namespace

std::vector<Row> object_rows() {
  const std::string leaf = "x.t.Leaf";
  Row service = whole("a service with another name", "R0701", with_root("", members_of_root),
                      "service x.u\nstdver 0.10\nobject Root\n" + members_of_root + "end\n",
                      "refused: ServiceError", "refused: ServiceError");
  service.new_root = "x.u.Root";
  Row object = whole("an object with another name", "R0702", with_root("", members_of_root),
                     definition("object Core\n" + members_of_root + "end"), "refused: ServiceError",
                     "refused: ServiceError");
  object.new_root = "x.t.Core";
  const std::string base = "object Base\n" + members_of_root + "end";
  Row implements = whole("an object that no longer implements another", "R0719",
                         with_root(base, "implements Base\n" + members_of_root),
                         with_root(base, members_of_root), "refused: ServiceError", "works");
  implements.old_wanted = "x.t.Base";
  implements.takes_types = true;
  Row added = whole("a new member of an object that others implement", "R0749",
                    with_root(base, "implements Base\n" + members_of_root),
                    with_root("object Base\nproperty double v\nproperty double w\nend",
                              "implements Base\nproperty double v\nproperty double w\n"),
                    "works", "works");
  return {
      service,
      object,
      implements,
      added,
      whole("a later version of the language", "R0748",
            "service x.t\nstdver 0.9\nobject Root\n" + members_of_root + "end\n",
            with_root("", members_of_root), "works", "works"),
      whole("a constant that is gone", "R0743", with_root("constant int32 A 1", members_of_root),
            with_root("", members_of_root), "works", "works"),
      whole("a constant of another type", "R0745", with_root("constant int32 A 1", members_of_root),
            with_root("constant int16 A 1", members_of_root), "works", "works"),
      reference("an objref to another object", "R0718", "Leaf", "Other",
                leads_to(leaf, "x.t.Other"), follow, "refused: ServiceError",
                "refused: ServiceError"),
      reference("an objref to an object that implements the old one", "R0747", "Leaf", "Finer",
                leads_to("x.t.Finer", "x.t.Finer"), follow, "works", "works"),
      reference("an objref that may lead anywhere", "R0747", "Leaf", "varobject",
                leads_to(leaf, leaf), follow, "works", "works"),
      reference(
          "an objref that gets an index", "R0717", "Leaf", "Leaf{int32}", leads_to(leaf, leaf),
          [](Meeting& meeting) {
            return meeting.is_client_new ? follows_index(false, false)(meeting) : follow(meeting);
          },
          "refused: InvalidArgument", "refused: ServiceError"),
      reference("an objref with an index of text", "R0717", "Leaf{int32}", "Leaf{string}",
                leads_to(leaf, leaf), follows_index(false, true), "works",
                "refused: InvalidArgument"),
  };
}

}  // namespace robdef::breaking::testing
