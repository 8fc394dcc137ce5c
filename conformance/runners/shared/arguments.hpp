// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <rr/call.hpp>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <utility>

#include "conformance/runners/shared/values.hpp"

namespace rr::conformance {

/// The arguments of a generated function, read from a list in the notation of the captures.
/// `Parameters` are those of the function; its last one takes the options of the call, which are no
/// part of the list.
template <class... Parameters>
auto read_arguments(const Adapters& adapters, const Json& list) {
  using All = std::tuple<std::decay_t<Parameters>...>;
  constexpr std::size_t count = sizeof...(Parameters) - 1;
  static_assert(std::is_same_v<std::tuple_element_t<count, All>, CallOptions>);
  if (list.size() != count) throw std::runtime_error("another parameter count");
  return [&]<std::size_t... Places>(std::index_sequence<Places...>) {
    return std::tuple<std::tuple_element_t<Places, All>...>{
        made_from_json<std::tuple_element_t<Places, All>>(adapters, list.at(Places))...};
  }
  (std::make_index_sequence<count>());
}

}  // namespace rr::conformance
