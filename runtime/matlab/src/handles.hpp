// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rr/error.hpp"

namespace rr::matlab {

/// What the interpreter holds by a number.
class Handled {
 public:
  Handled() = default;
  virtual ~Handled() = default;
  Handled(const Handled&) = delete;
  Handled& operator=(const Handled&) = delete;
};

/// Numbers for what the interpreter holds. A number that was given back is not used again: its
/// upper half is the generation, which goes up with each. For the interpreter's thread.
class Handles {
 public:
  /// Numbers of generations up to this one may still be held by somebody.
  explicit Handles(std::uint32_t generation) : generation_(generation) {}
  /// Never 0.
  std::uint64_t add(std::shared_ptr<Handled> object);
  /// Throws rr::Error (invalid_operation) for a number that is none, any more, or of a thing of
  /// another kind.
  template <class T>
  [[nodiscard]] std::shared_ptr<T> get(std::uint64_t number) const {
    auto object = std::dynamic_pointer_cast<T>(find(number));
    if (!object) refuse();
    return object;
  }
  /// Gives a number back; what it was of goes with the last who uses it. Nothing happens for a
  /// number that is none.
  void remove(std::uint64_t number);
  void clear();
  /// The newest.
  [[nodiscard]] std::uint32_t generation() const { return generation_; }
  /// How many there are.
  [[nodiscard]] std::size_t size() const;

 private:
  struct Place {
    std::uint32_t generation = 0;
    std::shared_ptr<Handled> object;
  };
  [[nodiscard]] std::shared_ptr<Handled> find(std::uint64_t number) const;
  [[nodiscard]] static std::size_t index_of(std::uint64_t number) { return number & 0xffffffff; }
  [[noreturn]] static void refuse();

  std::uint32_t generation_;
  std::vector<Place> places_;
  std::vector<std::size_t> free_;
};

}  // namespace rr::matlab
