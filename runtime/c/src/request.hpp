// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "rr/mutex.hpp"
#include "rr/service.hpp"
#include "rr/skeleton.hpp"
#include "rr/users.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/elements.hpp"

/// What the program is asked for. The program owns it; who asks shares a state with it.
struct rr_request {
  explicit rr_request(std::uint32_t kind) { info.kind = kind; }
  virtual ~rr_request() = default;
  rr_request(const rr_request&) = delete;
  rr_request& operator=(const rr_request&) = delete;

  // Each throws rr::Error: invalid_operation when another answer is wanted, or there was one.
  virtual void answer(const rr_elements* value);
  virtual void answer_end();
  virtual void answer_user(rr::User user);
  virtual void answer_object(std::shared_ptr<rr::Skeleton> object);
  virtual void answer_generator(std::shared_ptr<rr::GeneratorSource> source);
  virtual void fail(const rr::Error& why) = 0;

  void set_arguments(rr::capi::Data data);
  void set_name(std::string_view name);

  rr_request_info info{};

 private:
  rr::capi::Data arguments_;
  std::string name_;
};

namespace rr::capi {

[[noreturn]] void refuse_answer();
[[noreturn]] void refuse_second_answer();
/// The error of a request that is released unanswered.
Error released_unanswered();

/// The version in which this thread's client is answered, and its number, if it handles a request.
void describe_client(rr_request_info& info);

/// What a thread waits for that has asked the program.
template <class Result>
class Wait {
 public:
  void give(Result result) {
    end([&]() RR_REQUIRES(mutex_) { result_.emplace(std::move(result)); });
  }
  void fail(const Error& why) {
    end([&]() RR_REQUIRES(mutex_) { error_ = std::make_exception_ptr(why); });
  }
  /// The request is released: fails unless it has ended.
  void drop() noexcept {
    try {
      fail(released_unanswered());
    } catch (...) {
      // It has ended.
    }
  }
  /// Waits; throws what it failed with.
  Result take() {
    MutexLock lock(mutex_);
    if (!is_over_) {
      lock.unlock();
      before_waiting();
      lock.lock();
      while (!is_over_) ended_.wait(mutex_);
    }
    if (error_) std::rethrow_exception(error_);
    return std::move(*result_);
  }

 private:
  static void before_waiting();
  template <class End>
  void end(const End& end) {
    {
      const MutexLock lock(mutex_);
      if (is_over_) refuse_second_answer();
      end();
      is_over_ = true;
    }
    ended_.notify_all();
  }

  Mutex mutex_;
  Condition ended_;
  bool is_over_ RR_GUARDED_BY(mutex_) = false;
  std::optional<Result> result_ RR_GUARDED_BY(mutex_);
  std::exception_ptr error_ RR_GUARDED_BY(mutex_);
};
void tell_about_wait();
template <class Result>
void Wait<Result>::before_waiting() {
  tell_about_wait();
}

/// A request whose asker waits.
template <class Result>
class WaitedRequest : public rr_request {
 public:
  WaitedRequest(std::uint32_t kind, std::shared_ptr<Wait<Result>> wait)
      : rr_request(kind), wait_(std::move(wait)) {}
  ~WaitedRequest() override { wait_->drop(); }
  void fail(const Error& why) override { wait_->fail(why); }

 protected:
  [[nodiscard]] Wait<Result>& wait() const { return *wait_; }

 private:
  const std::shared_ptr<Wait<Result>> wait_;
};

/// For one value, or none; what a void looks like to the runtime is its business.
class ValueRequest final : public WaitedRequest<std::optional<Raw>> {
 public:
  ValueRequest(std::uint32_t kind, bool returns_value,
               std::shared_ptr<Wait<std::optional<Raw>>> wait)
      : WaitedRequest(kind, std::move(wait)), returns_value_(returns_value) {}
  void answer(const rr_elements* value) override;

 private:
  const bool returns_value_;
};

/// For an object of an objref.
class ObjectRequest final : public WaitedRequest<std::shared_ptr<Skeleton>> {
 public:
  explicit ObjectRequest(std::shared_ptr<Wait<std::shared_ptr<Skeleton>>> wait)
      : WaitedRequest(RR_REQUEST_FIND, std::move(wait)) {}
  void answer_object(std::shared_ptr<Skeleton> object) override { wait().give(std::move(object)); }
};

/// For a user.
class UserRequest final : public WaitedRequest<User> {
 public:
  explicit UserRequest(std::shared_ptr<Wait<User>> wait)
      : WaitedRequest(RR_REQUEST_AUTHENTICATE, std::move(wait)) {}
  void answer_user(User user) override { wait().give(std::move(user)); }
};

/// One step of a generator: a value, nothing, or its end.
struct Step {
  bool is_end = false;
  std::optional<Raw> value;
};
class StepRequest final : public WaitedRequest<Step> {
 public:
  StepRequest(bool returns_value, std::shared_ptr<Wait<Step>> wait)
      : WaitedRequest(RR_REQUEST_STEP, std::move(wait)), returns_value_(returns_value) {}
  void answer(const rr_elements* value) override;
  void answer_end() override { wait().give({true, std::nullopt}); }

 private:
  const bool returns_value_;
};

/// A request of a client to a member, which may be answered while its handler runs, in the thread
/// of that, or later.
class MemberRequest final : public rr_request {
 public:
  class State;
  MemberRequest(std::uint32_t kind, std::shared_ptr<State> state);
  ~MemberRequest() override;
  void answer(const rr_elements* value) override;
  void answer_generator(std::shared_ptr<GeneratorSource> source) override;
  void fail(const Error& why) override;

 private:
  const std::shared_ptr<State> state_;
};

/// What the handler's side of a MemberRequest knows.
class MemberRequest::State {
 public:
  /// `keeper` keeps the member, which an answer is written by that comes late.
  State(const Member& member, std::shared_ptr<const void> keeper, bool is_set, Request& request)
      : member_(member), keeper_(std::move(keeper)), is_set_(is_set), request_(&request) {}

  void answer(const rr_elements* value);
  void answer_generator(std::shared_ptr<GeneratorSource> source);
  void fail(const Error& why);
  /// The request is released: fails unless it has been answered.
  void drop() noexcept;
  /// The handler has returned. Throws what is to be answered with.
  void leave();

 private:
  void begin_answer() const RR_REQUIRES(mutex_);
  [[nodiscard]] bool wants_value() const {
    return !is_set_ && (member_.kind == MemberKind::property || member_.type != nullptr);
  }

  const Member& member_;
  const std::shared_ptr<const void> keeper_;
  const bool is_set_;
  const std::thread::id handler_ = std::this_thread::get_id();
  Mutex mutex_;
  Request* request_ RR_GUARDED_BY(mutex_);  // while the handler runs
  std::optional<ReplyHandle> later_ RR_GUARDED_BY(mutex_);
  std::exception_ptr error_ RR_GUARDED_BY(mutex_);
  bool is_over_ RR_GUARDED_BY(mutex_) = false;
};

}  // namespace rr::capi
