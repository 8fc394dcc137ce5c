// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/matlab/interpreter.hpp"

#include <mex.h>

#include <thread>
#include <utility>

#include "conformance/runners/dynamic/verbs.hpp"
#include "rr/matlab/containers.hpp"
#include "rr/matlab/misfit.hpp"

namespace rr::conformance {

void Interpreter::push(std::function<void()> work) {
  {
    const std::lock_guard lock(mutex_);
    work_.push_back(std::move(work));
  }
  changed_.notify_one();
}

bool Interpreter::run(const std::string& verb, const std::string& folder) {
  bool is_known = false;
  is_running_ = true;
  std::thread thread([&] {
    is_known = answer_verb(verb, folder);
    push([this] { has_ended_ = true; });
  });
  while (!has_ended_) {
    std::function<void()> work;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return !work_.empty(); });
      work = std::move(work_.front());
      work_.pop_front();
    }
    work();
  }
  thread.join();
  is_running_ = false;
  return is_known;
}

dynamic::Value Interpreter::pass(const dynamic::Definitions& definitions,
                                 const dynamic::ValueType& type, const dynamic::Value& value) {
  std::promise<dynamic::Value> passed;
  push([&] {
    try {
      passed.set_value(pass_here(definitions, type, value));
    } catch (...) {
      passed.set_exception(std::current_exception());
    }
  });
  return passed.get_future().get();
}

matlab::Plans& Interpreter::plans_of(const dynamic::Definitions& definitions) {
  auto& plans = plans_[definitions.tables()];
  if (!plans) plans = std::make_unique<matlab::Plans>();
  return *plans;
}

dynamic::Value Interpreter::pass_here(const dynamic::Definitions& definitions,
                                      const dynamic::ValueType& type, const dynamic::Value& value) {
  const dynamic::Value converted = type.convert(value);
  matlab::Plans& plans = plans_of(definitions);
  const matlab::TypePlan& plan = *plans.plan(type);
  return matlab::as_subject("", [&] {
    mxArray* const given = matlab::to_mex(converted, plan, plans);
    mxArray* const held = matlab::call_function("conformance_pass", {given});
    const dynamic::Value result = type.convert(matlab::from_mex(held, plan, {plans, definitions}));
    mxDestroyArray(held);
    mxDestroyArray(given);
    return result;
  });
}

}  // namespace rr::conformance
