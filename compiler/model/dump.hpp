// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/diagnostics/source.hpp"
#include "compiler/model/model.hpp"

namespace robdef::model {

/// How much of a model dump() writes.
enum class Detail {
  full,
  /// Without what two equal definitions may differ in (06, section 15): file, is_import, text,
  /// declarations, documentation, line.
  shape,
};

/// The model as JSON, the same bytes for the same input. All keys are always there, in this order;
/// names of types are qualified (`example.types.Point`), empty lists are `[]`.
///
///   model       {"model_version": 1, "definitions": [definition]}      in load order
///   definition  name, file, is_import, version ("0.10", "" for none),
///               version_spelling (none, stdver, option), documentation, imports [name],
///               aliases [{name, of}], options [text], constants, exceptions
///               [{name, documentation, line}], enums, structs, pods, namedarrays, objects,
///               declarations [name] in the order of the file, text (the file, byte for byte)
///   constant    name, type (`int32[]`, or `struct`), value, documentation, line. The value is a
///               number, an array of numbers, a string, or for a struct [{field, constant}]
///   enum        name, values [{name, value, is_hexadecimal, documentation}], documentation, line
///   struct      name, constants, fields, options, is_recursive, documentation, line
///   pod         name, constants, fields, options, packed_size (bytes), documentation, line
///   namedarray  name, constants, fields, options, number (`double`), number_count,
///               documentation, line
///   field       name, type, modifiers, documentation, line
///   object      name, implements [name], constants, members, options, documentation, line
///   member      kind (`property`, ...), name, type, index (none, int32, string; objrefs only),
///               parameters [{name, type}], generator (none, returns, takes, both),
///               generator_parameter ({name, type} or null), modifiers, access [word],
///               documentation, line. Generator types stand without `{generator}`; access holds the
///               modifiers that count, contradictions resolved
///   modifier    name, arguments [text]
///   type        text (`example.types.Point[3-]{list}`), kind (primitive, struct, pod, namedarray,
///               enum, object, varvalue, varobject, unknown), name, array (none, any_length,
///               fixed_length, maximum_length, any_shape, fixed_shape), dimensions [number],
///               container (none, list, int32, string, generator)
std::string dump(const Model& model, const Sources& sources, Detail detail = Detail::full);

}  // namespace robdef::model
