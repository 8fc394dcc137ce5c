// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "compiler/backends/arduino/groups.hpp"
#include "compiler/backends/arduino/names.hpp"
#include "compiler/backends/arduino/types.hpp"
#include "compiler/backends/arduino/view.hpp"

namespace robdef::arduino {

/// The longest bodies of messages, which the board's memory is made for.
struct Sizes {
  std::uint64_t request = 32;
  std::uint64_t reply = 32;
  std::uint64_t out = 0;
  std::uint64_t queue_sum = 0;  ///< of one of each event, pipe and callback
  std::uint64_t queue_most = 0;
  std::uint64_t slots = 0;
  bool has_double = false;

  void take_request(std::uint64_t values) { request = std::max(request, values + 2); }
  void take_reply(std::uint64_t values) { reply = std::max(reply, values + 1); }
  void take_queued(std::uint64_t values) {
    out = std::max(out, values + 3);
    queue_sum += values + 5;
    queue_most = std::max(queue_most, values + 5);
  }
};

/// Makes the members of each group. Reports what a board cannot serve.
/// What members of one object are called, and what a device has for them.
struct MemberNames {
  Scope own;
  Scope hooks;
};

class MemberMaker {
 public:
  MemberMaker(BoardTypes& types, const std::vector<Group>& groups, Report& report)
      : types_(types), groups_(groups), report_(report) {}

  std::vector<MemberView> make(std::size_t group);
  [[nodiscard]] const Sizes& sizes() const { return sizes_; }

 private:
  void make_one(const model::Member& member, std::size_t group, MemberView& view,
                MemberNames& names);
  void make_value(const model::Member& member, MemberView& view, const Limits& limits);
  std::uint64_t make_parameters(const model::Member& member, std::size_t group, MemberView& view,
                                const Limits& limits);
  void make_objref(const model::Member& member, std::size_t group, MemberView& view);
  void take_slots(std::size_t group, MemberView& view);
  void list_hooks(MemberView& view) const;

  BoardTypes& types_;
  const std::vector<Group>& groups_;
  Report& report_;
  Sizes sizes_;
};

/// `lamp` and `armLamp`; `root`.
std::string group_name(const Group& group);
/// What the objects of a type are called in templates: `LampDevice`.
std::string device_name(const model::Object& object);

}  // namespace robdef::arduino
