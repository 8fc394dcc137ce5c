// SPDX-License-Identifier: Apache-2.0
#include "compiler/docs/explain.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace robdef::docs {
namespace {

using model::GeneratorForm;
using model::MemberKind;

constexpr std::array<std::string_view, 7> known_modifiers = {
    "readonly", "writeonly", "unreliable", "nolock", "nolockread", "perclient", "urgent"};

std::string_view generator_text(GeneratorForm form) {
  switch (form) {
    case GeneratorForm::none:
      return "";
    case GeneratorForm::returns:
      return "Generator: the client fetches the results one after the other.";
    case GeneratorForm::takes:
      return "Generator: the client sends the values of the last parameter one after the other.";
    case GeneratorForm::both:
      return "Generator: for each value of the last parameter that the client sends, it gets a "
             "result.";
  }
  return "";
}

std::string_view readonly_text(MemberKind kind) {
  switch (kind) {
    case MemberKind::pipe:
      return "Read-only: only the service sends packets.";
    case MemberKind::wire:
      return "Read-only: only the service sends values.";
    default:
      return "Read-only: clients cannot write it.";
  }
}

std::string_view writeonly_text(MemberKind kind) {
  switch (kind) {
    case MemberKind::pipe:
      return "Write-only: only clients send packets.";
    case MemberKind::wire:
      return "Write-only: only clients send values.";
    default:
      return "Write-only: clients cannot read it.";
  }
}

}  // namespace

std::vector<std::string> explain(const model::Member& member) {
  std::vector<std::string> sentences;
  const auto add = [&](bool applies, std::string_view sentence) {
    if (applies) sentences.emplace_back(sentence);
  };
  const model::Access& access = member.access;
  add(member.generator != GeneratorForm::none, generator_text(member.generator));
  add(access.is_readonly, readonly_text(member.kind));
  add(access.is_writeonly, writeonly_text(member.kind));
  add(access.is_unreliable,
      "Unreliable: clients may ask for packets that can be lost or come in another order.");
  add(access.is_nolock, "No lock: other users can use it while the object is locked.");
  add(access.is_nolockread, "No lock to read: other users can read it while the object is locked.");
  add(access.is_perclient, "Per client: each client has a value of its own.");
  add(access.is_urgent, "Urgent: its messages may overtake others.");
  for (const model::Modifier& modifier : member.modifiers) {
    if (std::ranges::find(known_modifiers, modifier.name) != known_modifiers.end()) continue;
    sentences.push_back("`" + modifier.name + "` is no modifier of the language.");
  }
  return sentences;
}

std::vector<std::string> explain(const model::Record& record) {
  switch (record.kind) {
    case model::RecordKind::struct_:
      if (record.is_recursive) return {"May contain itself."};
      return {};
    case model::RecordKind::pod:
      return {"An item takes at most " + std::to_string(record.packed_size) +
              " bytes in a message."};
    case model::RecordKind::namedarray:
      return {"An item is " + std::to_string(record.number_count) + " numbers of type `" +
              std::string(model::name_of(record.number)) + "`."};
  }
  return {};
}

}  // namespace robdef::docs
