// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/template.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "compiler/output/cpp_lines.hpp"
#include "compiler/output/template_tokens.hpp"

namespace robdef {

TemplateError::TemplateError(std::string_view name, std::size_t line, std::string_view what)
    : std::runtime_error(std::string(name) + ":" + std::to_string(line) + ": " +
                         std::string(what)) {}

/// A bound piece: names have become places in views.
struct Template::Node {
  enum class Kind { text, value, item, section, first, last, lines, columns };

  Kind kind = Kind::text;
  bool is_inverted = false;                 ///< section, first, last
  std::string text = {};                    ///< of text
  std::size_t depth = 0;                    ///< value, item, section: which of the views in scope
  std::vector<const ViewField*> path = {};  ///< value, section: the field, and the fields around it
  std::vector<Node> children = {};          ///< all but text, value, item
};

namespace {

using Node = Template::Node;
using Token = TemplateToken;

/// What a name inside a section refers to: a view, or an item of a list of texts.
struct Scope {
  const ViewType* type;  ///< null for a text
};

/// Turns tokens into nodes, looking every name up in the types in scope.
class Binder {
 public:
  Binder(const TemplateSources& sources, const std::vector<const ViewType*>& types)
      : sources_(sources) {
    for (const ViewType* type : types) scopes_.push_back({type});
  }

  std::vector<Node> bind(std::string_view name, std::string_view source, std::string_view indent) {
    if (std::ranges::find(open_, name) != open_.end()) {
      throw TemplateError(name, 1, "a partial that contains itself");
    }
    open_.emplace_back(name);
    const std::vector<Token> tokens = scan_template(name, source);
    std::vector<Node> nodes;
    bool at_line_begin = true;
    auto token = tokens.begin();
    bind_until(name, token, tokens.end(), nullptr, indent, at_line_begin, nodes);
    open_.pop_back();
    return nodes;
  }

 private:
  using At = std::vector<Token>::const_iterator;

  void bind_until(std::string_view name, At& token, At end, const Token* opened,
                  std::string_view indent, bool& at_line_begin, std::vector<Node>& nodes) {
    for (; token != end; ++token) {
      switch (token->kind) {
        case Token::Kind::text:
          add_text(token->text, indent, at_line_begin, nodes);
          break;
        case Token::Kind::value:
          add_text_begin(indent, at_line_begin, nodes);
          nodes.push_back(value(name, *token));
          break;
        case Token::Kind::open:
        case Token::Kind::inverted:
          if (!token->is_alone) add_text_begin(indent, at_line_begin, nodes);
          nodes.push_back(section(name, token, end, indent, at_line_begin));
          break;
        case Token::Kind::close:
          if (opened == nullptr || opened->text != token->text) {
            fail(name, *token, "`{{/" + std::string(token->text) + "}}` closes nothing");
          }
          return;
        case Token::Kind::partial:
          add_partial(name, *token, indent, nodes);
          at_line_begin = true;
          break;
      }
    }
    if (opened != nullptr) fail(name, *opened, "a section without its end");
  }

  /// Copies text, with the partial's indentation before each line that is not empty.
  static void add_text(std::string_view text, std::string_view indent, bool& at_line_begin,
                       std::vector<Node>& nodes) {
    std::string out;
    for (const char c : text) {
      if (at_line_begin && c != '\n') out += indent;
      out += c;
      at_line_begin = c == '\n';
    }
    if (!nodes.empty() && nodes.back().kind == Node::Kind::text) {
      nodes.back().text += out;
    } else {
      nodes.push_back({.text = std::move(out)});
    }
  }

  static void add_text_begin(std::string_view indent, bool& at_line_begin,
                             std::vector<Node>& nodes) {
    if (at_line_begin && !indent.empty()) nodes.push_back({.text = std::string(indent)});
    at_line_begin = false;
  }

  void add_partial(std::string_view name, const Token& token, std::string_view indent,
                   std::vector<Node>& nodes) {
    const auto source = sources_.find(std::string(token.text) + ".mustache");
    if (source == sources_.end()) {
      fail(name, token, "there is no partial `" + std::string(token.text) + "`");
    }
    const std::string deeper = std::string(indent) + std::string(token.indent);
    for (Node& node : bind(source->first, source->second, deeper)) {
      nodes.push_back(std::move(node));
    }
  }

  Node value(std::string_view name, const Token& token) {
    if (token.text == ".") {
      if (scopes_.back().type != nullptr) {
        fail(name, token, "`{{.}}` outside a list of texts");
      }
      return {.kind = Node::Kind::item, .depth = scopes_.size() - 1};
    }
    Node node = find(name, token);
    if (node.path.back()->kind != ViewKind::text) {
      fail(name, token, "`" + std::string(token.text) + "` is no text");
    }
    return node;
  }

  Node section(std::string_view name, At& token, At end, std::string_view indent,
               bool& at_line_begin) {
    const Token& opened = *token++;
    Node node;
    bool has_scope = false;
    if (opened.text == "@c++" || opened.text == "@columns") {
      // They work on whole lines.
      if (!opened.is_alone || opened.kind == Token::Kind::inverted) {
        fail(name, opened, "`{{#" + std::string(opened.text) + "}}` stands alone on its line");
      }
      node.kind = opened.text == "@c++" ? Node::Kind::lines : Node::Kind::columns;
    } else if (opened.text == "@first" || opened.text == "@last") {
      node.kind = opened.text == "@first" ? Node::Kind::first : Node::Kind::last;
    } else {
      node = find(name, opened);
      node.kind = Node::Kind::section;
      has_scope = add_scope(*node.path.back(), opened.kind == Token::Kind::inverted);
    }
    node.is_inverted = opened.kind == Token::Kind::inverted;
    bind_until(name, token, end, &opened, indent, at_line_begin, node.children);
    if (has_scope) scopes_.pop_back();
    return node;
  }

  bool add_scope(const ViewField& field, bool is_inverted) {
    if (is_inverted || field.kind == ViewKind::text || field.kind == ViewKind::truth) return false;
    scopes_.push_back({field.kind == ViewKind::texts ? nullptr : &field.type()});
    return true;
  }

  /// A dotted name, its first part from the innermost view that has it.
  Node find(std::string_view name, const Token& token) {
    std::string_view rest = token.text;
    const auto take = [&rest] {
      const std::string_view part = rest.substr(0, rest.find('.'));
      rest.remove_prefix(std::min(rest.size(), part.size() + 1));
      return part;
    };
    const std::string_view first = take();
    Node node{.kind = Node::Kind::value};
    for (std::size_t depth = scopes_.size(); depth-- > 0 && node.path.empty();) {
      if (scopes_[depth].type == nullptr) continue;
      node.depth = depth;
      if (const ViewField* field = field_of(*scopes_[depth].type, first)) {
        node.path.push_back(field);
      }
    }
    if (node.path.empty()) unknown(name, token);
    while (!rest.empty()) {
      const ViewField* outer = node.path.back();
      const ViewField* field =
          outer->kind == ViewKind::view ? field_of(outer->type(), take()) : nullptr;
      if (field == nullptr) unknown(name, token);
      node.path.push_back(field);
    }
    return node;
  }

  static const ViewField* field_of(const ViewType& type, std::string_view name) {
    const auto field = std::ranges::find(type, name, &ViewField::name);
    return field == type.end() ? nullptr : &*field;
  }

  [[noreturn]] void unknown(std::string_view name, const Token& token) {
    std::string message = "unknown name `" + std::string(token.text) + "`; the view here has";
    for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope) {
      if (scope->type == nullptr) continue;
      for (const ViewField& field : *scope->type) message.append(" ").append(field.name);
      break;
    }
    fail(name, token, message);
  }

  [[noreturn]] static void fail(std::string_view name, const Token& token,
                                std::string_view message) {
    throw TemplateError(name, token.line, message);
  }

  const TemplateSources& sources_;
  std::vector<Scope> scopes_;
  std::vector<std::string> open_;
};

/// A view in scope while printing, and where in its list it stands.
struct Frame {
  const void* view = nullptr;
  bool is_first = true;
  bool is_last = true;
};

class Printer {
 public:
  explicit Printer(const std::vector<const void*>& views) {
    for (const void* view : views) frames_.push_back({.view = view});
  }

  void print(const std::vector<Node>& nodes) {
    for (const Node& node : nodes) print(node);
  }

  std::string text() && { return std::move(text_); }

 private:
  void print(const Node& node) {
    switch (node.kind) {
      case Node::Kind::text:
        text_ += node.text;
        return;
      case Node::Kind::value:
        text_ += get(node).text;
        return;
      case Node::Kind::item:
        text_ += *static_cast<const std::string*>(frames_[node.depth].view);
        return;
      case Node::Kind::first:
        if (frames_.back().is_first != node.is_inverted) print(node.children);
        return;
      case Node::Kind::last:
        if (frames_.back().is_last != node.is_inverted) print(node.children);
        return;
      case Node::Kind::section:
        print_section(node);
        return;
      case Node::Kind::lines:
        print_lines(node);
        return;
      case Node::Kind::columns:
        print_columns(node);
        return;
    }
  }

  void print_lines(const Node& node) {
    const std::size_t begin = text_.size();
    print(node.children);
    const std::string_view printed = std::string_view(text_).substr(begin);
    if (!cpp::has_long_line(printed)) return;
    std::string lines = cpp::broken_lines(printed);
    text_.replace(begin, text_.size() - begin, lines);
  }

  void print_columns(const Node& node) {
    const std::size_t begin = text_.size();
    print(node.children);
    std::string columns = cpp::columns(std::string_view(text_).substr(begin));
    text_.replace(begin, text_.size() - begin, columns);
  }

  void print_section(const Node& node) {
    const ViewValue value = get(node);
    const bool has_value = !value.text.empty() || value.truth || value.count > 0;
    if (node.is_inverted) {
      if (!has_value) print(node.children);
      return;
    }
    const ViewKind kind = node.path.back()->kind;
    if (kind == ViewKind::text || kind == ViewKind::truth) {
      if (has_value) print(node.children);
      return;
    }
    for (std::size_t i = 0; i < value.count; ++i) {
      frames_.push_back({.view = static_cast<const char*>(value.data) + i * value.stride,
                         .is_first = i == 0,
                         .is_last = i + 1 == value.count});
      print(node.children);
      frames_.pop_back();
    }
  }

  ViewValue get(const Node& node) const {
    const void* view = frames_[node.depth].view;
    ViewValue value;
    for (const ViewField* field : node.path) {
      value = field->get(view);
      view = value.data;
    }
    return value;
  }

  std::vector<Frame> frames_;
  std::string text_;
};

}  // namespace

Template::Template(const TemplateSources& sources, std::string_view name, std::string_view text,
                   const std::vector<const ViewType*>& types)
    : nodes_(Binder(sources, types).bind(name, text, {})), depth_(types.size()) {}

Template::Template(const TemplateSources& sources, std::string_view name,
                   const std::vector<const ViewType*>& types)
    : depth_(types.size()) {
  const auto source = sources.find(name);
  if (source == sources.end()) throw TemplateError(name, 1, "there is no such template");
  nodes_ = Binder(sources, types).bind(source->first, source->second, {});
}

Template::Template(Template&&) noexcept = default;
Template& Template::operator=(Template&&) noexcept = default;
Template::~Template() = default;

std::string Template::render(const std::vector<const void*>& views) const {
  if (views.size() != depth_) throw std::logic_error("Template::render: other views than bound");
  Printer printer(views);
  printer.print(nodes_);
  return std::move(printer).text();
}

}  // namespace robdef
