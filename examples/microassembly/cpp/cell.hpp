// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <memory>

#include "examples/drawing/canvas.hpp"
#include "examples/microassembly/cpp/node.hpp"
#include "rr/realtime/service.hpp"

namespace microassembly {

inline constexpr int picture_width = 320;
inline constexpr int picture_height = 240;

/// What a camera sees of the cell: 0 looks from above, 1 from the front, where z is up.
drawing::Canvas look(const wire::AxesState& state, std::size_t camera, double light);

/// The host: offers node, cameras and all else as one object.
class Cell final : public wire::CellDefault {
 public:
  /// The node lives longer.
  explicit Cell(Node& node);
  /// Once it is offered: joins its wires to the node's bus.
  void join(rr::realtime::BusService& bus);

  std::shared_ptr<rr::ArrayMemorySource<double>> table() override { return table_; }
  std::uint64_t follow_table(std::uint32_t rows) override { return table_->load(rows); }
  std::shared_ptr<wire::CameraSkeleton> get_camera(std::int32_t index) override;
  std::shared_ptr<wire::AuxiliarySkeleton> get_auxiliary() override { return auxiliary_; }

 private:
  Node& node_;
  std::shared_ptr<rr::realtime::TableMemory> table_;
  std::shared_ptr<wire::AuxiliarySkeleton> auxiliary_;
  std::array<std::shared_ptr<wire::CameraSkeleton>, 2> cameras_;
};

/// Rows of a time and 15 positions: the stage brings the part into the middle, the probes come down
/// on both sides of it, close with their fine axes, lift it, carry it 150 um to the side and let
/// go.
std::vector<double> assembly();

}  // namespace microassembly
