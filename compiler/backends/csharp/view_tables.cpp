// SPDX-License-Identifier: Apache-2.0
// The names by which templates reach the fields of the view.
#include "compiler/backends/csharp/view.hpp"
#include "compiler/output/view_type.hpp"

namespace robdef {

ROBDEF_VIEW_TYPE(csharp::ConstantView, wire_name, name, doc, definition);
ROBDEF_VIEW_TYPE(csharp::EnumValueView, wire_name, name, value, doc);
ROBDEF_VIEW_TYPE(csharp::EnumView, wire_name, name, doc, values);
ROBDEF_VIEW_TYPE(csharp::ExceptionView, wire_name, name, doc);
ROBDEF_VIEW_TYPE(csharp::FieldView, wire_name, name, doc, type, initial, codec, robdef_type, items,
                 item_type, item_count);
ROBDEF_VIEW_TYPE(csharp::RecordView, name, doc, number_type, number_codec, packed_size, constants,
                 fields, writes, has_rows, field_count, codec_class);
ROBDEF_VIEW_TYPE(csharp::ParameterView, type, codec);
ROBDEF_VIEW_TYPE(csharp::MemberView, name, place, doc, is_hiding, row, access, type, codec, initial,
                 item, item_codec, parameters, writes, signature, signature_before, arguments,
                 arguments_before, cancel, client, urgent, handler, task, result, served,
                 served_before, served_cancel, invocation, verb, codecs, answer,
                 generator_parameter, interface, stub, index_parameter, index_argument, index_type,
                 index_read, handle, handle_served, first);
ROBDEF_VIEW_TYPE(csharp::ObjectView, wire_name, short_name, doc, interface, bases, stub, skeleton,
                 default_class, has_default, constants, members, has_members, has_requests,
                 has_memories);
ROBDEF_VIEW_TYPE(csharp::DeclarationView, exception, enumeration, record, object);
ROBDEF_VIEW_TYPE(csharp::LibraryView, task, value_task, token, async_enumerable, stub, stub_type,
                 object_handle, skeleton, call, request, served_type, served_member, served_memory,
                 stored, stored_per_client, stored_memory, not_implemented);
ROBDEF_VIEW_TYPE(csharp::CodecView, name, type, value);
ROBDEF_VIEW_TYPE(csharp::DefinitionView, wire_name, space, doc, usings, library, value_codec,
                 struct_codec, pod_codec, namedarray_codec, element_writer, field_reader, error,
                 error_code, varvalue, service_definition, exception_type, stub_api, has_objects,
                 imports, constants, has_constants, declarations, codecs, has_codecs, has_fields,
                 text);
ROBDEF_VIEW_TYPE(csharp::ModelView, definitions);

}  // namespace robdef
