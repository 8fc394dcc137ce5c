// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "compiler/model/model.hpp"

namespace robdef::model {

/// A definition written anew from its model (06, section 15): service, version, imports, using,
/// options, constants, enums, exceptions, structs, pods, namedarrays, objects, each group in the
/// order of the file; four blanks of indentation, `end` alone, comments and documentation left out.
/// Parsed again it gives an equal model. Numbers stay as they were written. The model must be free
/// of errors. What a service sends is Definition::text, never this.
std::string print(const Definition& definition);

/// The base of a type as a file names it: an own type plain, an imported one by its first alias or
/// else with its service.
std::string written_base(const Type& type, const Definition& file);
/// A whole type, likewise.
std::string written(const Type& type, const Definition& file);
/// A member as its line without indentation: `function double f(int32 a) [urgent]`.
std::string written(const Member& member, const Definition& file);
/// A field as its line without indentation: `field double[] a`.
std::string written(const Field& field, const Definition& file);
/// A constant as its line without indentation: `constant int32[] A {1, 0x2}`.
std::string written(const Constant& constant);
/// Its value alone: `{1, 0x2}`.
std::string written_value(const Constant& constant);
/// An object as a file names it, for implements lines.
std::string written(const Object& object, const Definition& file);

}  // namespace robdef::model
