// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <coroutine>
#include <exception>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

#include "rr/error.hpp"
#include "rr/visibility.hpp"

/// What generator functions of a service return (07, section 8).
namespace RR_VISIBLE rr {

/// What a service gives for one call of a generator function, without its types. Steps come one at
/// a time, on a thread of the node, never under a lock. Where there are types derive from
/// GeneratorOf.
class GeneratorSource {
 public:
  virtual ~GeneratorSource() = default;
  /// `parameter` and `result` are values of the member's types, null where there is none. False at
  /// the end. What it throws ends the generator.
  virtual bool rr_step(const void* parameter, void* result) = 0;
  /// The client wants no more steps, or breaks off; none follows.
  virtual void rr_close() {}
  virtual void rr_abort() {}
};

/// A generator written by hand: R what each step gives, P what it takes; either may be void. It is
/// let go when it has ended, when the client closes it or breaks off, when the client leaves, when
/// its object is released, and when nobody has used it for NodeOptions::generator_timeout.
template <class R, class P = void>
class GeneratorOf : public GeneratorSource {
 public:
  /// The next value; nothing at the end. What it throws is sent, and ends the generator.
  virtual std::optional<R> next(const P& parameter) = 0;
  /// The client wants no more, or breaks off. Not called when it leaves.
  virtual void close() {}
  virtual void abort() {}

  bool rr_step(const void* parameter, void* result) final {
    std::optional<R> value = next(*static_cast<const P*>(parameter));
    if (value) *static_cast<R*>(result) = std::move(*value);
    return value.has_value();
  }
  void rr_close() final { close(); }
  void rr_abort() final { abort(); }
};

template <class P>
class GeneratorOf<void, P> : public GeneratorSource {
 public:
  /// Takes a value; false when it is the last, which then has not been taken.
  virtual bool next(const P& parameter) = 0;
  virtual void close() {}
  virtual void abort() {}

  bool rr_step(const void* parameter, void* /*result*/) final {
    return next(*static_cast<const P*>(parameter));
  }
  void rr_close() final { close(); }
  void rr_abort() final { abort(); }
};

template <class R>
class GeneratorOf<R, void> : public GeneratorSource {
 public:
  virtual std::optional<R> next() = 0;
  virtual void close() {}
  virtual void abort() {}

  bool rr_step(const void* /*parameter*/, void* result) final {
    std::optional<R> value = next();
    if (value) *static_cast<R*>(result) = std::move(*value);
    return value.has_value();
  }
  void rr_close() final { close(); }
  void rr_abort() final { abort(); }
};

/// Waits in a coroutine for what the next step takes: `const P p = co_await rr::taken<P>;`
template <class P>
struct Taken {};
template <class P>
inline constexpr Taken<P> taken{};

/// The parts of a coroutine's promise that depend on what a step gives and takes.
template <class R>
class YieldingPromise {
 public:
  std::suspend_always yield_value(const R& value) {
    *result_ = value;
    return {};
  }
  std::suspend_always yield_value(R&& value) {
    *result_ = std::move(value);
    return {};
  }
  void set_result(void* result) { result_ = static_cast<R*>(result); }

 private:
  R* result_ = nullptr;
};
template <>
class YieldingPromise<void> {
 public:
  void set_result(void* /*result*/) {}
};

template <class R, class P>
class TakingPromise {
 public:
  // A step that must give a value does not end by waiting for one.
  class Awaiter {
   public:
    explicit Awaiter(TakingPromise& promise) : promise_(promise) {}
    [[nodiscard]] bool await_ready() const {
      return promise_.parameter_ != nullptr || !std::is_void_v<R>;
    }
    void await_suspend(std::coroutine_handle<> /*coroutine*/) const {}
    P await_resume() const {
      const P* const parameter = std::exchange(promise_.parameter_, nullptr);
      if (parameter == nullptr) {
        throw Error(ErrorCode::internal_error, "a generator takes twice without giving");
      }
      return *parameter;
    }

   private:
    TakingPromise& promise_;
  };
  Awaiter await_transform(const Taken<P>& /*taken*/) { return Awaiter(*this); }
  void set_parameter(const void* parameter) { parameter_ = static_cast<const P*>(parameter); }

 private:
  const P* parameter_ = nullptr;
};
template <class R>
class TakingPromise<R, void> {
 public:
  void set_parameter(const void* /*parameter*/) {}
  template <class Other>
  void await_transform(Other&& other) = delete;  // nothing here could resume it
};

/// What a generator function of a service returns: a coroutine that yields,
///
///   rr::Sequence<double> count(double limit) override {
///     for (double value = 0; value < limit; ++value) co_yield value;
///   }
///
/// that takes (`co_await rr::taken<P>`), or both; or a GeneratorOf of the program's own. A
/// coroutine runs up to its next co_yield or co_await in each step, from the first step on; it ends
/// by co_return, or by what it throws. It is destroyed where it waits when the client closes or
/// breaks off, or leaves. Its object lives as long. Parameters must be taken by value, since the
/// caller's are gone when the first step comes.
template <class R, class P = void>
class [[nodiscard]] Sequence {
 public:
  class promise_type : public YieldingPromise<R>, public TakingPromise<R, P> {
   public:
    Sequence get_return_object() {
      return Sequence(
          std::make_shared<Routine>(std::coroutine_handle<promise_type>::from_promise(*this)));
    }
    std::suspend_always initial_suspend() noexcept { return {}; }
    std::suspend_always final_suspend() noexcept { return {}; }
    void return_void() {}
    void unhandled_exception() { error_ = std::current_exception(); }
    std::exception_ptr take_error() { return std::exchange(error_, nullptr); }

   private:
    std::exception_ptr error_;
  };

  /// A generator of the program's own.
  template <std::derived_from<GeneratorOf<R, P>> Own>
  Sequence(std::shared_ptr<Own> source) : source_(std::move(source)) {}  // NOLINT

  [[nodiscard]] std::shared_ptr<GeneratorSource> source() && { return std::move(source_); }

 private:
  class Routine final : public GeneratorSource {
   public:
    explicit Routine(std::coroutine_handle<promise_type> coroutine) : coroutine_(coroutine) {}
    ~Routine() override { coroutine_.destroy(); }
    Routine(const Routine&) = delete;
    Routine& operator=(const Routine&) = delete;

    bool rr_step(const void* parameter, void* result) override {
      promise_type& promise = coroutine_.promise();
      promise.set_parameter(parameter);
      promise.set_result(result);
      coroutine_.resume();
      if (const std::exception_ptr error = promise.take_error()) std::rethrow_exception(error);
      return !coroutine_.done();
    }

   private:
    const std::coroutine_handle<promise_type> coroutine_;
  };

  explicit Sequence(std::shared_ptr<Routine> routine) : source_(std::move(routine)) {}

  std::shared_ptr<GeneratorSource> source_;
};

}  // namespace rr
