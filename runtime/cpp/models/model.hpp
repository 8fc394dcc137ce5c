// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

/// The models, and how they are run. See docs/project/models.md.
namespace rr::models {

/// How many interleavings of a model are run.
struct Extent {
  std::uint64_t iterations = 0;  ///< chosen at random
  bool is_all = false;           ///< instead: all of them
};

/// What a run has come to.
struct Outcome {
  bool is_right = false;
  std::uint64_t iterations = 0;
  std::string said;  ///< by Relacy: of a run that is wrong, its steps
};

/// A model, or one with a planted fault.
struct Model {
  std::string_view name;
  std::string_view fault;     ///< empty: none
  bool has_few_runs = false;  ///< so that all of them can be run
  Outcome (*run)(const Extent& extent);
};

std::span<const Model> polling_models();
std::span<const Model> caller_models();
std::span<const Model> gathering_models();
std::span<const Model> newest_models();
std::span<const Model> strand_models();
std::span<const Model> exchange_models();
std::span<const Model> ring_models();
std::span<const Model> slot_models();
std::span<const Model> pipe_ring_models();

}  // namespace rr::models
