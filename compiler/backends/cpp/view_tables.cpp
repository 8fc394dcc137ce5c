// SPDX-License-Identifier: Apache-2.0
// The names by which templates reach the fields of the view.
#include "compiler/backends/cpp/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

ROBDEF_VIEW_TYPE(cpp::ConstantPartView, opens, closes, is_empty);
ROBDEF_VIEW_TYPE(cpp::ConstantView, wire_name, doc, is_struct, parts);
ROBDEF_VIEW_TYPE(cpp::InitialView, literal, length, shape, item);
ROBDEF_VIEW_TYPE(cpp::VariableView, type, name, initial);
ROBDEF_VIEW_TYPE(cpp::AliasView, name, target);
ROBDEF_VIEW_TYPE(cpp::EnumValueView, wire_name, name, value, doc);
ROBDEF_VIEW_TYPE(cpp::EnumView, wire_name, name, qualified, doc, has_values, values);
ROBDEF_VIEW_TYPE(cpp::ExceptionView, wire_name, name, qualified, doc, message, subname, parameter,
                 error);
ROBDEF_VIEW_TYPE(cpp::FieldView, wire_name, name, doc, type, descriptor, robdef_type, initial);
ROBDEF_VIEW_TYPE(cpp::RecordView, name, class_name, qualified, doc, number_type, constants, fields,
                 table, field_table);
ROBDEF_VIEW_TYPE(cpp::ParameterView, type, initial, descriptor, is_by_value);
ROBDEF_VIEW_TYPE(cpp::MemberView, name, place, doc, type, descriptor, variable, item, handle,
                 served, parameters, yields, generator_parameter, stub, skeleton, qualified_stub,
                 qualified_skeleton, is_hidden, taken, has_handle, described, access, has_no_table,
                 is_by_value, code, token_mark, type_mark, options_mark, answer_mark, client_mark,
                 index_mark, value_mark);
ROBDEF_VIEW_TYPE(cpp::BaseView, wire_name, stub, skeleton);
ROBDEF_VIEW_TYPE(cpp::ObjectView, wire_name, short_name, name, stub_doc, skeleton_doc, default_doc,
                 stub, stub_class, skeleton, default_class, qualified_stub, qualified_skeleton,
                 qualified_default, has_default, implements, has_implements, constants,
                 has_constants, members, has_members, has_parameters, has_calls, has_objrefs,
                 uses_index, has_memories, has_stored, table, member_table, implements_table,
                 parameter_tables);
ROBDEF_VIEW_TYPE(cpp::DeclarationView, constant, exception, enumeration, record, object, ends_group,
                 is_early);
ROBDEF_VIEW_TYPE(cpp::ForwardView, name, is_struct);
ROBDEF_VIEW_TYPE(cpp::ImportView, wire_name, header, qualified);
ROBDEF_VIEW_TYPE(cpp::DefinitionView, wire_name, space, qualified, path, header, doc, includes,
                 import_includes, imports, has_imports, has_early, aliases, has_aliases, forwards,
                 has_forwards, declarations, has_fields, has_records, has_exceptions, has_objects,
                 text, version);
ROBDEF_VIEW_TYPE(cpp::ModelView, definitions);

}  // namespace robdef
