// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "rr/error.hpp"
#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// Remembers the first thing that went wrong while a message is read or written. The layers that
/// touch bytes never throw; the caller that started them looks here at the end.
class Latch {
 public:
  /// Latches a failure unless there is one already: the protocol's code for it, what is wrong (a
  /// literal), and the name of the element at fault (copied, cut to 63 bytes). Returns false.
  bool fail(ErrorCode code, const char* what, std::string_view element = {}) noexcept {
    if (code_ != ErrorCode::none) return false;
    code_ = code;
    what_ = what;
    const std::size_t size =
        element.size() < sizeof element_ - 1 ? element.size() : sizeof element_ - 1;
    if (size != 0) std::memcpy(element_, element.data(), size);
    element_[size] = '\0';
    return false;
  }
  /// Whether something went wrong.
  [[nodiscard]] bool failed() const noexcept { return code_ != ErrorCode::none; }
  /// The protocol's code of the first failure; none without one.
  [[nodiscard]] ErrorCode code() const noexcept { return code_; }
  /// "what: element `name`"; empty without a failure.
  [[nodiscard]] std::string message() const;
  /// Forgets the failure, so that the latch can be used again.
  void clear() noexcept { code_ = ErrorCode::none; }

  /// Values inside values are read and written by recursion; this bounds it: so many elements may
  /// lie in each other, and the innermost in them (Limits::deepest in all). False, with the failure
  /// latched, below that; ascend() undoes it in either case.
  static constexpr std::uint32_t depth_limit = 63;
  /// Enters an element that holds others.
  bool descend(std::string_view element) noexcept {
    if (++depth_ <= depth_limit) [[likely]]
      return true;
    return fail(ErrorCode::protocol_error, "values nested too deep", element);
  }
  /// Leaves an element that descend() has entered.
  void ascend() noexcept { --depth_; }

 private:
  ErrorCode code_ = ErrorCode::none;
  std::uint32_t depth_ = 0;
  const char* what_ = "";
  char element_[64];  // left uninitialized: written with the code
};

/// One element with others in it, for as long as they are read or written.
class Descent {
 public:
  /// Enters an element called `element`. The latch must outlive this.
  Descent(Latch& latch, std::string_view element)
      : latch_(&latch), allowed_(latch.descend(element)) {}
  Descent(const Descent&) = delete;
  Descent& operator=(const Descent&) = delete;
  ~Descent() { latch_->ascend(); }
  /// False when it is nested too deep: a failure is latched then.
  explicit operator bool() const { return allowed_; }

 private:
  Latch* latch_;
  bool allowed_;
};

}  // namespace rr
