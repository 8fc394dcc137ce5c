// SPDX-License-Identifier: Apache-2.0
// Declarations of a definition -> sections of its page.
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "compiler/docs/explain.hpp"
#include "compiler/docs/view_parts.hpp"

namespace robdef::docs {
namespace {

using model::MemberKind;
using model::RecordKind;

constexpr std::array<std::pair<MemberKind, std::string_view>, 8> member_groups = {{
    {MemberKind::property, "Properties"},
    {MemberKind::function, "Functions"},
    {MemberKind::event, "Events"},
    {MemberKind::objref, "Objrefs"},
    {MemberKind::pipe, "Pipes"},
    {MemberKind::callback, "Callbacks"},
    {MemberKind::wire, "Wires"},
    {MemberKind::memory, "Memories"},
}};

struct RecordSection {
  RecordKind kind{};
  std::string_view title;
  std::string_view anchor;
};
constexpr std::array<RecordSection, 3> record_sections = {{
    {RecordKind::struct_, "Structures", "_structs"},
    {RecordKind::pod, "Pods", "_pods"},
    {RecordKind::namedarray, "Named arrays", "_namedarrays"},
}};

std::string number_of(const model::EnumValue& value) {
  std::string text = std::to_string(value.value);
  if (!value.is_hexadecimal) return text;
  const std::int64_t wide = value.value;
  std::array<char, 16> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), wide < 0 ? -wide : wide, 16);
  text += wide < 0 ? " (-0x" : " (0x";
  return text.append(digits.data(), end.ptr) + ")";
}

/// Makes the declarations of one definition.
class DeclarationMaker {
 public:
  explicit DeclarationMaker(const Context& context) : context_(context) {}

  [[nodiscard]] DeclarationView make(const model::Object& object) const {
    DeclarationView view = declaration(object, "object");
    std::vector<std::string> bases;
    for (const model::Object* base : object.implements) {
      bases.push_back(context_.signatures.object(*base));
    }
    view.implements = joined(bases);
    view.implemented_by = places(context_.uses.implementers_of(object));
    view.used_by = places(context_.uses.of(&object));
    for (const std::string& option : object.options) {
      view.notes.push_back(Markup::code(context_.markup.text("option " + option)));
    }
    add_constants(view, object.constants, object.name);
    for (const auto& [kind, title] : member_groups) {
      GroupView group{.title = std::string(title), .entries = {}};
      for (const model::Member& member : object.members) {
        if (member.kind == kind) group.entries.push_back(make_member(object, member));
      }
      add(view, std::move(group));
    }
    return view;
  }

  [[nodiscard]] DeclarationView make(const model::Record& record) const {
    DeclarationView view = declaration(record, model::name_of(record.kind));
    view.used_by = places(context_.uses.of(&record));
    view.notes = finished(explain(record));
    add_constants(view, record.constants, record.name);
    GroupView fields{.title = "Fields", .entries = {}};
    for (const model::Field& field : record.fields) {
      fields.entries.push_back(entry(record.name + "." + field.name,
                                     context_.signatures.field(record, field),
                                     field.documentation));
    }
    add(view, std::move(fields));
    return view;
  }

  [[nodiscard]] DeclarationView make(const model::Enum& enumeration) const {
    DeclarationView view = declaration(enumeration, "enum");
    view.used_by = places(context_.uses.of(&enumeration));
    GroupView values{.title = "Values", .is_values = true, .entries = {}};
    for (const model::EnumValue& value : enumeration.values) {
      const std::string anchor = enumeration.name + "." + value.name;
      EntryView one =
          entry(anchor, context_.signatures.name(value.name, anchor), value.documentation);
      one.number = number_of(value);
      values.entries.push_back(std::move(one));
    }
    add(view, std::move(values));
    return view;
  }

  [[nodiscard]] DeclarationView make(const model::Exception& exception) const {
    return declaration(exception, "exception");
  }

  [[nodiscard]] DeclarationView make(const model::Constant& constant) const {
    DeclarationView view = declaration(constant, "constant");
    view.signature = context_.signatures.constant(constant, "");
    view.is_constant = true;
    return view;
  }

 private:
  template <class Declared>
  DeclarationView declaration(const Declared& declared, std::string_view keyword) const {
    DeclarationView view;
    view.anchor = html_text(declared.name);
    view.address =
        context_.addresses.address(context_.definition, {&context_.definition, declared.name});
    view.kind = keyword;
    view.name = context_.markup.text(declared.name);
    view.signature = context_.signatures.block(keyword, declared.name);
    view.doc = context_.markup.lines(blocks_of(declared.documentation));
    return view;
  }

  [[nodiscard]] EntryView entry(const std::string& anchor, std::string signature,
                                const std::string& documentation) const {
    const std::vector<Block> blocks = blocks_of(documentation);
    return {.anchor = html_text(anchor),
            .signature = std::move(signature),
            .number = {},
            .doc = context_.markup.lines(blocks),
            .doc_line = context_.markup.one_line(blocks),
            .notes = {}};
  }

  [[nodiscard]] EntryView make_member(const model::Object& object,
                                      const model::Member& member) const {
    EntryView view = entry(object.name + "." + member.name,
                           context_.signatures.member(object, member), member.documentation);
    view.notes = finished(explain(member));
    std::vector<std::string> origins;
    for (const model::Object* base : context_.uses.origins_of(object, member)) {
      origins.push_back(context_.signatures.member_of(*base, member.name));
    }
    if (!origins.empty()) view.notes.push_back("Inherited from " + joined(origins) + ".");
    return view;
  }

  void add_constants(DeclarationView& view, const std::vector<model::Constant>& constants,
                     const std::string& owner) const {
    GroupView group{.title = "Constants", .entries = {}};
    for (const model::Constant& constant : constants) {
      group.entries.push_back(entry(owner + "." + constant.name,
                                    context_.signatures.constant(constant, owner + "."),
                                    constant.documentation));
    }
    add(view, std::move(group));
  }

  static void add(DeclarationView& view, GroupView group) {
    if (!group.entries.empty()) view.groups.push_back(std::move(group));
  }

  [[nodiscard]] std::vector<std::string> finished(const std::vector<std::string>& sentences) const {
    std::vector<std::string> all;
    for (const std::string& sentence : sentences) all.push_back(context_.markup.prose(sentence));
    return all;
  }

  [[nodiscard]] std::string places(const std::vector<Place>& places) const {
    std::vector<std::string> links;
    for (const Place& place : places) links.push_back(context_.signatures.place(place));
    return joined(links);
  }

  const Context& context_;
};

template <class Declared>
void add_section(std::vector<SectionView>& sections, std::string_view title,
                 std::string_view anchor, const std::vector<Declared>& all,
                 const DeclarationMaker& maker, auto is_wanted) {
  SectionView section{std::string(title), std::string(anchor), {}};
  for (const Declared& one : all) {
    if (is_wanted(one)) section.declarations.push_back(maker.make(one));
  }
  if (!section.declarations.empty()) sections.push_back(std::move(section));
}

}  // namespace

std::vector<SectionView> make_sections(const Context& context) {
  const auto each = [](const auto&) { return true; };
  const model::Definition& definition = context.definition;
  const DeclarationMaker maker(context);
  std::vector<SectionView> sections;
  add_section(sections, "Objects", "_objects", definition.objects, maker, each);
  for (const RecordSection& wanted : record_sections) {
    add_section(sections, wanted.title, wanted.anchor, definition.records, maker,
                [&](const model::Record& record) { return record.kind == wanted.kind; });
  }
  add_section(sections, "Enums", "_enums", definition.enums, maker, each);
  add_section(sections, "Exceptions", "_exceptions", definition.exceptions, maker, each);
  add_section(sections, "Constants", "_constants", definition.constants, maker, each);
  return sections;
}

}  // namespace robdef::docs
