// SPDX-License-Identifier: Apache-2.0
// Rules on versions and modifiers: V06, W1, W2, W3, R0613.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/model/phrases.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/model/rules.hpp"
#include "compiler/syntax/words.hpp"

namespace robdef::model::rules {
namespace {

constexpr ast::Version first_with_features{{0, 9, 0, 0}};

// Calls `visit(modifiers, kind, constants of the block)` for each field and member. A field knows
// the modifiers of a property, without effect.
template <class Visitor>
void each_modifier_list(const Definition& definition, Visitor visit) {
  for (const Record& record : definition.records) {
    for (const Field& field : record.fields) {
      if (!field.modifiers.empty()) {
        visit(field.modifiers, MemberKind::property, record.constants);
      }
    }
  }
  for (const Object& object : definition.objects) {
    for (const Member& member : object.members) {
      if (!member.modifiers.empty()) visit(member.modifiers, member.kind, object.constants);
    }
  }
}

bool is_language_word(std::string_view name) {
  const auto& words = syntax::modifier_words();
  return std::find(words.begin(), words.end(), name) != words.end();
}

const Modifier* find(const std::vector<Modifier>& modifiers, std::string_view name) {
  const auto found =
      std::find_if(modifiers.begin(), modifiers.end(), [name](const Modifier& modifier) {
        return modifier.name == name && modifier.arguments.empty();
      });
  return found == modifiers.end() ? nullptr : &*found;
}

void report_contradiction(const std::vector<Modifier>& modifiers, std::string_view wins,
                          std::string_view loses, Report& report) {
  const Modifier* winner = find(modifiers, wins);
  const Modifier* loser = find(modifiers, loses);
  if (winner == nullptr || loser == nullptr) return;
  report.add(Code::R0611, loser->span, in_ticks(loses) + " contradicts " + in_ticks(wins))
      .label("has no effect")
      .also(winner->span, "this one counts")
      .help("remove one of the two");
}

// The keyword of the line on which a name stands, or the name itself where the line is continued.
Span keyword_before(const Definition& definition, Span name, std::string_view keyword) {
  const std::string_view text = definition.text;
  const std::size_t line_end = text.rfind('\n', name.begin);
  const std::size_t line = line_end == text.npos ? 0 : line_end + 1;
  const std::size_t begin = text.find_first_not_of(" \t", line);
  if (begin == text.npos || !text.substr(begin).starts_with(keyword)) return name;
  return {name.source, static_cast<std::uint32_t>(begin),
          static_cast<std::uint32_t>(begin + keyword.size())};
}

void report_feature(Span span, const std::string& feature, const Definition& definition,
                    Report& report) {
  report.add(Code::R0208, span, feature + " in a file of version " + text_of(definition.version))
      .label("came with version 0.9")
      .also(definition.version_span, "the version is declared here")
      .help("declare `stdver 0.10`")
      .edit(definition.version_span, "0.10");
}

void report_statement(Span name, std::string_view keyword, const Definition& definition,
                      Report& report) {
  report_feature(keyword_before(definition, name, keyword), in_ticks(keyword), definition, report);
}

// A slip would change what is generated, so it is an error; a word of one's own is not. What a peer
// sends is never refused for either.
void report_unknown(const Modifier& modifier, Report& report) {
  const std::string_view near = report.origin() == Origin::user && modifier.arguments.empty()
                                    ? syntax::nearest_modifier(modifier.name)
                                    : std::string_view();
  const std::string message = "unknown modifier " + in_ticks(modifier.name);
  if (near.empty()) {
    report.add(Code::R0610, modifier.span, message).label("has no effect");
  } else {
    report.add(Code::R0613, modifier.span, message)
        .label("would have no effect")
        .help("write " + in_ticks(near))
        .edit({modifier.span.source, modifier.span.begin,
               modifier.span.begin + static_cast<std::uint32_t>(modifier.name.size())},
              std::string(near));
  }
}

bool is_name(std::string_view argument) {
  const char c = argument.empty() ? '0' : argument.front();
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

void features_fit_the_version(const Definition& definition, Report& report) {
  const bool is_old = definition.version_spelling == ast::VersionSpelling::option &&
                      definition.version < first_with_features;
  if (!is_old) return;
  for (const Alias& alias : definition.aliases) {
    report_statement(alias.span, "using", definition, report);
  }
  const auto constants = [&](const std::vector<Constant>& list) {
    for (const Constant& constant : list) {
      if (!constant.is_option) report_statement(constant.span, "constant", definition, report);
    }
  };
  constants(definition.constants);
  for (const Enum& enumeration : definition.enums) {
    report_statement(enumeration.span, "enum", definition, report);
  }
  for (const Record& record : definition.records) constants(record.constants);
  for (const Object& object : definition.objects) constants(object.constants);
  each_modifier_list(definition, [&](const auto& modifiers, MemberKind, const auto&) {
    report_feature(modifiers.front().span, "modifiers", definition, report);
  });
}

void modifiers_are_known(const Definition& definition, Report& report) {
  each_modifier_list(definition, [&](const auto& modifiers, MemberKind kind, const auto&) {
    const auto of_kind = [kind] {
      return " has no effect on " + (kind == MemberKind::property
                                         ? std::string("a property or field")
                                         : with_article(name_of(kind)));
    };
    for (const Modifier& modifier : modifiers) {
      if (knows_modifier(kind, modifier.name)) {
        if (modifier.arguments.empty()) continue;
        report.add(Code::R0610, modifier.span, in_ticks(modifier.name) + " takes no arguments")
            .label("has no effect with arguments")
            .help("write plain " + in_ticks(modifier.name))
            .edit(modifier.span, modifier.name);
      } else if (is_language_word(modifier.name)) {
        report.add(Code::R0610, modifier.span, in_ticks(modifier.name) + of_kind())
            .label("belongs to other kinds of members");
      } else {
        report_unknown(modifier, report);
      }
    }
  });
}

void modifiers_do_not_contradict(const Definition& definition, Report& report) {
  each_modifier_list(definition, [&](const auto& modifiers, MemberKind kind, const auto&) {
    if (modifiers.size() < 2) return;
    if (knows_modifier(kind, "readonly")) {
      report_contradiction(modifiers, "readonly", "writeonly", report);
    }
    if (knows_modifier(kind, "nolockread")) {
      report_contradiction(modifiers, "nolock", "nolockread", report);
    }
    std::unordered_map<std::string_view, const Modifier*> firsts;
    for (const Modifier& modifier : modifiers) {
      if (!modifier.arguments.empty() || !knows_modifier(kind, modifier.name)) continue;
      const Modifier* const first = firsts.try_emplace(modifier.name, &modifier).first->second;
      if (first == &modifier) continue;
      report.add(Code::R0611, modifier.span, in_ticks(modifier.name) + " is repeated")
          .label("means nothing more")
          .also(first->span, "first given here")
          .help("remove one of the two");
    }
  });
}

void modifier_arguments_are_constants(const Definition& definition, Report& report) {
  std::unordered_map<const void*, std::unordered_set<std::string_view>> names;  // of each block
  each_modifier_list(definition, [&](const auto& modifiers, MemberKind, const auto& constants) {
    const auto is_constant = [&](std::string_view name) {
      const auto [block, is_new] = names.try_emplace(&constants);
      if (is_new) {
        for (const Constant& constant : constants) block->second.insert(constant.name);
      }
      return block->second.contains(name);
    };
    for (const Modifier& modifier : modifiers) {
      if (is_language_word(modifier.name)) continue;
      for (std::size_t i = 0; i < modifier.arguments.size(); ++i) {
        const std::string& argument = modifier.arguments[i];
        if (!is_name(argument) || is_constant(argument)) continue;
        Diagnostic& diagnostic =
            report.add(Code::R0612, modifier.argument_spans[i],
                       in_ticks(argument) + " is not a constant of this block");
        diagnostic.label("no constant of this block has this name");
        for (const Constant& constant : definition.constants) {
          if (constant.name != argument) continue;
          diagnostic.also(constant.span, "this one belongs to the file");
          diagnostic.help("declare it in the block");
        }
      }
    }
  });
}

}  // namespace robdef::model::rules
