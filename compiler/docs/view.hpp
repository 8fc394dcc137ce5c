// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "compiler/docs/docs.hpp"
#include "compiler/model/model.hpp"

/// What the templates of pages print. All texts are finished for the form of the page (Markup).
namespace robdef::docs {

/// A member, field, value of an enum, or constant of a record or object.
struct EntryView {
  std::string anchor;              ///< `Arm.move_to`
  std::string signature;           ///< as in the definition, types are links
  std::string number;              ///< value of an enum: `16 (0x10)`
  std::vector<std::string> doc;    ///< lines
  std::string doc_line;            ///< the same on one line
  std::vector<std::string> notes;  ///< sentences: modifiers, where it comes from
};

/// Entries of one kind: `Properties`.
struct GroupView {
  std::string title;
  bool is_values = false;  ///< of an enum
  std::vector<EntryView> entries;
};

/// Something that stands in a definition outside of blocks.
struct DeclarationView {
  std::string anchor;   ///< `Arm`
  std::string address;  ///< `#Arm`
  std::string kind;     ///< `object`
  std::string name;
  std::string signature;
  std::vector<std::string> doc;
  std::vector<std::string> notes;
  std::string implements;      ///< links, with commas; empty: none
  std::string implemented_by;  ///< likewise
  std::string used_by;         ///< likewise
  bool is_constant = false;
  std::vector<GroupView> groups;
};

/// Declarations of one kind: `Objects`.
struct SectionView {
  std::string title;
  std::string anchor;  ///< `_objects`; names do not begin so
  std::vector<DeclarationView> declarations;
};

struct AliasView {
  std::string name;
  std::string link;  ///< to what it stands for
};

/// The page of a definition.
struct DefinitionView {
  std::string name;
  std::string file;        ///< of the page, as it is: `example.arm.html`
  std::string page;        ///< the same as an address
  std::string version;     ///< empty: none is declared
  bool is_import = false;  ///< not given, but imported by one that is
  std::string summary;     ///< the first paragraph, on one line
  std::vector<std::string> doc;
  std::string imports;      ///< links, with commas; empty: none
  std::string imported_by;  ///< likewise
  std::vector<AliasView> aliases;
  std::vector<std::string> options;
  std::vector<SectionView> sections;
  std::string search_index;  ///< HTML: of this page, for a script
};

/// A type, in the index of all pages.
struct TypeView {
  std::string name;
  std::string address;
  std::string kind;
  std::string definition;
};

/// All pages.
struct ModelView {
  std::string index;                        ///< file of the index
  std::string style;                        ///< HTML: text of style.css
  std::string script;                       ///< HTML: text of script.js
  std::vector<DefinitionView> definitions;  ///< by name
  std::vector<TypeView> types;              ///< by name, in whatever case
};

/// All but style and script.
ModelView make_view(const model::Model& model, Form form);

}  // namespace robdef::docs
