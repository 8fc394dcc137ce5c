// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/testing.hpp"

#include <algorithm>

#include "compiler/breaking/compare.hpp"
#include "compiler/model/check.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/read.hpp"

namespace robdef::breaking::testing {
namespace {

model::Model compiled(const std::vector<std::string>& texts, const std::string& side,
                      Sources& sources, Report& report) {
  std::vector<ast::NamedText> named;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    named.push_back({side + (i == 0 ? "" : std::to_string(i)) + ".robdef", texts[i], false});
  }
  const ast::Program program = ast::read_texts(std::move(named), sources, report);
  model::Model model = model::resolve(program, sources, report);
  model::evaluate(model, report);
  model::lay_out(model, report);
  model::check(model, report);
  return model;
}

}  // namespace

Models::Models(const std::vector<std::string>& before_texts,
               const std::vector<std::string>& now_texts)
    : before(compiled(before_texts, "old", sources, report)),
      now(compiled(now_texts, "new", sources, report)) {}

Compared::Compared(const std::vector<std::string>& before_texts,
                   const std::vector<std::string>& now_texts, Wanted wanted)
    : Models(before_texts, now_texts), changes(std::move(wanted)) {
  compare(before, now, false, changes);
}

std::string Compared::codes() const {
  std::vector<std::string> codes;
  for (const Change& change : changes.list()) {
    codes.emplace_back(entry_of(change.rule->code).name);
  }
  std::sort(codes.begin(), codes.end());
  std::string text;
  for (const std::string& code : codes) text += (text.empty() ? "" : " ") + code;
  return text;
}

std::string definition(const std::string& body) {
  return "service x.t\nstdver 0.10\n" + body + "\n";
}

std::string with_root(const std::string& types, const std::string& members) {
  return definition(types + "\nobject Root\n" + members + "\nend");
}

}  // namespace robdef::breaking::testing
