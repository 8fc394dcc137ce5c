// SPDX-License-Identifier: Apache-2.0
// The names by which templates reach the fields of the view.
#include "compiler/backends/matlab/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

ROBDEF_VIEW_TYPE(matlab::ConstantView, wire_name, name, doc, value);
ROBDEF_VIEW_TYPE(matlab::EnumView, wire_name, name, qualified, title, help, values, has_values);
ROBDEF_VIEW_TYPE(matlab::ExceptionView, wire_name, name, title, help, identifier);
ROBDEF_VIEW_TYPE(matlab::FieldView, wire_name, cpp_name, robdef_type, help);
ROBDEF_VIEW_TYPE(matlab::RecordView, name, qualified, title, help, cpp, number_type, fields,
                 constants, has_constants, constants_class);
ROBDEF_VIEW_TYPE(matlab::MemberView, name, get_name, set_name, async_wire_name, async_name,
                 async_set_name, title, help, property_doc, declaration, parameters, arguments,
                 arguments_behind, argument_cell, is_stream, object_class, binding);
ROBDEF_VIEW_TYPE(matlab::ObjectView, wire_name, short_name, name, qualified, title, help, stub,
                 stub_alias, table, constants, has_constants, members, has_members, has_properties,
                 has_methods);
ROBDEF_VIEW_TYPE(matlab::DeclarationView, exception, enumeration, record, object);
ROBDEF_VIEW_TYPE(matlab::DefinitionView, wire_name, definition_file, package, folder, path, space,
                 import_headers, import_packages, text, constants, has_constants, declarations,
                 has_objects);
ROBDEF_VIEW_TYPE(matlab::ModelView, client, definitions);

}  // namespace robdef
