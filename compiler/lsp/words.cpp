// SPDX-License-Identifier: Apache-2.0
#include "compiler/lsp/words.hpp"

#include <algorithm>
#include <array>

namespace robdef::lsp {
namespace {

constexpr std::array keywords = {
    WordHelp{"service", "Names the service that this file defines; the first statement."},
    WordHelp{"stdver", "The version of the language that the file needs."},
    WordHelp{"option", "A relic of version 0.8; use `stdver`, `constant` or a modifier."},
    WordHelp{"import", "Makes the types of another definition available under their full names."},
    WordHelp{"using", "Gives an imported type a short name."},
    WordHelp{"exception", "An error that members can raise, with a name that clients see."},
    WordHelp{"constant", "A number, text, array of numbers or struct of constants."},
    WordHelp{"enum", "Names for 32-bit numbers."},
    WordHelp{"struct", "A record of any values. It is null or there."},
    WordHelp{"pod", "A record of numbers and pods; arrays of it are sent without gaps."},
    WordHelp{"namedarray", "Numbers of one type with names, such as a vector."},
    WordHelp{"object", "What clients use by reference: properties, functions, events, streams."},
    WordHelp{"end", "Ends a block."},
    WordHelp{"implements", "The object has all members of another one."},
    WordHelp{"field", "A value of a struct, pod or namedarray."},
    WordHelp{"property", "A value that clients read and write."},
    WordHelp{"function", "A call with parameters and a result."},
    WordHelp{"event", "A notification from the service to its clients."},
    WordHelp{"objref", "A reference to another object; `[]`, `{int32}` or `{string}` for many."},
    WordHelp{"pipe", "Packets in order, in both directions, each of them delivered."},
    WordHelp{"callback", "A function of the client that the service calls."},
    WordHelp{"wire", "The most recent value, in both directions; older ones may be lost."},
    WordHelp{"memory", "An array at the service that is read and written in parts."},
};

constexpr std::array types = {
    WordHelp{"double", "64-bit floating-point number"},
    WordHelp{"single", "32-bit floating-point number"},
    WordHelp{"int8", "8-bit signed integer"},
    WordHelp{"uint8", "8-bit unsigned integer"},
    WordHelp{"int16", "16-bit signed integer"},
    WordHelp{"uint16", "16-bit unsigned integer"},
    WordHelp{"int32", "32-bit signed integer"},
    WordHelp{"uint32", "32-bit unsigned integer"},
    WordHelp{"int64", "64-bit signed integer"},
    WordHelp{"uint64", "64-bit unsigned integer"},
    WordHelp{"cdouble", "complex number of two doubles"},
    WordHelp{"csingle", "complex number of two singles"},
    WordHelp{"bool", "true or false"},
    WordHelp{"string", "text in UTF-8"},
    WordHelp{"varvalue", "a value of any type"},
    WordHelp{"varobject", "an object of any type, of an `objref` only"},
    WordHelp{"void", "no value, as the result of a function or callback"},
};

constexpr std::array modifiers = {
    WordHelp{"readonly", "Clients can read, and not write."},
    WordHelp{"writeonly", "Clients can write, and not read."},
    WordHelp{"unreliable", "Packets may be lost or come out of order."},
    WordHelp{"nolock", "Can be used while another client has locked the object."},
    WordHelp{"nolockread", "Can be read while another client has locked the object."},
    WordHelp{"perclient", "The value belongs to each client alone."},
    WordHelp{"urgent", "Is handled before what waits."},
};

}  // namespace

std::span<const WordHelp> keyword_helps() { return keywords; }
std::span<const WordHelp> type_helps() { return types; }
std::span<const WordHelp> modifier_helps() { return modifiers; }

std::string_view help_of_word(std::string_view word) {
  for (const auto& all : {keyword_helps(), type_helps(), modifier_helps()}) {
    const auto found = std::ranges::find(all, word, &WordHelp::word);
    if (found != all.end()) return found->help;
  }
  return {};
}

}  // namespace robdef::lsp
