// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "rr/definition.hpp"
#include "rr/sequence.hpp"
#include "rr/stub.hpp"
#include "rr/visibility.hpp"

/// Generators: functions that give, or take, values one after the other (07, section 8). What a
/// service returns is in rr/sequence.hpp.
namespace RR_VISIBLE rr {

/// Where a step of a generator leaves its result.
class GeneratorStep : public Completion {
 public:
  /// Instead of succeed(): the generator has ended.
  virtual void stop() = 0;
};

/// A generator on another node, without its types. Copies are handles of the same one; when the
/// last goes away before the end, the service is told as by close(), without waiting. May be used
/// from several threads: the service takes the steps one after the other.
class GeneratorHandle {
 public:
  /// No generator: using it throws rr::Error (invalid_operation).
  GeneratorHandle() = default;
  /// Tells the service that no more steps are wanted; it ends its work in order. Nothing happens
  /// when the generator has ended already. Throws rr::Error.
  void close(const CallOptions& options = {}) { end(false, options); }
  /// Tells the service to break off.
  void abort(const CallOptions& options = {}) { end(true, options); }
  /// The same with a completion token, see rr/async.hpp. Signature: void(std::exception_ptr).
  template <class Token>
  auto async_close(const CallOptions& options, Token&& token) {
    return async_end(false, options, std::forward<Token>(token));
  }
  /// As close(), with the node's time-out.
  template <class Token>
  auto async_close(Token&& token) {
    return async_close(CallOptions(), std::forward<Token>(token));
  }
  /// As abort(), with a completion token. Signature: void(std::exception_ptr).
  template <class Token>
  auto async_abort(const CallOptions& options, Token&& token) {
    return async_end(true, options, std::forward<Token>(token));
  }
  /// As abort(), with a completion token and the node's time-out.
  template <class Token>
  auto async_abort(Token&& token) {
    return async_abort(CallOptions(), std::forward<Token>(token));
  }

  /// For the runtime: a handle of a generator that was opened.
  explicit GeneratorHandle(std::shared_ptr<GeneratorState> state) : state_(std::move(state)) {}

 protected:
  /// One step: `parameter` is null where none is taken, `result` where none is given. False when
  /// the generator has ended. Throws what the service throws, after which it has ended too.
  bool step(const void* parameter, void* result, const CallOptions& options = {});
  /// Steps until the end: each leaves a value of `size` bytes at `value`, which `keep` takes.
  /// Throws rr::Error: out_of_system_resource when all of them are more than the service may make
  /// this client hold.
  void collect(void* value, std::size_t size, const std::function<void()>& keep,
               const CallOptions& options = {});
  /// Begins a step; `step` gets its result, or the end.
  static void start_step(const std::shared_ptr<GeneratorState>& state, const void* parameter,
                         std::unique_ptr<GeneratorStep> step);
  /// What close() and abort() stand on.
  void end(bool aborts, const CallOptions& options = {});
  /// The same without waiting.
  static void start_end(const std::shared_ptr<GeneratorState>& state, bool aborts,
                        std::unique_ptr<Completion> completion);
  /// What async_close() and async_abort() stand on.
  template <class Token>
  auto async_end(bool aborts, const CallOptions& options, Token&& token);

  /// null for no generator
  std::shared_ptr<GeneratorState> state_;
};

/// A generator on another node: R what each step gives, P what it takes; either may be void.
///
/// The first step that finds the end says so: nothing, or false. A step after the end is refused by
/// the service: invalid_operation. After close() one more step finds the end, after abort()
/// operation_aborted.
template <class R, class P = void>
class Generator : public GeneratorHandle {
 public:
  /// For the runtime: a handle of a generator that was opened.
  using GeneratorHandle::GeneratorHandle;

  /// The next value; nothing at the end. Throws what the service throws.
  std::optional<R> next(const P& parameter, const CallOptions& options = {}) {
    R result{};
    if (!step(&parameter, &result, options)) return std::nullopt;
    return result;
  }
  /// Signature: void(std::exception_ptr, std::optional<R>).
  template <class Token>
  auto async_next(const P& parameter, const CallOptions& options, Token&& token);
  /// As above, with the client's time-out.
  template <class Token>
  auto async_next(const P& parameter, Token&& token) {
    return async_next(parameter, CallOptions(), std::forward<Token>(token));
  }
};

/// A generator that takes values and gives none.
template <class P>
class Generator<void, P> : public GeneratorHandle {
 public:
  /// For the runtime: a handle of a generator that was opened.
  using GeneratorHandle::GeneratorHandle;

  /// Gives the service the next value. False when it takes no more.
  bool next(const P& parameter, const CallOptions& options = {}) {
    return step(&parameter, nullptr, options);
  }
  /// Signature: void(std::exception_ptr, bool).
  template <class Token>
  auto async_next(const P& parameter, const CallOptions& options, Token&& token);
  /// As above, with the client's time-out.
  template <class Token>
  auto async_next(const P& parameter, Token&& token) {
    return async_next(parameter, CallOptions(), std::forward<Token>(token));
  }
};

/// A generator that gives values and takes none.
template <class R>
class Generator<R, void> : public GeneratorHandle {
 public:
  /// For the runtime: a handle of a generator that was opened.
  using GeneratorHandle::GeneratorHandle;

  /// The next value; nothing at the end. Throws what the service throws.
  std::optional<R> next(const CallOptions& options = {}) {
    R result{};
    if (!step(nullptr, &result, options)) return std::nullopt;
    return result;
  }
  /// As next(), with a completion token. Signature: void(std::exception_ptr, std::optional<R>).
  template <class Token>
  auto async_next(const CallOptions& options, Token&& token);
  /// As above, with the client's time-out.
  template <class Token>
  auto async_next(Token&& token) {
    return async_next(CallOptions(), std::forward<Token>(token));
  }
  /// All values that are left. Throws rr::Error: out_of_system_resource when they are more than
  /// Budget::client_session together; next() has no such limit. A time-out is for each step.
  std::vector<R> all(const CallOptions& options = {}) {
    std::vector<R> values;
    R value{};
    collect(
        &value, sizeof value, [&] { values.push_back(std::exchange(value, R{})); }, options);
    return values;
  }

  /// For `for (const auto& value : stub->count(5))`: one pass.
  class Iterator {
   public:
    /// As the standard library wants it.
    using iterator_category = std::input_iterator_tag;
    /// The type of a value.
    using value_type = R;
    /// As the standard library wants it.
    using difference_type = std::ptrdiff_t;
    /// Points to the value of the step that was made last.
    using pointer = const R*;
    /// Refers to the value of the step that was made last.
    using reference = const R&;

    /// At the end.
    Iterator() = default;
    /// Makes the first step, a call.
    explicit Iterator(Generator& generator) : generator_(&generator) { ++*this; }
    /// The value of the step that was made last. Not at the end.
    reference operator*() const { return *value_; }
    /// The value of the step that was made last. Not at the end.
    pointer operator->() const { return &*value_; }
    /// Makes the next step, a call. Throws what the service throws.
    Iterator& operator++() {
      value_ = generator_->next();
      return *this;
    }
    /// Makes the next step, a call.
    void operator++(int) { ++*this; }
    /// Whether the generator has come to its end.
    friend bool operator==(const Iterator& it, std::default_sentinel_t) { return !it.value_; }

   private:
    Generator* generator_ = nullptr;
    std::optional<R> value_;
  };
  /// Makes the first step. Once: values that were got do not come again.
  Iterator begin() { return Iterator(*this); }
  /// Compares equal at the end.
  std::default_sentinel_t end() const { return {}; }
};

template <class R, class P, class... Arguments>
Generator<R, P> Stub::rr_generate(const Member& member, const CallOptions& options,
                                  const Arguments&... arguments) {
  const CallOptionsScope scope(options);
  const void* const values[] = {&arguments..., nullptr};
  return Generator<R, P>(rr_open_generator(member, values));
}

}  // namespace rr
