// SPDX-License-Identifier: Apache-2.0
// The microassembly cell: one real-time node of 15 axes, a host that offers it with cameras and all
// else, and a script that has two probes carry a part.
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "examples/drawing/plot.hpp"
#include "examples/microassembly/cpp/cell.hpp"
#include "examples/serving/serving.hpp"
#include "rr/node.hpp"
#include "rr/realtime/lockstep.hpp"

namespace {

using namespace std::chrono_literals;
namespace wire = microassembly::wire;

constexpr const char* usage =
    "usage: microassembly [--picture FILE.png] | microassembly --serve SECONDS\n"
    "Has two probes take a part from the stage and carry it to the side.\n"
    "  --serve SECONDS  moves nothing by itself, and is there for clients for so long; 0 is until "
    "it\n"
    "                   is interrupted\n";

/// Both cameras at one moment, beside each other.
void put_pictures(drawing::Canvas& canvas, wire::CellStub& cell, int top) {
  for (int i = 0; i < 2; ++i) {
    const auto camera = cell.get_camera(i);
    const auto picture = camera->capture();
    if (!picture) throw rr::Error(rr::ErrorCode::null_value, "a camera gave no picture");
    const int left = i * (microassembly::picture_width + 8);
    canvas.picture(left, top, picture->width, picture->height,
                   std::span<const std::uint8_t>(picture->data.data(), picture->data.size()));
    canvas.text(left + 6, top + 6, camera->get_name());
  }
}

}  // namespace

int main(int argc, char** argv) try {
  std::string file;
  std::optional<int> seconds;
  if (argc == 3 && std::string_view(argv[1]) == "--picture") {
    file = argv[2];
  } else if (argc == 3 && std::string_view(argv[1]) == "--serve") {
    seconds = serving::read_seconds(argv[2]);
  }
  if (argc != 1 && file.empty() && !seconds) {
    std::fputs(usage, stderr);
    return 2;
  }

  std::optional<serving::Stay> stay;
  if (seconds) stay.emplace(*seconds);
  microassembly::Node node;
  rr::realtime::Lockstep world;
  world.add(1ms, [&node](const rr::realtime::Cycle& cycle) { node.step(cycle); });
  rr::Node server({.name = "experimental.microassembly_host"});
  const auto object = std::make_shared<microassembly::Cell>(node);
  const auto service = server.register_service("Cell", object);
  const auto port = server.listen_tcp(0, "127.0.0.1");
  rr::realtime::BusService bus(10ms);
  object->join(bus);

  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "?service=Cell";
  if (stay) {
    serving::announce(url);
    // The machine's clock paces the simulated one.
    while (stay->wait(10ms)) world.run_until(world.clock().now() + 10ms);
    return 0;
  }

  rr::Node client;
  const auto cell = client.connect<wire::CellStub>(url);
  cell->get_auxiliary()->set_light(1);
  const auto rows = microassembly::assembly();
  cell->table().write(0, rows);
  cell->follow_table(static_cast<std::uint32_t>(rows.size() / 16));

  constexpr int height = microassembly::picture_height + 8;
  drawing::Canvas canvas(2 * microassembly::picture_width + 8, 3 * height + 300);
  drawing::Plot plot{"um",
                     "s",
                     "",
                     {{"part x", {}, {}},
                      {"left tip x", {}, {}},
                      {"left tip z", {}, {}},
                      {"right tip x", {}, {}}}};
  int gripped = 0;
  for (int i = 1; i <= 400; ++i) {
    world.run_until(i * 10ms);
    const wire::AxesState state = cell->state().peek_in().value;
    const double values[] = {state.part[0], microassembly::tip(state, 0)[0],
                             microassembly::tip(state, 0)[2], microassembly::tip(state, 1)[0]};
    for (std::size_t j = 0; j < plot.series.size(); ++j) {
      plot.series[j].x.push_back(i / 100.0);
      plot.series[j].y.push_back(values[j]);
    }
    gripped += state.is_gripped ? 1 : 0;
    if (i == 100) put_pictures(canvas, *cell, 0);
    if (i == 230) put_pictures(canvas, *cell, height);
    if (i == 400) put_pictures(canvas, *cell, 2 * height);
  }
  const wire::AxesState end = cell->state().peek_in().value;
  std::printf("15 axes on one node: the part was held for %.2f s and lies at %.1f, %.1f um%s\n",
              gripped / 100.0, end.part[0], end.part[1], end.is_moving ? ", axes move" : "");
  if (!file.empty()) {
    drawing::draw(canvas, plot, 0, 3 * height, canvas.width(), 300);
    canvas.write(file);
    std::printf("written to %s\n", file.c_str());
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "microassembly: %s\n", error.what());
  return 1;
}
