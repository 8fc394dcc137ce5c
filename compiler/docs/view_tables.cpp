// SPDX-License-Identifier: Apache-2.0
// The names by which templates reach the fields of the view.
#include "compiler/docs/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

ROBDEF_VIEW_TYPE(docs::EntryView, anchor, signature, number, doc, doc_line, notes);
ROBDEF_VIEW_TYPE(docs::GroupView, title, is_values, entries);
ROBDEF_VIEW_TYPE(docs::DeclarationView, anchor, address, kind, name, signature, doc, notes,
                 implements, implemented_by, used_by, is_constant, groups);
ROBDEF_VIEW_TYPE(docs::SectionView, title, anchor, declarations);
ROBDEF_VIEW_TYPE(docs::AliasView, name, link);
ROBDEF_VIEW_TYPE(docs::DefinitionView, name, file, page, version, is_import, summary, doc, imports,
                 imported_by, aliases, options, sections, search_index);
ROBDEF_VIEW_TYPE(docs::TypeView, name, address, kind, definition);
ROBDEF_VIEW_TYPE(docs::ModelView, index, style, script, definitions, types);

}  // namespace robdef
