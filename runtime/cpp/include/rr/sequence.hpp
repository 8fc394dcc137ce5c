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
  /// The client breaks off; no step follows.
  virtual void rr_abort() {}
};

/// A generator written by hand: R what each step gives, P what it takes; either may be void. It is
/// let go when it has ended, when the client closes it or breaks off, when the client leaves, when
/// its object is released, and when it was not used for NodeOptions::generator_timeout.
template <class R, class P = void>
class GeneratorOf : public GeneratorSource {
 public:
  /// The next value; nothing at the end. What it throws is sent, and ends the generator.
  virtual std::optional<R> next(const P& parameter) = 0;
  /// The client wants no more, or breaks off. Not called when it leaves.
  virtual void close() {}
  /// The client breaks off. Not called when it leaves.
  virtual void abort() {}

  /// Calls next().
  bool rr_step(const void* parameter, void* result) final {
    std::optional<R> value = next(*static_cast<const P*>(parameter));
    if (value) *static_cast<R*>(result) = std::move(*value);
    return value.has_value();
  }
  /// Calls close().
  void rr_close() final { close(); }
  /// Calls abort().
  void rr_abort() final { abort(); }
};

/// A generator written by hand that takes values and gives none.
template <class P>
class GeneratorOf<void, P> : public GeneratorSource {
 public:
  /// Takes a value; false when it is the last, which then has not been taken.
  virtual bool next(const P& parameter) = 0;
  /// The client wants no more steps. Not called when it leaves.
  virtual void close() {}
  /// The client breaks off. Not called when it leaves.
  virtual void abort() {}

  /// Calls next().
  bool rr_step(const void* parameter, void* /*result*/) final {
    return next(*static_cast<const P*>(parameter));
  }
  /// Calls close().
  void rr_close() final { close(); }
  /// Calls abort().
  void rr_abort() final { abort(); }
};

/// A generator written by hand that gives values and takes none.
template <class R>
class GeneratorOf<R, void> : public GeneratorSource {
 public:
  /// The next value; nothing at the end. What it throws is sent, and ends the generator.
  virtual std::optional<R> next() = 0;
  /// The client wants no more steps. Not called when it leaves.
  virtual void close() {}
  /// The client breaks off. Not called when it leaves.
  virtual void abort() {}

  /// Calls next().
  bool rr_step(const void* /*parameter*/, void* result) final {
    std::optional<R> value = next();
    if (value) *static_cast<R*>(result) = std::move(*value);
    return value.has_value();
  }
  /// Calls close().
  void rr_close() final { close(); }
  /// Calls abort().
  void rr_abort() final { abort(); }
};

/// Waits in a coroutine for what the next step takes: `const P p = co_await rr::taken<P>;`
template <class P>
struct Taken {};
/// What a coroutine waits for to get what the next step takes: `const P p = co_await rr::taken<P>;`
template <class P>
inline constexpr Taken<P> taken{};

/// The parts of a coroutine's promise that depend on what a step gives and takes.
template <class R>
class YieldingPromise {
 public:
  /// `co_yield value`: the step gives a copy of it.
  std::suspend_always yield_value(const R& value) {
    *result_ = value;  // NOLINT(clang-analyzer-*): the step has set it
    return {};
  }
  /// `co_yield value`: the step gives it.
  std::suspend_always yield_value(R&& value) {
    *result_ = std::move(value);  // NOLINT(clang-analyzer-*): the step has set it
    return {};
  }
  /// For the runtime: where the next step's result goes.
  void set_result(void* result) { result_ = static_cast<R*>(result); }

 private:
  R* result_ = nullptr;
};
/// The part of a coroutine that gives nothing.
template <>
class YieldingPromise<void> {
 public:
  /// For the runtime: there is no result.
  void set_result(void* /*result*/) {}
};

/// The part of a coroutine that takes values.
template <class R, class P>
class TakingPromise {
 public:
  /// What `co_await rr::taken<P>` waits with. A step that must give a value does not end by waiting
  /// for one.
  class Awaiter {
   public:
    /// Waits for what the next step takes.
    explicit Awaiter(TakingPromise& promise) : promise_(promise) {}
    /// As coroutines want it.
    [[nodiscard]] bool await_ready() const {
      return promise_.parameter_ != nullptr || !std::is_void_v<R>;  // NOLINT(clang-analyzer-*)
    }
    /// As coroutines want it.
    void await_suspend(std::coroutine_handle<> /*coroutine*/) const {}
    /// What the step takes. Throws rr::Error (internal_error) when a generator that gives values
    /// takes twice without giving one.
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
  /// As coroutines want it.
  Awaiter await_transform(const Taken<P>& /*taken*/) { return Awaiter(*this); }
  /// For the runtime: what the next step takes.
  void set_parameter(const void* parameter) { parameter_ = static_cast<const P*>(parameter); }

 private:
  const P* parameter_ = nullptr;
};
/// The part of a coroutine that takes nothing.
template <class R>
class TakingPromise<R, void> {
 public:
  /// For the runtime: nothing is taken.
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
  /// The promise of a coroutine, as the language wants it.
  class promise_type : public YieldingPromise<R>, public TakingPromise<R, P> {
   public:
    /// As coroutines want it.
    Sequence get_return_object() {
      return Sequence(
          std::make_shared<Routine>(std::coroutine_handle<promise_type>::from_promise(*this)));
    }
    /// As coroutines want it: the first step begins the function.
    std::suspend_always initial_suspend() noexcept { return {}; }
    /// As coroutines want it.
    std::suspend_always final_suspend() noexcept { return {}; }
    /// As coroutines want it.
    void return_void() {}
    /// Keeps what the function has thrown for the step that runs.
    void unhandled_exception() { error_ = std::current_exception(); }
    /// What the function has thrown; null for nothing.
    std::exception_ptr take_error() { return std::exchange(error_, nullptr); }

   private:
    std::exception_ptr error_;
  };

  /// A generator of the program's own.
  template <std::derived_from<GeneratorOf<R, P>> Own>
  Sequence(std::shared_ptr<Own> source) : source_(std::move(source)) {}  // NOLINT

  /// For the runtime: the generator, taken out of this.
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
