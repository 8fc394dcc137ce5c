// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compiler/backends/arduino/limits.hpp"
#include "compiler/model/model.hpp"

/// How types are written in a sketch, and how many bytes their values have in a frame.
namespace robdef::arduino {

/// Bytes of values in one message: docs/reference/serial-protocol.md.
inline constexpr std::uint64_t message_limit = 246;

struct BoardType {
  std::string text;          ///< `rr::Bounded<double, 8>`; empty for void and for what was refused
  std::uint64_t size = 0;    ///< bytes of the longest value
  bool is_by_value = false;  ///< as a parameter
  bool has_double = false;   ///< needs numbers of eight bytes to be converted

  [[nodiscard]] std::string passed() const { return is_by_value ? text : "const " + text + "&"; }
};

/// Where a type stands, for what is reported.
struct TypePlace {
  const Limits& limits;
  std::string limit_name;  ///< what a limit for it is called, empty for the value itself
};

/// Writes types, and refuses what a board cannot hold.
class BoardTypes {
 public:
  explicit BoardTypes(Report& report) : report_(report) {}

  BoardType spell(const model::Type& type, const TypePlace& place);
  /// Structs, pods and namedarrays that were spelled and what they contain, contents first.
  [[nodiscard]] const std::vector<const model::Record*>& records() const { return records_; }
  /// Refuses values of a message that are too long together.
  void check_size(std::uint64_t size, Span span, std::string_view what);

 private:
  BoardType base(const model::Type& type, const TypePlace& place);
  BoardType record(const model::Record& record, Span span);
  void refuse(Span span, const std::string& what, const std::string& hint);
  void need_limit(const model::Type& type, const std::string& what, const TypePlace& place);

  Report& report_;
  std::vector<const model::Record*> records_;
  std::vector<std::pair<const model::Record*, BoardType>> known_;
};

}  // namespace robdef::arduino
