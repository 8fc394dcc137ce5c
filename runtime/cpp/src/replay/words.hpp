// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "rr/message_tree.hpp"

/// Messages in words, for people who look at recordings.
namespace rr::replay {

/// `PropertyGetReq`; `EntryType2000` for numbers without a name (README of the specification).
std::string name_of(EntryType type);
/// The type of such a name, or of a number; nothing for anything else.
std::optional<EntryType> entry_type_of(std::string_view name);
/// `double`, `structure`; `type500` for numbers without a name.
std::string name_of(ElementType type);

/// What a type and its answer have in common: `PropertyGet` for PropertyGetReq and PropertyGetRes.
std::string name_of_exchange(EntryType request);

/// How much of long values is shown.
struct Shortening {
  std::size_t items = 8;   ///< of arrays, and of nested elements
  std::size_t bytes = 60;  ///< of strings
};

/// `value: double 2.5`, `text: string "a"`, `points: double[100] [1, 2, ...]`,
/// `at: structure a.b.Angles {pan: double 1, tilt: double 2}`.
std::string text_of(const ElementTree& element, const Shortening& shortening = {});
/// `PropertyGetRes counter.value id 7 error 9 errorname: string "..."`.
std::string text_of(const EntryTree& entry, const Shortening& shortening = {});
/// `counter.value`, `counter` without a member.
std::string place_of(const EntryTree& entry);

/// Item `index` of the payload of an element of numbers: the shortest decimal that gives the same
/// bits; `1+2i` for complex ones. Empty for other types, and for items that are not there.
std::string number_at(const ElementTree& element, std::size_t index);
/// How many items the payload has.
std::size_t items_of(const ElementTree& element);
/// The payload of a string.
std::string_view string_of(const ElementTree& element);
/// The name of an element, or its number as text.
std::string label_of(const ElementTree& element);
/// In quotes; control characters, quotes, backslashes and bytes that are not UTF-8 escaped.
std::string quoted(std::string_view text, std::size_t limit);

}  // namespace rr::replay
