// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "rr/dynamic_service.hpp"

/// Definitions and values by chance: the same ones for the same seed, everywhere.
namespace rr::dynamic::testing {

/// Numbers by chance. The engine is specified to the bit; the standard's distributions are not.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  /// Of 0 to `count` - 1.
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(bits() % count); }
  bool one_in(std::size_t count) { return below(count) == 0; }
  template <class Items>
  const auto& pick(const Items& items) {
    return items[below(std::size(items))];
  }

 private:
  std::mt19937_64 engine_;
};

/// A definition with an enum, namedarrays, pods and structs of random fields, and an object
/// `Board`, which has for each of its types, by number: `property T pN`, what the service gives;
/// `property T qN`, where the client leaves what it got; `function T echoN(T value)`. It also has a
/// `wire T level` and a `memory T[] items`, `memory T[*] grid`, and `function string difference()`,
/// which says what of all that did not come back as it was given; nothing when all did.
class RandomDefinition {
 public:
  explicit RandomDefinition(std::uint64_t seed);
  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  /// As it spells them.
  [[nodiscard]] const std::vector<std::string>& types() const { return types_; }

 private:
  std::string number();
  std::string length();
  std::string array_of(const std::string& base);
  std::string pod_field();
  std::string any_type();
  void add_fields(std::size_t count, std::string (RandomDefinition::*type)());

  Chance chance_;
  const std::string name_;
  std::string text_;
  std::vector<std::string> namedarrays_;
  std::vector<std::string> pods_;
  std::vector<std::string> structs_;
  std::vector<std::string> types_;
};

/// Values of any type by chance, limits and what is no number among them.
class RandomValues {
 public:
  RandomValues(std::uint64_t seed, const Definitions& definitions)
      : chance_(seed), definitions_(definitions) {}
  Value value(const ValueType& type, int depth = 0);

 private:
  Value number(ElementType type);
  Value array(const ValueType& type);
  std::vector<std::uint32_t> dims();
  std::string text();
  Value any(int depth);
  List list(const ValueType& item, std::size_t count, int depth);

  Chance chance_;
  const Definitions definitions_;
};

/// The object `Board` of a random definition, with values by chance.
ServedObject random_board(const RandomDefinition& definition, std::uint64_t seed);

}  // namespace rr::dynamic::testing
