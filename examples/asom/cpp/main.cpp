// SPDX-License-Identifier: Apache-2.0
// The adaptive scanning microscope: a host with camera and both mirrors, and a script that sharpens
// the picture by the deformable mirror at each place of a grid, and puts the pictures together.
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "examples/asom/cpp/instrument.hpp"
#include "examples/asom/cpp/sharpen.hpp"
#include "examples/drawing/canvas.hpp"
#include "examples/serving/serving.hpp"
#include "rr/node.hpp"

namespace {

constexpr const char* usage =
    "usage: asom [--picture FILE.png] [--grid N] | asom --serve SECONDS\n"
    "Scans a grid of N x N places (3), each with a flat mirror and with one that was sharpened.\n"
    "  --serve SECONDS  scans nothing by itself, and is there for clients for so long; 0 is until "
    "it\n"
    "                   is interrupted\n";

/// A frame in shades of gray, its middle only.
void put(drawing::Canvas& canvas, int left, int top, const asom::Frame& frame) {
  const int edge = (frame.width - asom::tile_size) / 2;
  for (int y = 0; y < asom::tile_size; ++y) {
    for (int x = 0; x < asom::tile_size; ++x) {
      const auto gray = frame.gray[static_cast<std::size_t>((y + edge) * frame.width + x + edge)];
      canvas.fill(left + 2 * x, top + 2 * y, 2, 2, {gray, gray, gray});
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  std::string picture;
  int grid = 3;
  std::optional<int> seconds;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--picture" && i + 1 < argc) {
      picture = argv[++i];
    } else if (word == "--grid" && i + 1 < argc) {
      grid = std::atoi(argv[++i]);
    } else if (word == "--serve" && i + 1 < argc) {
      seconds = serving::read_seconds(argv[++i]);
      if (!seconds) grid = 0;
    } else {
      grid = 0;
    }
  }
  if (grid < 1 || grid > 8) {
    std::fputs(usage, stderr);
    return 2;
  }

  std::optional<serving::Stay> stay;
  if (seconds) stay.emplace(*seconds);
  rr::Node server({.name = "experimental.asom_host"});
  const auto service =
      server.register_service("CameraHost", asom::make_host(std::make_shared<asom::Instrument>()));
  const auto port = server.listen_tcp(0, "127.0.0.1");
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "?service=CameraHost";
  if (stay) {
    serving::announce(url);
    stay->wait_for_end();
    return 0;
  }
  rr::Node client;
  const auto root = client.connect<asom::host::CameraHostStub>(url);
  asom::Instruments instruments(*root);

  const int size = 2 * asom::tile_size * grid;
  drawing::Canvas canvas(2 * size + 16, size + 20);
  canvas.text(4, 4, "flat mirror");
  canvas.text(size + 20, 4, "sharpened");
  double before = 0;
  double after = 0;
  int frames = 0;
  for (int row = 0; row < grid; ++row) {
    for (int column = 0; column < grid; ++column) {
      const auto angle = [&](int place) {
        return (2.0 * place + 1 - grid) * asom::tile_size / 128.0;
      };
      instruments.point(angle(column), angle(row));
      const asom::Sharpened result = asom::sharpen(instruments);
      put(canvas, 2 * asom::tile_size * column, 20 + 2 * asom::tile_size * row, result.flat);
      put(canvas, size + 16 + 2 * asom::tile_size * column, 20 + 2 * asom::tile_size * row,
          result.sharp);
      before += asom::sharpness(result.flat);
      after += asom::sharpness(result.sharp);
      frames += result.frames;
    }
  }
  std::printf("%d places, %d frames: sharpness %.1f with a flat mirror, %.1f sharpened\n",
              grid * grid, frames, before / (grid * grid), after / (grid * grid));
  if (!picture.empty()) {
    canvas.write(picture);
    std::printf("written to %s\n", picture.c_str());
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "asom: %s\n", error.what());
  return 1;
}
