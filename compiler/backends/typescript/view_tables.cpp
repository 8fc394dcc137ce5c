// SPDX-License-Identifier: Apache-2.0
// The names by which templates reach the fields of the view.
#include "compiler/backends/typescript/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

ROBDEF_VIEW_TYPE(typescript::ConstantView, wire_name, name, key, doc, value, definition);
ROBDEF_VIEW_TYPE(typescript::EnumValueView, wire_name, name, value, doc);
ROBDEF_VIEW_TYPE(typescript::EnumView, wire_name, name, doc, values, has_values);
ROBDEF_VIEW_TYPE(typescript::ExceptionView, wire_name, short_name, name, doc);
ROBDEF_VIEW_TYPE(typescript::FieldView, wire_name, doc, type, robdef_type);
ROBDEF_VIEW_TYPE(typescript::RecordView, name, doc, number_row, constants_name, constants,
                 has_constants, fields);
ROBDEF_VIEW_TYPE(typescript::ParameterView, type, sent);
ROBDEF_VIEW_TYPE(typescript::MemberView, name, get_name, set_name, doc, is_request, type, sent,
                 parameters, call_signature, served_signature, arguments, options, result,
                 served_result, call, come_types, sent_types, interface, stub, skeleton, index,
                 index_more, handle, handle_served, handle_call, served_call);
ROBDEF_VIEW_TYPE(typescript::ObjectView, wire_name, short_name, doc, name, extends, service_extends,
                 implements, alias, stub, service, skeleton, constants_name, constants,
                 has_constants, members, has_requests);
ROBDEF_VIEW_TYPE(typescript::DeclarationView, exception, enumeration, record, object);
ROBDEF_VIEW_TYPE(typescript::ImportView, wire_name, alias);
ROBDEF_VIEW_TYPE(typescript::DefinitionView, wire_name, doc, imports, import_modules, constants,
                 has_exceptions, declarations, promise, text);
ROBDEF_VIEW_TYPE(typescript::ModelView, definitions);

}  // namespace robdef
