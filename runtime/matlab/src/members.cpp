// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/members.hpp"

#include "rr/error.hpp"

namespace rr::matlab {

std::uint64_t add_listener(const MemberHandle& member, const mxArray* function) {
  return member.connection->add({.function = Kept(need_function(function, member.subject)),
                                 .parameter = {},
                                 .member = member.member,
                                 .connection = member.connection,
                                 .subscription = nullptr});
}

void keep_listener(Runtime& runtime, std::uint64_t number, Subscription subscription) {
  runtime.functions().find(number)->subscription =
      std::make_shared<Subscription>(std::move(subscription));
}

void run_listener(Runtime& runtime, std::uint64_t number, const dynamic::Value& value,
                  const TimeSpec* time) {
  const UserFunction* const function = runtime.functions().find(number);
  const auto connection = function != nullptr ? function->connection.lock() : nullptr;
  if (!connection) return;
  const TypePlan* const plan = connection->plans.plan(function->member.type);
  std::vector<mxArray*> arguments{to_mex(value, *plan, connection->plans)};
  if (time != nullptr) arguments.push_back(time_to_mex(*time));
  UserFunctions::run_alone(function->function, std::move(arguments));
}

}  // namespace rr::matlab
