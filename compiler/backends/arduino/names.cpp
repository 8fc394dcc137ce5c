// SPDX-License-Identifier: Apache-2.0
#include "compiler/backends/arduino/names.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include "compiler/backends/cpp/names.hpp"
#include "compiler/backends/name_set.hpp"
#include "compiler/backends/words.hpp"

namespace robdef::arduino {
namespace {

// Macros and functions of the core, and ours that are found by their arguments; sorted.
constexpr std::array core_names = {
    "A0",           "A1",         "A2",         "A3",          "A4",      "A5",
    "A6",           "A7",         "CHANGE",     "DEC",         "DEFAULT", "DEG_TO_RAD",
    "EULER",        "EXTERNAL",   "F",          "FALLING",     "HALF_PI", "HEX",
    "HIGH",         "INPUT",      "INTERNAL",   "LED_BUILTIN", "LOW",     "LSBFIRST",
    "MISO",         "MOSI",       "MSBFIRST",   "OCT",         "OUTPUT",  "PI",
    "PROGMEM",      "RAD_TO_DEG", "RISING",     "SCK",         "SCL",     "SDA",
    "SERIAL",       "SS",         "Serial",     "TWO_PI",      "abs",     "bit",
    "boolean",      "byte",       "constrain",  "degrees",     "delay",   "digitalRead",
    "digitalWrite", "highByte",   "interrupts", "loop",        "lowByte", "main",
    "map",          "max",        "micros",     "millis",      "min",     "radians",
    "random",       "read",       "round",      "setup",       "sq",      "typeof",
    "word",         "write"};

}  // namespace

bool is_reserved(std::string_view word) {
  return cpp::is_reserved(word) || std::ranges::find(core_names, word) != core_names.end();
}

std::string identifier(std::string_view name) {
  return std::string(name) + (is_reserved(name) ? "_" : "");
}

std::string camel(std::string_view name) {
  const bool is_capitals =
      std::ranges::none_of(name, [](unsigned char letter) { return std::islower(letter) != 0; });
  return is_capitals ? std::string(name) : camel_case(name);
}

std::string pascal(std::string_view name) { return pascal_case(name); }

std::string sketch_name(std::string_view service) { return replace_all(service, ".", "_"); }

std::string qualified(const model::Definition& definition, std::string_view name) {
  std::string result;
  for (const std::string& segment : segments_of(definition.name))
    result += "::" + identifier(segment);
  return result + "::" + std::string(name);
}

std::string plus(std::size_t number) { return number == 0 ? "" : std::to_string(number) + " + "; }

std::string minus(std::size_t number) { return number == 0 ? "" : " - " + std::to_string(number); }

std::string Scope::add(const std::string& name, std::string_view written, Span span,
                       const std::string& path) {
  const std::string used = identifier(name);
  if (used != name) {
    report_.add(Code::R0903, span, "`" + name + "` is reserved in a sketch")
        .label("becomes `" + used + "`");
  }
  const auto [place, is_new] = taken_.emplace(used, span);
  if (!is_new) {
    Diagnostic& diagnostic = report_.add(
        Code::R0901, span,
        "`" + std::string(written) + "` becomes `" + used + "`, which is taken in the sketch");
    diagnostic.also(place->second, "also becomes `" + used + "`");
    help_rename(diagnostic, arduino_language, path);
  }
  return used;
}

}  // namespace robdef::arduino
