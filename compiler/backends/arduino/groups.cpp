// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/arduino/groups.hpp"

#include <algorithm>
#include <set>
#include <variant>

#include "compiler/model/rename.hpp"

namespace robdef::arduino {
namespace {

/// Numbers of objects are one byte.
constexpr std::size_t object_limit = 255;

class Finder {
 public:
  explicit Finder(Report& report) : report_(report) {}

  std::vector<Group> find(const model::Object& root) {
    groups_.push_back({.object = &root, .path = {}});
    for (std::size_t at = 0; at < groups_.size(); ++at) {
      for (const model::Member& member : groups_[at].object->members) {
        if (member.kind == model::MemberKind::objref) follow(at, member);
      }
    }
    return std::move(groups_);
  }

 private:
  void refuse(const model::Member& member, const std::string& what, const std::string& hint) {
    report_.add(Code::R0920, member.span, what + " cannot be served by a board").help(hint);
  }

  bool is_above(std::size_t at, const model::Object* object) const {
    for (;;) {
      if (groups_[at].object == object) return true;
      if (at == 0) return false;
      at = groups_[at].parent;
    }
  }

  void follow(std::size_t parent, const model::Member& member) {
    const auto* const object = std::get_if<const model::Object*>(&member.type.base);
    if (object == nullptr) {
      refuse(member, "a varobject", "name the object's type");
      return;
    }
    if (member.index == model::IndexForm::string) {
      refuse(member, "an objref with a string index", "use an index of int32");
      return;
    }
    if (is_above(parent, *object)) {
      refuse(member, "an object that leads to objects of its own type",
             "a board has a fixed number of objects: use another type, or an index");
      return;
    }
    std::size_t fan = 1;
    if (member.index == model::IndexForm::int32) {
      const Limits limits(member.documentation, member.span, report_);
      const auto limit = limits.of("");
      limits.report_unused(report_);
      if (!limit) {
        report_.add(Code::R0921, member.span, "an objref with an index needs a limit on a board")
            .help("write `## @limit 4` in the documentation above: how many objects there are");
        return;
      }
      fan = *limit;
    }
    add(parent, member, **object, fan);
  }

  void add(std::size_t parent, const model::Member& member, const model::Object& object,
           std::size_t fan) {
    const std::size_t count = groups_[parent].count * fan;
    const std::size_t first = groups_.back().first + groups_.back().count;
    if (first + count > object_limit) {
      report_.add(Code::R0922, member.span, "these are more objects than a board can number")
          .help("there are " + std::to_string(object_limit) + " numbers: give a smaller limit");
      return;
    }
    Group group{.object = &object,
                .path = groups_[parent].path,
                .parent = parent,
                .via = &member,
                .fan = fan,
                .first = first,
                .count = count};
    group.path.push_back(model::code_name(member));
    groups_.push_back(std::move(group));
  }

  Report& report_;
  std::vector<Group> groups_;
};

}  // namespace

std::vector<Group> find_groups(const model::Object& root, Report& report) {
  return Finder(report).find(root);
}

const model::Object* find_root(const model::Definition& definition, Report& report) {
  std::set<const model::Object*> reached;
  std::vector<const model::Object*> marked;
  std::vector<const model::Object*> free;
  for (const model::Object& object : definition.objects) {
    if (is_marked_root(object.documentation)) marked.push_back(&object);
    for (const model::Member& member : object.members) {
      const auto* const type = std::get_if<const model::Object*>(&member.type.base);
      if (type != nullptr && *type != &object) reached.insert(*type);
    }
  }
  for (const model::Object& object : definition.objects) {
    if (!reached.contains(&object)) free.push_back(&object);
  }
  if (marked.size() == 1) return marked.front();
  if (marked.empty() && free.size() == 1) return free.front();
  report.add(Code::R0924, definition.span, "it is not clear which object the board serves")
      .help("write `## @root` above one of the objects");
  return nullptr;
}

}  // namespace robdef::arduino
