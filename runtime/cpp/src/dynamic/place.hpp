// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rr::dynamic {

class Tables;

/// Where in a value something is: only spelt out when something is wrong there. A chain of frames
/// on the stack.
class Place {
 public:
  /// `subject` is what the value is of: `member pose`; may be empty. For a value that was JSON,
  /// more is understood, and named types are found in `json_types`.
  explicit Place(std::string_view subject, const Tables* json_types = nullptr)
      : name_(subject), json_types_(json_types) {}
  [[nodiscard]] Place field(std::string_view name) const { return {this, name, 0, Step::field}; }
  [[nodiscard]] Place item(std::size_t index) const { return {this, {}, index, Step::item}; }
  [[nodiscard]] Place key(std::string_view name) const { return {this, name, 0, Step::key}; }

  [[nodiscard]] bool is_json() const { return json_types_ != nullptr; }
  [[nodiscard]] const Tables* json_types() const { return json_types_; }
  [[nodiscard]] bool is_too_deep() const { return depth_ > deepest; }
  /// `member pose, field q[2]`; empty for the whole of a value of nothing.
  [[nodiscard]] std::string text() const;
  /// Throws rr::Error (data_type_mismatch): `<place>: <what>`.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  enum class Step { subject, field, item, key };
  static constexpr int deepest = 64;  // as on the wire

  Place(const Place* outer, std::string_view name, std::size_t index, Step step)
      : outer_(outer),
        name_(name),
        index_(index),
        step_(step),
        json_types_(outer->json_types_),
        depth_(outer->depth_ + 1) {}

  const Place* outer_ = nullptr;
  std::string_view name_;
  std::size_t index_ = 0;
  Step step_ = Step::subject;
  const Tables* json_types_ = nullptr;
  int depth_ = 0;
};

}  // namespace rr::dynamic
