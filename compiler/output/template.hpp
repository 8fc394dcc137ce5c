// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/output/view_type.hpp"

/// Text with holes: a strict, logic-less subset of Mustache.
///
///   {{name}} {{a.b}}      prints a text; `{{.}}` the item of a list of texts
///   {{#name}}...{{/name}} once for a text that is not empty, a true truth or a view that is there,
///                         whose names are then seen first; for each item of a list
///   {{^name}}...{{/name}} when there is none of that
///   {{#@first}} {{#@last}} (or ^) where in the innermost list this is
///   {{#@c++}} alone on its line: lines of C++ inside that are longer than 100 columns are broken
///                         (cpp_lines.hpp)
///   {{#@columns}}         likewise: the lines inside, of one indentation, are put into columns
///   {{> partial}}         another template, with the blanks before it put before each of its lines
///   {{! comment}}
///
/// Of more than two braces the last two begin a tag. Nothing is escaped. A section, partial or
/// comment that is alone on its line takes the whole line with it. Names are looked up in the view
/// in scope and then in those around it, once, when the template is bound to a view's type: an
/// unknown name is found even where nothing is printed.
namespace robdef {

/// A fault in a template: ours, or the author's of a template folder.
class TemplateError : public std::runtime_error {
 public:
  TemplateError(std::string_view name, std::size_t line, std::string_view what);
};

/// Template sources by name; partials are called by the same names.
using TemplateSources = std::map<std::string, std::string, std::less<>>;

/// A template that is ready to print views of certain types.
class Template {
 public:
  /// Binds the template `name` of `sources` to views: outermost first. Throws TemplateError.
  Template(const TemplateSources& sources, std::string_view name,
           const std::vector<const ViewType*>& types);
  /// Binds `text`, called `name` in messages.
  Template(const TemplateSources& sources, std::string_view name, std::string_view text,
           const std::vector<const ViewType*>& types);
  Template(Template&&) noexcept;
  Template& operator=(Template&&) noexcept;
  ~Template();

  /// Prints; `views` are of the bound types, in the same order.
  [[nodiscard]] std::string render(const std::vector<const void*>& views) const;

  struct Node;  // internal

 private:
  std::vector<Node> nodes_;
  std::size_t depth_;
};

}  // namespace robdef
