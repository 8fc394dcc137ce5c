// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "rr/array.hpp"
#include "rr/array_type.hpp"
#include "rr/container_type.hpp"
#include "rr/record.hpp"
#include "rr/type_of.hpp"
#include "rr/wire.hpp"

/// Typed values and how they travel (03). A C++ type is described by one constant `Type`, found
/// with type_of<T>; the runtime reads and writes values through it, so that generated code is
/// tables.
///
///   definition            C++
///   T, bool, string       double, float, std::int8_t ... std::uint64_t, bool, std::string
///   cdouble, csingle      std::complex<double>, std::complex<float> (include rr/complex.hpp)
///   enum                  enum class of std::int32_t
///   T[]                   rr::Array<T>
///   T[n]                  std::array<T, n>                    up to 16 KiB, above: rr::Array<T>
///   T[n-]                 rr::BoundedArray<T, n>              likewise
///   T[*]                  rr::MultiArray<T>
///   T[m,n]                rr::FixedMultiArray<T, m, n>        likewise, above: rr::MultiArray<T>
///   struct S              std::optional<S>; rr::Recursive<S> in a field where S may contain itself
///   X{list}               std::optional<std::vector<X>>
///   X{int32}              std::optional<std::map<std::int32_t, X>>
///   X{string}             std::optional<std::map<std::string, X>>
///   varvalue              rr::VarValue
///   pod P, namedarray N   P, N; in the array forms above as T
///
/// What the protocol allows to be null is std::optional (structs, containers) or has a null state
/// (varvalue); inside a container an item that is a struct is std::optional too.
