// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <coroutine>
#include <cstdint>
#include <exception>
#include <iterator>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "rr/definition.hpp"
#include "rr/stub.hpp"

/// Generators: functions that give, or take, values one after the other (07, section 8).
namespace rr {

/// A generator on another node, without its types. Copies are handles of the same one.
class GeneratorHandle {
 public:
  GeneratorHandle() = default;
  /// Tells the service that no more steps are wanted; it ends its work in order. Nothing happens
  /// when the generator has ended already. Throws rr::Error.
  void close();
  /// Tells the service to break off.
  void abort();

  struct State;  // internal
  explicit GeneratorHandle(std::shared_ptr<State> state) : state_(std::move(state)) {}

 protected:
  /// One step: `parameter` is null where none is taken, `result` where none is given. False when
  /// the generator has ended. Throws what the service throws, after which it has ended too.
  bool step(const void* parameter, void* result);

  std::shared_ptr<State> state_;
};

/// A generator on another node: R what each step gives, P what it takes; either may be void.
template <class R, class P = void>
class Generator : public GeneratorHandle {
 public:
  using GeneratorHandle::GeneratorHandle;

  /// The next value; nothing at the end. Throws what the service throws.
  std::optional<R> next(const P& parameter) {
    R result{};
    if (!step(&parameter, &result)) return std::nullopt;
    return result;
  }
  template <class Token>
  auto async_next(const P& parameter, Token&& token);
};

template <class P>
class Generator<void, P> : public GeneratorHandle {
 public:
  using GeneratorHandle::GeneratorHandle;

  /// Gives the service the next value. False when it takes no more.
  bool next(const P& parameter) { return step(&parameter, nullptr); }
  template <class Token>
  auto async_next(const P& parameter, Token&& token);
};

template <class R>
class Generator<R, void> : public GeneratorHandle {
 public:
  using GeneratorHandle::GeneratorHandle;

  std::optional<R> next() {
    R result{};
    if (!step(nullptr, &result)) return std::nullopt;
    return result;
  }
  template <class Token>
  auto async_next(Token&& token);
  /// All values that are left.
  std::vector<R> all() {
    std::vector<R> values;
    while (auto value = next()) values.push_back(std::move(*value));
    return values;
  }

  /// For `for (const auto& value : stub->count(5))`: one pass.
  class Iterator {
   public:
    using iterator_category = std::input_iterator_tag;
    using value_type = R;
    using difference_type = std::ptrdiff_t;
    using pointer = const R*;
    using reference = const R&;

    Iterator() = default;
    explicit Iterator(Generator& generator) : generator_(&generator) { ++*this; }
    reference operator*() const { return *value_; }
    pointer operator->() const { return &*value_; }
    Iterator& operator++() {
      value_ = generator_->next();
      return *this;
    }
    void operator++(int) { ++*this; }
    friend bool operator==(const Iterator& it, std::default_sentinel_t) { return !it.value_; }

   private:
    Generator* generator_ = nullptr;
    std::optional<R> value_;
  };
  Iterator begin() { return Iterator(*this); }
  std::default_sentinel_t end() const { return {}; }
};

/// What a service gives for one call of a generator function, without its types. Steps come one at
/// a time, on a thread of the node.
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

/// Waits in a coroutine for what the next step takes: `const P p = co_await rr::taken<P>;`
template <class P>
struct Taken {};
template <class P>
inline constexpr Taken<P> taken{};

/// What a generator function of a service returns: a coroutine that yields,
///
///   rr::Sequence<double> count(double limit) override {
///     for (double value = 0; value < limit; ++value) co_yield value;
///   }
///
/// that takes (`co_await rr::taken<P>`), or both; or a GeneratorSource of the program's own. A
/// coroutine is destroyed when the client closes or breaks off, or leaves.
template <class R, class P = void>
class Sequence;

}  // namespace rr
