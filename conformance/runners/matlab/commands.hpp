// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <span>
#include <string>
#include <vector>

namespace rr::conformance {

/// What the functions of the roles need of C++: lines of JSON, what definitions declare, and values
/// in the notation of the captures.
///
///   open(folder)                    reads the definitions; the first command
///   [request, state] = read(seconds)  1 for a request, 0 for none in time, -1 at the input's end
///   write(answer)
///   definitions(service)            the texts that it needs, a column of cells
///   members(object type)            a struct of structs by the names of the members: kind, type
///   ('' for
///                                   void), parameters (types), is_generator, is_flat, is_free
///                                   (nolock)
///   value(type, json)               the interpreter's value
///   json(type, value)
///
/// False for an unknown name. Throws rr::Error, Misfit.
bool run_command(const std::string& name, std::span<const mxArray* const> arguments,
                 std::vector<mxArray*>& results);

}  // namespace rr::conformance
