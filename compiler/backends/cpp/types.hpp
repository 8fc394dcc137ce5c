// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <set>
#include <string>

#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/cpp/view.hpp"
#include "compiler/model/model.hpp"

/// How the types of a definition are written in C++: the table in rr/type.hpp, as code.
namespace robdef::cpp {

/// Larger arrays of a fixed or bounded length are not stored in place.
inline constexpr std::uint64_t in_place_limit = 16 * 1024;
/// Items of containers are always stored in place, and cannot be larger than this.
inline constexpr std::uint64_t item_limit = 1024 * 1024;

/// A type as generated code writes it.
struct CppType {
  std::string text;  ///< of the value: `::std::array<double, 6>`
  std::string
      descriptor;  ///< what type_of is asked for: mostly the same, else FixedLength and so on
  InitialView initial = {};  ///< of a variable, so that it has a value that may be sent
  bool is_by_value = false;  ///< as a parameter: what is cheap to copy
};

/// Where a type stands.
struct Place {
  const std::set<std::string>* hidden = nullptr;  ///< names of the class around it
  const model::Record* record = nullptr;          ///< for a field: whose
};

/// Writes types in one definition's namespace, and notes the headers that they need.
class Types {
 public:
  explicit Types(const Names& names) : names_(names) {}

  CppType spell(const model::Type& type, const Place& place);

  /// `double`, `::std::int32_t`, ...; `void` for void.
  std::string number(model::Primitive primitive);
  void include(const std::string& header) { headers_.insert(header); }
  /// In angle brackets: `<cstdint>`, `<rr/complex.hpp>`.
  [[nodiscard]] const std::set<std::string>& headers() const { return headers_; }

 private:
  CppType base(const model::Type& type, const Place& place);
  CppType array(const CppType& item, const model::Type& type, const Place& place);
  CppType container(CppType item, model::ContainerForm form);

  const Names& names_;
  std::set<std::string> headers_;
};

/// Bytes of one value in memory; what is not stored in place counts as a pointer.
std::uint64_t storage_size(const model::Type& type);

/// True when a record that a field of `from` holds can itself hold a `from`.
bool closes_cycle(const model::Record& from, const model::Record& to);

}  // namespace robdef::cpp
