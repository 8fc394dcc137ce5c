// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mex.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "rr/matlab/containers.hpp"
#include "rr/matlab/misfit.hpp"
#include "rr/matlab/numbers.hpp"

/// Arrays of sizes that the interpreter's own do not keep: fewer than two, ones at the end. They
/// are of the toolbox's class RobotRaconteurMultiDimArray. For the interpreter's thread.
namespace rr::matlab {

/// Sizes as they travel, first index fastest.
using WireDims = std::vector<std::uint32_t>;

/// The class of such arrays. Its `dims` are those of the protocol, its `array` holds the items as
/// `T[]` does.
inline constexpr const char* shaped_class = "RobotRaconteurMultiDimArray";

/// Whether an array that is made with these sizes has them when it is asked: two at least, and no
/// one at the end beyond these. Octave multiplies all that are not 0, so they must not be too
/// large.
inline bool keeps_dims(const Dims& dims) {
  if (dims.size() < 2 || (dims.size() > 2 && dims.back() == 1)) return false;
  std::size_t room = static_cast<std::size_t>(std::numeric_limits<std::ptrdiff_t>::max());
  for (const mwSize dim : dims) {
    if (dim != 0) room /= static_cast<std::size_t>(dim);
  }
  return room != 0;
}

/// How many items there are in an array of these sizes; none in one without sizes. Throws Misfit.
inline std::size_t item_count_of(const WireDims& dims) {
  constexpr auto too_many = std::numeric_limits<std::size_t>::max();
  std::size_t count = dims.empty() ? 0 : 1;
  for (const std::uint32_t dim : dims) {  // a 0 may come last
    if (__builtin_mul_overflow(count, std::size_t{dim}, &count)) count = too_many;
  }
  if (count == too_many) throw Misfit("too many items");
  return count;
}

/// An object of that class. Takes `array` over. `numbers` is how many each item has in a dimension
/// of their own, before the others, as namedarrays do; else 0.
inline mxArray* make_shaped(std::span<const std::uint32_t> dims, mxArray* array,
                            std::size_t numbers) {
  std::vector<double> sizes(dims.begin(), dims.end());
  mxArray* const row = make_numbers<double>(sizes, {1, static_cast<mwSize>(sizes.size())});
  return call_function(shaped_class, {row, array, make_number(static_cast<double>(numbers))});
}

/// Sizes beside items.
struct Shaped {
  WireDims dims;
  const mxArray* array;
  OwnedArray owned;  ///< what `array` is, unless it is the given value's
};

/// Whether records with these fields look like the struct that stands for an array with its sizes.
inline bool looks_shaped(std::span<const char* const> fields) {
  const auto has = [&](std::string_view name) {
    return std::find(fields.begin(), fields.end(), name) != fields.end();
  };
  return fields.size() == 2 && has("dims") && has("array");
}

/// An object of that class, or struct('dims', [...], 'array', items), taken apart; the struct only
/// if `may_be_struct`, which it is not where it may be one of the items. Throws Misfit for one
/// whose sizes are none.
inline std::optional<Shaped> read_shaped(const mxArray* given, bool may_be_struct = true) {
  const auto read_dims = [](const mxArray* dims) {
    return in_field("dims", [&] { return read_vector<std::uint32_t>(dims); });
  };
  if (mxIsClass(given, shaped_class)) {
    OwnedArray array = read_property(given, "array");
    const mxArray* const items = array.get();
    return Shaped{read_dims(read_property(given, "dims").get()), items, std::move(array)};
  }
  if (!may_be_struct || !mxIsStruct(given) || count_of(given) != 1) return std::nullopt;
  std::vector<const char*> fields;
  for (int i = 0; i < mxGetNumberOfFields(given); ++i) {
    fields.push_back(mxGetFieldNameByNumber(given, i));
  }
  if (!looks_shaped(fields)) return std::nullopt;
  return Shaped{read_dims(read_field(given, "dims")), read_field(given, "array"), nullptr};
}

}  // namespace rr::matlab
