// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// A function object by its signature; see Function<R(Arguments...)>.
template <class Signature>
class Function;

/// Something that can be called: what a program gives the runtime to call later. Takes lambdas that
/// cannot be copied, too; copies share what was given. In place of std::function, whose header
/// would be a tenth of what a generated header includes.
template <class R, class... Arguments>
class Function<R(Arguments...)> {
 public:
  /// Empty; as is one made from an empty std::function or a null pointer.
  Function() = default;
  /// Empty.
  Function(std::nullptr_t) {}
  /// Keeps `callable`.
  template <class Callable>
  requires(!std::is_same_v<std::remove_cvref_t<Callable>, Function> &&
           std::is_invocable_r_v<R, std::decay_t<Callable>&, Arguments...>)
      Function(Callable&& callable) {
    using Held = HeldTarget<std::decay_t<Callable>>;
    if (!is_empty(callable)) target_ = std::make_shared<Held>(std::forward<Callable>(callable));
  }

  /// Whether it can be called.
  explicit operator bool() const { return target_ != nullptr; }
  /// Not when empty.
  R operator()(Arguments... arguments) const {
    return target_->call(std::forward<Arguments>(arguments)...);
  }

 private:
  struct Target {
    virtual ~Target() = default;
    virtual R call(Arguments... arguments) = 0;
  };
  template <class Callable>
  struct HeldTarget final : Target {
    explicit HeldTarget(const Callable& given) : callable(given) {}
    explicit HeldTarget(Callable&& given) : callable(std::move(given)) {}
    R call(Arguments... arguments) override {
      if constexpr (std::is_void_v<R>) {
        callable(std::forward<Arguments>(arguments)...);
      } else {
        return callable(std::forward<Arguments>(arguments)...);
      }
    }
    Callable callable;
  };
  template <class Callable>
  static bool is_empty(const Callable& callable) {
    if constexpr (std::is_pointer_v<Callable> || requires { callable.operator bool(); }) {
      return !callable;
    } else {
      return false;
    }
  }

  std::shared_ptr<Target> target_;
};

}  // namespace rr
