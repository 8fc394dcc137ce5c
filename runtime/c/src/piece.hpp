// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>

#include "rr/error.hpp"
#include "runtime/c/src/elements.hpp"
#include "runtime/c/src/memory_types.hpp"

/// A part of a memory of pods or namedarrays that the program gives.
struct rr_piece {
  std::optional<rr::capi::Raw> data;

  /// Throws rr::Error (null_value) when it has given none.
  rr::capi::Raw take() {
    if (!data) throw rr::Error(rr::ErrorCode::null_value, "the program has given no piece");
    return std::move(*data);
  }
};

namespace rr::capi {

/// A status that the program's function returns instead of transferring a piece.
Error piece_error(rr_status status);

}  // namespace rr::capi
