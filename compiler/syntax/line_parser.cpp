// SPDX-License-Identifier: Apache-2.0
#include "compiler/syntax/line_parser.hpp"

#include <RobdefLexer.h>

#include <utility>

#include "compiler/syntax/faults.hpp"
#include "compiler/syntax/tokens.hpp"
#include "compiler/syntax/tree.hpp"

namespace robdef::syntax {

using Grammar = grammar::RobdefParser;

// One parser serves all lines of a file: making it costs more than a line does.
struct LineParser::Machinery {
  LineTokens tokens;
  Grammar parser{&tokens};
  std::shared_ptr<FirstFault> faults = std::make_shared<FirstFault>(tokens);
  bool fits = false;  ///< the tokens are those of a line that fits the grammar

  Machinery() {
    parser.removeErrorListeners();
    parser.setErrorHandler(faults);
  }

  // Reads a line by one rule and makes a node of it by `build(tree, context)`.
  template <class Context, class Build>
  auto read(const LogicalLine& line, Report& report, Context* (Grammar::*rule)(), Build build,
            std::size_t mode = antlr4::Lexer::DEFAULT_MODE)
      -> std::optional<std::invoke_result_t<Build, LineTree&, Context*>> {
    tokens.load(line.text(), mode);
    parser.reset();
    fits = false;
    Context* context = nullptr;
    try {
      context = (parser.*rule)();
    } catch (const antlr4::ParseCancellationException&) {
      report_fault(faults->fault(), line, report);
      return std::nullopt;
    }
    fits = true;
    LineTree tree(line, report);
    auto result = build(tree, context);
    if (tree.failed()) return std::nullopt;
    return result;
  }
};

std::uint32_t LineParser::take_tokens(const LogicalLine& line, std::vector<ast::Token>& tokens) {
  if (!std::exchange(machinery_->fits, false)) return 0;
  const std::size_t before = tokens.size();
  machinery_->tokens.append_to(line, tokens);
  return static_cast<std::uint32_t>(tokens.size() - before);
}

LineParser::LineParser() : machinery_(std::make_unique<Machinery>()) {}
LineParser::~LineParser() = default;

std::optional<ast::Name> LineParser::service(const LogicalLine& line, Report& report) {
  return machinery_->read(line, report, &Grammar::serviceLine,
                          [](LineTree& tree, Grammar::ServiceLineContext* context) {
                            return tree.name(context->dotted());
                          });
}

std::optional<VersionLine> LineParser::stdver(const LogicalLine& line, Report& report) {
  return machinery_->read(line, report, &Grammar::stdverLine,
                          [](LineTree& tree, Grammar::StdverLineContext* context) {
                            return tree.version(context->VERSION(), Code::R0112);
                          });
}

std::optional<OptionLine> LineParser::option(const LogicalLine& line, Report& report) {
  return machinery_->read(
      line, report, &Grammar::optionLine,
      [](LineTree& tree, Grammar::OptionLineContext* context) -> OptionLine {
        if (auto* const written = dynamic_cast<Grammar::OptionVersionContext*>(context)) {
          return tree.version(written->VERSION(), Code::R0115);
        }
        if (auto* const written = dynamic_cast<Grammar::OptionConstantContext*>(context)) {
          return tree.constant(written->constantParts());
        }
        return std::monostate();
      });
}

std::optional<ast::Import> LineParser::import(const LogicalLine& line, Report& report) {
  return machinery_->read(line, report, &Grammar::importLine,
                          [&line](LineTree& tree, Grammar::ImportLineContext* context) {
                            return ast::Import{tree.name(context->dotted()), line.span()};
                          });
}

std::optional<ast::Using> LineParser::using_line(const LogicalLine& line, Report& report) {
  return machinery_->read(
      line, report, &Grammar::usingLine,
      [](LineTree& tree, Grammar::UsingLineContext* context) { return tree.using_line(context); });
}

std::optional<ast::Exception> LineParser::exception(const LogicalLine& line, Report& report) {
  return machinery_->read(
      line, report, &Grammar::exceptionLine,
      [&line](LineTree& tree, Grammar::ExceptionLineContext* context) {
        return ast::Exception{tree.name(context->dotted()), line.documentation(), line.span()};
      });
}

std::optional<ast::Constant> LineParser::constant(const LogicalLine& line, Report& report) {
  return machinery_->read(line, report, &Grammar::constantLine,
                          [](LineTree& tree, Grammar::ConstantLineContext* context) {
                            return tree.constant(context->constantParts());
                          });
}

std::optional<ast::Name> LineParser::header(const LogicalLine& line, Report& report) {
  const auto build = [](LineTree& tree, antlr4::ParserRuleContext* context) {
    return tree.name(context->getToken(Grammar::NAME, 0));
  };
  if (line.text().starts_with("enum")) {
    return machinery_->read(line, report, &Grammar::enumHeader, build);
  }
  if (line.text().starts_with("object")) {
    return machinery_->read(line, report, &Grammar::objectHeader, build);
  }
  return machinery_->read(line, report, &Grammar::recordHeader, build);
}

std::optional<EndLine> LineParser::end(const LogicalLine& line, Report& report) {
  return machinery_->read(line, report, &Grammar::endLine,
                          [](LineTree& tree, Grammar::EndLineContext* context) {
                            EndLine end;
                            if (auto* const kind = context->BLOCK_KIND())
                              end.kind = tree.name(kind);
                            return end;
                          });
}

std::optional<EnumLine> LineParser::enum_line(const LogicalLine& line, Report& report) {
  return machinery_->read(
      line, report, &Grammar::enumLine,
      [](LineTree& tree, Grammar::EnumLineContext* context) { return tree.enum_line(context); },
      grammar::RobdefLexer::EnumBody);
}

std::optional<ast::Implements> LineParser::implements(const LogicalLine& line, Report& report) {
  return machinery_->read(line, report, &Grammar::implementsLine,
                          [&line](LineTree& tree, Grammar::ImplementsLineContext* context) {
                            return ast::Implements{tree.name(context->dotted()), line.span()};
                          });
}

std::optional<ast::Field> LineParser::field(const LogicalLine& line, Report& report) {
  return machinery_->read(
      line, report, &Grammar::fieldLine,
      [](LineTree& tree, Grammar::FieldLineContext* context) { return tree.field(context); });
}

std::optional<ast::Member> LineParser::member(const LogicalLine& line, Report& report) {
  return machinery_->read(
      line, report, &Grammar::memberLine,
      [](LineTree& tree, Grammar::MemberLineContext* context) { return tree.member(context); });
}

}  // namespace robdef::syntax
