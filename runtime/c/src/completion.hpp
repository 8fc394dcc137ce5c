// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <memory>
#include <utility>

#include "rr/generators.hpp"
#include "rr/stub.hpp"
#include "runtime/c/src/border.hpp"

/// Asynchronous calls that end at a function of the program.
namespace rr::capi {

/// Throws rr::Error (invalid_argument) for a completion that cannot be called.
rr_completion check(const rr_completion* completion);

/// Leaves the result of the runtime's kind in a place of its own; `finish` makes of it what the
/// program gets.
template <class Result, class Finish, class Base = Completion>
class DoneCompletion : public Base {
 public:
  DoneCompletion(const rr_completion& done, Finish finish)
      : done_(done), finish_(std::move(finish)) {}

  void* result() override { return &result_; }
  void succeed() override {
    void* made = nullptr;
    try {
      made = finish_(result_);
    } catch (...) {
      fail(std::current_exception());
      return;
    }
    done_.done(done_.context, nullptr, made);
  }
  void fail(std::exception_ptr error) override {
    done_.done(done_.context, make_error(error), nullptr);
  }
  [[nodiscard]] Result& place() { return result_; }

 protected:
  const rr_completion done_;

 private:
  Finish finish_;
  Result result_{};
};

template <class Result, class Finish>
std::unique_ptr<DoneCompletion<Result, Finish>> complete(const rr_completion* done, Finish finish) {
  return std::make_unique<DoneCompletion<Result, Finish>>(check(done), std::move(finish));
}

struct Nothing {};
/// Of a call without a result.
inline std::unique_ptr<Completion> complete_with_nothing(const rr_completion* done) {
  return complete<Nothing>(done, [](Nothing&) -> void* { return nullptr; });
}

}  // namespace rr::capi
