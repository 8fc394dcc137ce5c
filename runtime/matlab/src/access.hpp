// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/matlab/src/objects.hpp"

/// What can be done with a member of an object, for the commands that the toolbox knows. For the
/// interpreter's thread.
namespace rr::matlab {

/// What a name behind an object gives. Numbers that the toolbox knows, too.
enum class Given : int {
  value = 0,
  result = 1,
  nothing = 2,
  object = 3,
  generator = 4,
  wire = 5,
  pipe = 6,
  memory = 7,
};

struct Accessed {
  mxArray* value;  ///< a number or a name, from which the toolbox makes what is not a value
  Given kind;
  /// Whether parentheses behind the name belong to it: they are arguments, not indexes.
  [[nodiscard]] bool is_called() const {
    return kind == Given::result || kind == Given::object || kind == Given::generator;
  }
};

/// Reads a property, calls a function, finds an object, ... Throws rr::Error.
Accessed access_member(Runtime& runtime, ObjectHandle& object, const std::string& name,
                       const std::vector<const mxArray*>& arguments);

/// Writes a property, or sets the function of a callback. Throws rr::Error.
void assign_member(Runtime& runtime, ObjectHandle& object, const std::string& name,
                   const mxArray* value);

/// Starts the same as access_member() without waiting for it. `given` are the member's arguments,
/// then handler, its parameter and seconds, which may be left out from the end. Throws rr::Error.
void start_member(Runtime& runtime, const std::shared_ptr<ObjectHandle>& object,
                  const std::string& name, std::span<const mxArray* const> given);

}  // namespace rr::matlab
