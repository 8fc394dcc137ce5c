// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/testing/random_definition.hpp"

#include <array>

#include "rr/number.hpp"

namespace rr::dynamic::testing {
namespace {

constexpr std::array number_words = {"double",  "single",  "int8",   "uint8", "int16",
                                     "uint16",  "int32",   "uint32", "int64", "uint64",
                                     "cdouble", "csingle", "bool"};
constexpr std::size_t type_count = 6;

}  // namespace

RandomDefinition::RandomDefinition(std::uint64_t seed)
    : chance_(seed), name_("random.d" + std::to_string(seed)) {
  text_ = "service " + name_ + "\n\nstdver 0.10\n\nenum Mode\n    first = 0";
  for (std::size_t i = chance_.below(4); i > 0; --i) {
    text_ += ",\n    value" + std::to_string(i) + " = " +
             std::to_string(static_cast<std::int32_t>(chance_.bits()));
  }
  text_ += "\nend\n";
  const std::string word = number();
  for (const std::string name : {"Inner", "Outer"}) {
    text_ += "\nnamedarray " + name + "\n";
    for (std::size_t i = chance_.below(3) + 1; i > 0; --i) {
      const bool is_nested = !namedarrays_.empty() && chance_.one_in(2);
      text_ += "    field " + (is_nested ? namedarrays_.front() : word) +
               (chance_.one_in(3) ? length() : "") + " f" + std::to_string(i) + "\n";
    }
    text_ += "end\n";
    namedarrays_.push_back(name);
  }
  for (const std::string name : {"Sample", "Burst"}) {
    text_ += "\npod " + name + "\n";
    add_fields(chance_.below(4) + 1, &RandomDefinition::pod_field);
    pods_.push_back(name);
  }
  for (const std::string name : {"Note", "Report"}) {
    text_ += "\nstruct " + name + "\n";
    if (name == "Report" && chance_.one_in(2)) structs_.push_back(name);
    add_fields(chance_.below(5) + 1, &RandomDefinition::any_type);
    if (structs_.empty() || structs_.back() != name) structs_.push_back(name);
  }
  text_ += "\nobject Board\n";
  for (std::size_t i = 0; i < type_count; ++i) {
    const std::string type = any_type();
    const std::string number = std::to_string(i);
    text_ += "    property " + type + " p" + number + "\n    property " + type + " q" + number +
             "\n    function " + type + " echo" + number + "(" + type + " value)\n";
    types_.push_back(type);
  }
  std::vector<std::string> fixed(number_words.begin(), number_words.end());
  fixed.insert(fixed.end(), pods_.begin(), pods_.end());
  fixed.insert(fixed.end(), namedarrays_.begin(), namedarrays_.end());
  text_ += "    wire " + any_type() + " level\n    memory " + chance_.pick(fixed) +
           "[] items\n    memory " + chance_.pick(fixed) +
           "[*] grid\n    function string difference()\nend\n";
}

std::string RandomDefinition::number() { return chance_.pick(number_words); }

std::string RandomDefinition::length() { return "[" + std::to_string(chance_.below(4) + 1) + "]"; }

std::string RandomDefinition::array_of(const std::string& base) {
  const std::string some = std::to_string(chance_.below(3) + 2);
  const std::array forms = {std::string("[]"), length(), "[" + some + "-]", std::string("[*]"),
                            "[2," + some + "]"};
  return base + chance_.pick(forms);
}

std::string RandomDefinition::pod_field() {
  std::string base = number();
  if (!pods_.empty() && chance_.one_in(4)) base = chance_.pick(pods_);
  if (chance_.one_in(4)) base = chance_.pick(namedarrays_);
  const std::string some = std::to_string(chance_.below(3) + 2);
  const std::array forms = {std::string(), std::string(), length(), "[" + some + "-]",
                            "[" + some + ",2]"};
  return base + chance_.pick(forms);
}

std::string RandomDefinition::any_type() {
  constexpr std::array containers = {"", "", "", "{list}", "{int32}", "{string}"};
  const std::string container = chance_.pick(containers);
  switch (chance_.below(9)) {
    case 0:
    case 1:
      return number() + container;
    case 2:
    case 3:
      return array_of(number()) + container;
    case 4:
      return "string" + container;
    case 5:
      return (chance_.one_in(2) ? "Mode" : "varvalue") + container;
    case 6:
      return (chance_.one_in(2) ? chance_.pick(pods_) : array_of(chance_.pick(pods_))) + container;
    case 7:
      return (chance_.one_in(2) ? chance_.pick(namedarrays_)
                                : array_of(chance_.pick(namedarrays_))) +
             container;
    default:
      return (structs_.empty() ? "string" : chance_.pick(structs_)) + container;
  }
}

void RandomDefinition::add_fields(std::size_t count, std::string (RandomDefinition::*type)()) {
  for (std::size_t i = 0; i < count; ++i) {
    text_ += "    field " + (this->*type)() + " f" + std::to_string(i) + "\n";
  }
  text_ += "end\n";
}

ServedObject random_board(const RandomDefinition& definition, std::uint64_t seed) {
  const Definitions definitions({definition.text()});
  ServedObject board(definitions, definition.name() + ".Board");
  RandomValues values(seed, definitions);
  std::vector<std::pair<std::string, Value>> given;
  for (const MemberDescription& member : board.members()) {
    if (member.kind == MemberKind::property) {
      const std::string number = member.name.substr(1);
      const Value value = values.value(member.type);
      board.store(member.name, value);
      if (member.name.front() == 'p') given.emplace_back(number, value);
      if (member.name.front() == 'p') {
        board.on_call("echo" + number, [](const List& arguments) { return arguments.at(0); });
      }
    }
  }
  const Value level = values.value(board.member("level").type);
  board.wire("level").set_in(level);
  const Value items = values.value(board.member("items").type);
  const Value grid = values.value(board.member("grid").type);
  board.store_memory("items", items);
  board.store_memory("grid", grid);
  board.on_call("difference",
                [weak = WeakServedObject(board), given, level, items, grid](const List&) -> Value {
                  const ServedObject self = weak.lock();
                  std::string names;
                  for (const auto& [number, value] : given) {
                    if (!(self.stored("q" + number) == value)) names += " q" + number;
                  }
                  const auto out = self.wire("level").out();
                  if (!out || !(out->value == level)) names += " level";
                  if (!(self.stored_memory("items") == items)) names += " items";
                  if (!(self.stored_memory("grid") == grid)) names += " grid";
                  return names;
                });
  return board;
}

}  // namespace rr::dynamic::testing
