// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/diagnostics/source.hpp"
#include "compiler/model/model.hpp"

namespace robdef {
class JsonWriter;
}

namespace robdef::model {

/// How much of a model dump() writes.
enum class Detail {
  full,
  /// What a definition says to its readers: without file, is_import, text, line, lines and spans.
  documented,
  /// Without what two equal definitions may differ in (06, section 15): documentation and
  /// declarations are left out, too.
  shape,
};

/// The model as JSON, the same bytes for the same input. All keys are always there, in this order;
/// names of types are qualified (`example.types.Point`), empty lists are `[]`. Each `span` is
/// [begin, end]: offsets in bytes into the text, of the name, of a type all of it.
///
///   model       {"model_version": 2, "definitions": [definition]}      in load order
///   definition  name, file, is_import, version ("0.10", "" for none),
///               version_spelling (none, stdver, option), version_span, documentation, span,
///               imports [name], aliases [{name, of, span}], options [text], constants, exceptions
///               [{name, documentation, line, span}], enums, structs, pods, namedarrays, objects,
///               declarations [name] in the order of the file, text (the file, byte for byte),
///               lines
///   constant    name, type (`int32[]`, or `struct`), value, documentation, line, span. The value
///               is a number, an array of numbers, a string, or for a struct
///               [{field, constant, span}]
///   enum        name, values [{name, value, is_hexadecimal, documentation, span}], documentation,
///               line, span
///   struct      name, constants, fields, options, is_recursive, documentation, line, span
///   pod         name, constants, fields, options, packed_size (bytes), documentation, line, span
///   namedarray  name, constants, fields, options, number (`double`), number_count,
///               documentation, line, span
///   field       name, type, modifiers, documentation, line, span
///   object      name, implements [name], constants, members, options, documentation, line, span
///   member      kind (`property`, ...), name, type, index (none, int32, string; objrefs only),
///               parameters [{name, type, span}], generator (none, returns, takes, both),
///               generator_parameter ({name, type, span} or null), modifiers, access [word],
///               documentation, line, span. Generator types stand without `{generator}`; access
///               holds the modifiers that count, contradictions resolved
///   modifier    name, arguments [text], span
///   type        text (`example.types.Point[3-]{list}`), kind (primitive, struct, pod, namedarray,
///               enum, object, varvalue, varobject, unknown), name, array (none, any_length,
///               fixed_length, maximum_length, any_shape, fixed_shape), dimensions [number],
///               container (none, list, int32, string, generator), span
///   line        kind (blank, comment, documentation, statement, unread), is_in_block, span, tokens
///               [{kind, span}] (ast::TokenKind). Spans of lines follow each other without gaps;
///               between tokens there are blanks and continuations only. A line that is continued
///               is one, with all its parts
///
/// Version 1 had neither spans nor lines; all else is as it was.
std::string dump(const Model& model, const Sources& sources, Detail detail = Detail::full);

/// What dump_definitions() writes beyond the model, at the end of the JSON object of each subject.
/// Each function writes whole members: a key and its value.
class DumpAdditions {
 public:
  virtual ~DumpAdditions() = default;
  virtual void exception(JsonWriter& json, const Exception& exception) const = 0;
  virtual void enumeration(JsonWriter& json, const Enum& enumeration) const = 0;
  virtual void record(JsonWriter& json, const Record& record) const = 0;
  virtual void object(JsonWriter& json, const Object& object) const = 0;
  virtual void member(JsonWriter& json, const Object& object, const Member& member) const = 0;
  virtual void type(JsonWriter& json, const Type& type) const = 0;
};

/// Writes the member "definitions" as dump() has it for programs that never read the text: without
/// lines; with `at` ({file, line, column, length}) in place of line and span, `version_at` for
/// version_span, `code_name` (rename.hpp) beside each name that can be renamed, and `value_type` of
/// constants, which is a type, or null for a struct. docs/howto/plugins.md describes it for users.
void dump_definitions(JsonWriter& json, const Model& model, const Sources& sources,
                      const DumpAdditions& additions);

}  // namespace robdef::model
