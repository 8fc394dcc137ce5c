// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <exception>
#include <string>
#include <string_view>
#include <utility>

#include "rr/error.hpp"

namespace rr::matlab {

/// A value of the interpreter's that is not of the type that is needed. On its way out it collects
/// where it was, spelled as the user would: `.q(3)`, `{2}`, `('key')`.
class Misfit final : public std::exception {
 public:
  explicit Misfit(std::string what) : what_(std::move(what)) {}

  void enter_field(std::string_view name) { place_.insert(0, "." + std::string(name)); }
  /// `index` counts from 0.
  void enter_item(std::size_t index) { place_.insert(0, "(" + std::to_string(index + 1) + ")"); }
  void enter_cell(std::size_t index) { place_.insert(0, "{" + std::to_string(index + 1) + "}"); }
  void enter_key(std::string_view key) { place_.insert(0, "('" + std::string(key) + "')"); }

  /// DataTypeMismatch: `member pose.q(3): expected double, got char`.
  [[nodiscard]] Error error(std::string_view subject) const {
    const std::string place = std::string(subject) + place_;
    return {ErrorCode::data_type_mismatch, place.empty() ? what_ : place + ": " + what_};
  }
  [[nodiscard]] const char* what() const noexcept override { return what_.c_str(); }

 private:
  std::string what_;
  std::string place_;
};

// Each returns what `read()` does; a Misfit of it is told where it was.

template <class Read>
decltype(auto) in_field(std::string_view name, Read&& read) {
  try {
    return read();
  } catch (Misfit& misfit) {
    misfit.enter_field(name);
    throw;
  }
}

template <class Read>
decltype(auto) in_item(std::size_t index, Read&& read) {
  try {
    return read();
  } catch (Misfit& misfit) {
    misfit.enter_item(index);
    throw;
  }
}

template <class Read>
decltype(auto) in_cell(std::size_t index, Read&& read) {
  try {
    return read();
  } catch (Misfit& misfit) {
    misfit.enter_cell(index);
    throw;
  }
}

template <class Read>
decltype(auto) in_key(std::string_view key, Read&& read) {
  try {
    return read();
  } catch (Misfit& misfit) {
    misfit.enter_key(key);
    throw;
  }
}

/// The same at the border of a call: throws rr::Error that begins with `subject`.
template <class Read>
decltype(auto) as_subject(std::string_view subject, Read&& read) {
  try {
    return read();
  } catch (const Misfit& misfit) {
    throw misfit.error(subject);
  }
}

}  // namespace rr::matlab
