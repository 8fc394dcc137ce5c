// SPDX-License-Identifier: Apache-2.0
// Does with the smart room what the paper does from MATLAB: connects by URL, sets lamps, reads
// sensors, takes a picture.
#include <cstdio>
#include <exception>
#include <string>
#include <string_view>

#include "RobotCameraHost_interface.hpp"
#include "examples/drawing/png_file.hpp"
#include "rr/node.hpp"

namespace {

namespace host = RobotCameraHost_interface;

constexpr const char* usage =
    "usage: smart_room_client [URL] [--picture FILE.png]\n"
    "Uses the smart room at URL (default tcp://localhost:6257/RobotCameraHost/CameraHost).\n";

void print_colors(const char* what, const rr::Array<double>& values) {
  std::printf("%s:\n", what);
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    std::printf("  %zu  red %.3f  green %.3f  blue %.3f\n", i / 3, values[i], values[i + 1],
                values[i + 2]);
  }
}

}  // namespace

int main(int argc, char** argv) try {
  std::string url = "tcp://localhost:6257/RobotCameraHost/CameraHost";
  std::string picture_file;
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--picture" && i + 1 < argc) {
      picture_file = argv[++i];
    } else if (!word.starts_with("-")) {
      url = word;
    } else {
      std::fputs(usage, stderr);
      return 2;
    }
  }

  rr::Node node;
  const auto smartroom = node.connect<host::CameraHostStub>(url);
  std::printf("connected to %s: %d devices, %d cameras\n", url.c_str(),
              smartroom->get_RobotDeviceCount(), smartroom->get_RobotCameraCount());

  const auto lights = smartroom->get_robdevice(0);
  const auto sensors = smartroom->get_robdevice(1);
  const auto camera = smartroom->get_robcamera(2);
  std::printf("device 0 is `%s`, device 1 is `%s`, camera 2 is `%s`\n", lights->get_Name().c_str(),
              sensors->get_Name().c_str(), camera->get_Name().c_str());

  print_colors("sensors before", sensors->GetProperty("ReadRGB"));
  lights->SetProperty("SetRGBRange", {1, 2, 0.7, 0.3, 0});
  std::printf("lamps 1 to 2 set to red 0.7, green 0.3, blue 0\n");
  print_colors("sensors after", sensors->GetProperty("ReadRGB"));

  const auto frame = camera->GetCurrentStreamFrameCameraBitmap();
  if (!frame) throw rr::Error(rr::ErrorCode::null_value, "the camera gave no picture");
  std::printf("a picture of %d x %d pixels\n", frame->width, frame->height);
  if (!picture_file.empty()) {
    drawing::write_png(picture_file, frame->width, frame->height, frame->data);
    std::printf("written to %s\n", picture_file.c_str());
  }

  try {
    lights->SetProperty("SetRGBRange", {1, 99, 0, 0, 0});
  } catch (const rr::Error& error) {
    std::printf("lamp 99 is refused by the service: %s\n", error.what());
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "smart_room_client: %s\n", error.what());
  return 1;
}
