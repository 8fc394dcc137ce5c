// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "runtime/matlab/src/objects.hpp"

namespace rr::matlab {

/// A lifespan of zero means none at all to the runtime, so that is the least one.
inline constexpr std::chrono::milliseconds min_lifespan{1};

/// What is held of a connected wire, a pipe, ...: its connection, and how its values are converted.
class MemberHandle : public Handled {
 public:
  MemberHandle(const ObjectHandle& object, const Resolved& of)
      : connection(object.connection()),
        owner(object.object()),
        member(of.member),
        subject(of.subject),
        plan(of.plan) {}

  [[nodiscard]] mxArray* write(const dynamic::Value& value) const {
    return plan != nullptr ? to_mex(value, *plan, connection->plans) : make_null();
  }
  [[nodiscard]] dynamic::Value read(const mxArray* given) const { return read(given, plan); }
  [[nodiscard]] dynamic::Value read(const mxArray* given, const TypePlan* as) const {
    if (as == nullptr) return {};
    return as_subject(subject, [&] {
      return from_mex(given, *as, {connection->plans, owner.types()});
    });
  }

  const std::shared_ptr<Connection> connection;
  const dynamic::Object owner;
  const dynamic::MemberDescription member;
  const std::string subject;
  const TypePlan* const plan;
};

/// What the first argument is the number of; its connection is the current one.
template <class Handle>
std::shared_ptr<Handle> handle_of(Runtime& runtime, Call& call) {
  auto handle = runtime.handles().get<Handle>(call.handle(0));
  runtime.current = handle->connection;
  return handle;
}

/// A function of the user's for what comes: first the function, then what calls it.
std::uint64_t add_listener(const MemberHandle& member, const mxArray* function);
void keep_listener(Runtime& runtime, std::uint64_t number, Subscription subscription);
/// Calls it with a value of the member, and the time, unless it is null. On the interpreter's
/// thread.
void run_listener(Runtime& runtime, std::uint64_t number, const dynamic::Value& value,
                  const TimeSpec* time);

}  // namespace rr::matlab
