// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "rr/error.hpp"

/// What generated Default classes stand on.
namespace rr {

/// A property's value. May be read and set from any threads at once.
template <class T>
class Stored {
 public:
  Stored() = default;
  explicit Stored(T value) : value_(std::move(value)) {}

  [[nodiscard]] T get() const {
    const std::lock_guard lock(mutex_);
    return value_;
  }
  void set(T value) {
    const std::lock_guard lock(mutex_);
    std::swap(value_, value);
  }

 private:
  mutable std::mutex mutex_;
  T value_{};
};

/// Throws the error of a function that a Default class does not have (not_implemented_error).
[[noreturn]] inline void throw_not_implemented(std::string_view member) {
  throw Error(ErrorCode::not_implemented_error,
              std::string(member) + " is not implemented by this object");
}
/// Throws the error of an objref at which there is nothing (object_not_found).
[[noreturn]] inline void throw_no_object(std::string_view member) {
  throw Error(ErrorCode::object_not_found, "there is no object at " + std::string(member));
}

}  // namespace rr
