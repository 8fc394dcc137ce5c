// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rr/visibility.hpp"

namespace RR_VISIBLE rr {

/// How values of one C++ type are kept where the type is not known: what arrives on pipes, wires
/// and callbacks is decoded into a value of its own, which is then handed on without a copy.
/// Constants, one for each type. How the values travel is the business of rr::Type.
struct Holding {
  std::shared_ptr<void> (*make)();           ///< a value in its first state
  void (*copy)(const void* from, void* to);  ///< assigns
};

/// How values of a T are kept.
template <class T>
inline constexpr Holding holding_of{
    [] { return std::static_pointer_cast<void>(std::make_shared<T>()); },
    [](const void* from, void* to) { *static_cast<T*>(to) = *static_cast<const T*>(from); }};

}  // namespace rr
