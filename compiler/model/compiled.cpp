// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/compiled.hpp"

#include <algorithm>
#include <stdexcept>

#include "compiler/model/check.hpp"
#include "compiler/model/evaluate.hpp"
#include "compiler/model/layout.hpp"
#include "compiler/model/resolve.hpp"
#include "compiler/syntax/parse.hpp"

namespace robdef::model {
namespace {

template <class Items>
const typename Items::value_type* find(const Items& items, const std::string& name) {
  const auto found = std::find_if(items.begin(), items.end(),
                                  [&name](const auto& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

}  // namespace

std::vector<std::string> Compiled::codes() const {
  std::vector<std::string> result;
  for (const Diagnostic* diagnostic : report->sorted()) {
    result.emplace_back(entry_of(diagnostic->code()).name);
  }
  return result;
}

std::vector<std::string> Compiled::errors() const {
  std::vector<std::string> result;
  for (const Diagnostic* diagnostic : report->sorted()) {
    if (diagnostic->severity() != Severity::error) continue;
    result.emplace_back(entry_of(diagnostic->code()).name);
  }
  return result;
}

std::string Compiled::marked(std::size_t index) const {
  const Span span = report->sorted().at(index)->primary().span;
  return (*sources)[span.source].text().substr(span.begin, span.end - span.begin);
}

std::string Compiled::help(std::size_t index) const {
  const std::vector<std::string>& helps = report->sorted().at(index)->helps();
  return helps.empty() ? "" : helps.front();
}

const Record& Compiled::record(const std::string& name) const {
  for (const auto& definition : model.definitions()) {
    if (const Record* found = find(definition->records, name)) return *found;
  }
  throw std::logic_error("no record " + name);
}

const Object& Compiled::object(const std::string& name) const {
  for (const auto& definition : model.definitions()) {
    if (const Object* found = find(definition->objects, name)) return *found;
  }
  throw std::logic_error("no object " + name);
}

const Member& Compiled::member(const std::string& object_name, const std::string& name) const {
  if (const Member* found = find(object(object_name).members, name)) return *found;
  throw std::logic_error("no member " + name);
}

Compiled compiled(const std::vector<std::string>& texts) {
  Compiled result;
  ast::Program program;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const SourceId source = result.sources->add(std::to_string(i) + ".robdef", texts[i]);
    program.files.push_back({ast::parse((*result.sources)[source], source, *result.report), false});
  }
  result.model = resolve(program, *result.sources, *result.report);
  evaluate(result.model, *result.report);
  lay_out(result.model, *result.report);
  check(result.model, *result.report);
  return result;
}

Compiled compiled_lines(const std::string& lines) {
  return compiled({"service example.t\nstdver 0.10\n" + lines});
}

}  // namespace robdef::model
