// SPDX-License-Identifier: Apache-2.0
// Included once for each version, so without a guard.

#include <cstdint>
#include <optional>
#include <vector>

/// One program, compiled with the code that is generated from two versions of a definition, in
/// which fields have changed places. `versioned` is before and after.
namespace versioned::user {

/// The pan of a struct that is given pan and tilt by position, as 1 and 2.
double pan_by_position();
/// The position of a pod that is given position and velocity by position, as 1 and 2.
double position_by_position();
/// A frame of a real-time node, with this position.
std::vector<std::uint8_t> frame(double position);
/// The position in a frame that has come; nothing when it is dropped.
std::optional<double> receive(const std::vector<std::uint8_t>& frame);

}  // namespace versioned::user
