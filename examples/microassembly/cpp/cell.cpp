// SPDX-License-Identifier: Apache-2.0
#include "examples/microassembly/cpp/cell.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "rr/error.hpp"

namespace microassembly {
namespace {

class Auxiliary final : public wire::AuxiliaryDefault {
 public:
  Auxiliary() { set_light(0.8); }
};

class Camera final : public wire::CameraDefault {
 public:
  Camera(Node& node, std::shared_ptr<wire::AuxiliarySkeleton> auxiliary, std::size_t index)
      : node_(node), auxiliary_(std::move(auxiliary)), index_(index) {}

  std::string get_name() override { return index_ == 0 ? "from above" : "from the front"; }
  std::optional<wire::Picture> capture() override {
    const drawing::Canvas canvas = look(node_.state().read(), index_, auxiliary_->get_light());
    return wire::Picture{canvas.width(), canvas.height(), rr::Array<std::uint8_t>(canvas.rgb())};
  }

 private:
  Node& node_;
  std::shared_ptr<wire::AuxiliarySkeleton> auxiliary_;
  std::size_t index_;
};

}  // namespace

drawing::Canvas look(const wire::AxesState& state, std::size_t camera, double light) {
  const auto lit = [light](int red, int green, int blue) {
    const auto part = [light](int value) {
      return static_cast<std::uint8_t>(std::clamp(value * light, 0.0, 255.0));
    };
    return drawing::Color{part(red), part(green), part(blue)};
  };
  // 4 um a pixel.
  const auto column = [](double x) { return static_cast<int>(picture_width / 2.0 + x / 4); };
  const auto row = [](double up) { return static_cast<int>(picture_height / 2.0 - up / 4); };
  drawing::Canvas canvas(picture_width, picture_height, lit(200, 205, 210));
  const int size = static_cast<int>(part_size / 2);
  const auto left = tip(state, 0);
  const auto right = tip(state, 1);
  // The part is lifted with the tips.
  const double height = state.is_gripped ? (left[2] + right[2]) / 2 : 0;
  const double part_up = camera == 0 ? state.part[1] : height;
  if (camera == 1) canvas.fill(0, row(0) + size / 2, picture_width, 6, lit(90, 90, 90));
  canvas.fill(column(state.part[0]) - size / 2, row(part_up) - size / 2, size, size,
              state.is_gripped ? lit(60, 170, 80) : lit(190, 120, 40));
  for (std::size_t probe = 0; probe < 2; ++probe) {
    const auto& at = probe == 0 ? left : right;
    const double up = camera == 0 ? at[1] : at[2];
    const int end = probe == 0 ? -8 : picture_width + 8;
    for (int width = -3; width <= 3; ++width) {
      canvas.line(end, row(up + (camera == 1 ? 200 : 0)) + 3 * width, column(at[0]),
                  row(up) + width, lit(50, 60, 90));
    }
  }
  return canvas;
}

Cell::Cell(Node& node)
    : node_(node),
      table_(std::make_shared<rr::realtime::TableMemory>(node.table())),
      auxiliary_(std::make_shared<Auxiliary>()) {
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    cameras_[i] = std::make_shared<Camera>(node, auxiliary_, i);
  }
}

void Cell::join(rr::realtime::BusService& bus) {
  bus.publish(node_.state(), state());
  rr::realtime::BusService::accept(target(), node_.target());
}

std::shared_ptr<wire::CameraSkeleton> Cell::get_camera(std::int32_t index) {
  if (index < 0 || static_cast<std::size_t>(index) >= cameras_.size()) {
    throw rr::Error(rr::ErrorCode::invalid_argument, "there is no camera " + std::to_string(index));
  }
  return cameras_[static_cast<std::size_t>(index)];
}

std::vector<double> assembly() {
  // Time; stage x; both probes' distance from their rest, height, fine closing, way to the side.
  struct Key {
    double time;
    double stage;
    double reach;
    double height;
    double closing;
    double side;
  };
  constexpr std::array keys{Key{0.0, 0, 0, 200, 0, 0},       Key{0.5, 80, 0, 200, 0, 0},
                            Key{1.0, 80, 430, 200, 0, 0},    Key{1.4, 80, 430, 0, 0, 0},
                            Key{1.6, 80, 430, 0, 15, 0},     Key{1.9, 80, 430, 120, 15, 0},
                            Key{2.3, 80, 430, 120, 15, 150}, Key{2.6, 80, 430, 0, 15, 150},
                            Key{2.8, 80, 430, 0, -10, 150},  Key{3.1, 80, 430, 200, -10, 150},
                            Key{3.6, 80, 0, 200, 0, 0}};
  // Where the part is when the stage has come to rest.
  constexpr double part_at = 80;
  std::vector<double> rows;
  for (const Key& key : keys) {
    const bool is_out = key.reach > 0;
    const double shift = (is_out ? part_at : 0) + key.side;
    rows.push_back(key.time);
    for (const double sign : {1.0, -1.0}) {
      rows.insert(rows.end(), {sign * key.reach + shift, 0, key.height, sign * key.closing, 0, 0});
    }
    rows.insert(rows.end(), {key.stage, 0, 0});
  }
  return rows;
}

}  // namespace microassembly
