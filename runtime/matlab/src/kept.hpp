// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <utility>

namespace rr::matlab {

/// A value of the interpreter's that outlives the call in which it was given: a function handle, a
/// parameter. For the interpreter's thread, its end included.
class Kept {
 public:
  Kept() = default;
  explicit Kept(const mxArray* value) : value_(mxDuplicateArray(value)) {
    mexMakeArrayPersistent(value_);
  }
  Kept(Kept&& other) noexcept : value_(std::exchange(other.value_, nullptr)) {}
  Kept& operator=(Kept&& other) noexcept {
    std::swap(value_, other.value_);
    return *this;
  }
  ~Kept() {
    if (value_ != nullptr) mxDestroyArray(value_);
  }
  Kept(const Kept&) = delete;
  Kept& operator=(const Kept&) = delete;

  /// Null for none.
  [[nodiscard]] mxArray* get() const { return value_; }
  /// Lets go of the value without an end to it: when the interpreter ends, what is in it must not
  /// call functions any more.
  void abandon() { value_ = nullptr; }
  explicit operator bool() const { return value_ != nullptr; }

 private:
  mxArray* value_ = nullptr;
};

}  // namespace rr::matlab
