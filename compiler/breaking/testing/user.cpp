// SPDX-License-Identifier: Apache-2.0
#include "compiler/breaking/testing/user.hpp"

#include <versioned_t_bus.h>

#include <versioned/t.hpp>

namespace versioned::user {

double pan_by_position() { return t::Angles{1.0, 2.0}.pan; }

double position_by_position() { return t::State{1.0, 2.0}.position; }

std::vector<std::uint8_t> frame(double position) {
  versioned_t_State state{};
  state.position = position;
  rr_bus_frame header{};
  std::vector<std::uint8_t> bytes(versioned_t_State_FRAME_BYTES);
  versioned_t_State_frame(&state, &header, bytes.data());
  return bytes;
}

std::optional<double> receive(const std::vector<std::uint8_t>& frame) {
  versioned_t_State state{};
  rr_bus_frame header{};
  rr_bus_order order{};
  const int is_taken = versioned_t_State_receive(&state, &header, &order, frame.data(),
                                                 static_cast<std::uint32_t>(frame.size()));
  if (is_taken == 0) return std::nullopt;
  return state.position;
}

}  // namespace versioned::user
