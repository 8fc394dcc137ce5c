// SPDX-License-Identifier: Apache-2.0
// Serves the simulated room as the paper's RobotCameraHost: one host object with devices (lamps and
// sensors behind one general interface) and cameras.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "RobotCameraHost_interface.hpp"
#include "examples/serving/serving.hpp"
#include "examples/smart_room/cpp/room.hpp"
#include "rr/node.hpp"

namespace {

namespace host = RobotCameraHost_interface;
using smart_room::Color;
using smart_room::Room;

[[noreturn]] void refuse(std::string message) {
  throw rr::Error(rr::ErrorCode::invalid_argument, std::move(message));
}

rr::Array<double> numbers(const smart_room::Place& place) { return {place.x, place.y, place.z}; }

void append(std::vector<double>& to, const Color& color) {
  to.insert(to.end(), {color.red, color.green, color.blue});
}

/// All lamps as one device. Properties: `SetRGBRange` takes first and last lamp (from 1), red,
/// green, blue; `GetRGB` gives three numbers a lamp; `Positions` three coordinates a lamp, in
/// metres.
class Lights final : public host::RobotDeviceDefault {
 public:
  explicit Lights(std::shared_ptr<Room> room) : room_(std::move(room)) { set_Name("RGB lights"); }

  rr::Array<double> GetProperty(const std::string& name) override {
    std::vector<double> result;
    if (name == "GetRGB") {
      for (const Color& color : room_->lights()) append(result, color);
    } else if (name == "Positions") {
      for (std::size_t i = 0; i < Room::light_count; ++i) {
        const auto place = Room::light_place(i);
        result.insert(result.end(), {place.x, place.y, place.z});
      }
    } else {
      refuse("the lights have no property `" + name + "` to get");
    }
    return result;
  }

  std::int32_t SetProperty(const std::string& name, const rr::Array<double>& val) override {
    if (name != "SetRGBRange") refuse("the lights have no property `" + name + "` to set");
    if (val.size() != 5) refuse("SetRGBRange takes first, last, red, green, blue");
    for (std::size_t i = 2; i < 5; ++i) {
      if (!(val[i] >= 0 && val[i] <= 1)) refuse("a color is a number from 0 to 1");
    }
    const auto lamp = [](double number) {
      if (!(number >= 1 && number <= static_cast<double>(Room::light_count)) ||
          number != std::floor(number)) {
        refuse("lamps are counted from 1 to " + std::to_string(Room::light_count));
      }
      return static_cast<std::size_t>(number);
    };
    if (lamp(val[0]) > lamp(val[1])) refuse("the first lamp comes behind the last");
    room_->set_lights(lamp(val[0]), lamp(val[1]), {val[2], val[3], val[4]});
    return 0;
  }

 private:
  std::shared_ptr<Room> room_;
};

/// All color sensors as one device. Properties: `ReadRGB` gives three numbers a sensor; `Positions`
/// three coordinates a sensor, in metres.
class Sensors final : public host::RobotDeviceDefault {
 public:
  explicit Sensors(std::shared_ptr<Room> room) : room_(std::move(room)) { set_Name("RGB sensors"); }

  rr::Array<double> GetProperty(const std::string& name) override {
    std::vector<double> result;
    for (std::size_t i = 0; i < Room::sensor_count; ++i) {
      if (name == "ReadRGB") {
        append(result, room_->sensor(i));
      } else if (name == "Positions") {
        const auto place = Room::sensor_place(i);
        result.insert(result.end(), {place.x, place.y, place.z});
      } else {
        refuse("the sensors have no property `" + name + "` to get");
      }
    }
    return result;
  }

  std::int32_t SetProperty(const std::string& name, const rr::Array<double>&) override {
    refuse("the sensors have no property `" + name + "` to set");
  }

 private:
  std::shared_ptr<Room> room_;
};

/// A ceiling camera. Property: `Position`, in metres.
class Camera final : public host::RobotCameraDefault {
 public:
  Camera(std::shared_ptr<Room> room, std::size_t index) : room_(std::move(room)), index_(index) {
    set_Name("ceiling camera " + std::to_string(index));
  }

  rr::Array<double> GetProperty(const std::string& name) override {
    if (name != "Position") refuse("a camera has no property `" + name + "` to get");
    return numbers(Room::camera_place(index_));
  }

  std::int32_t SetProperty(const std::string& name, const rr::Array<double>&) override {
    refuse("a camera has no property `" + name + "` to set");
  }

  std::optional<host::CameraBitmap> GetCurrentStreamFrameCameraBitmap() override {
    const smart_room::Picture picture = room_->picture(index_);
    return host::CameraBitmap{picture.width, picture.height, picture.rgb};
  }

 private:
  std::shared_ptr<Room> room_;
  std::size_t index_;
};

class Host final : public host::CameraHostDefault {
 public:
  explicit Host(const std::shared_ptr<Room>& room)
      : devices_{std::make_shared<Lights>(room), std::make_shared<Sensors>(room)} {
    for (std::size_t i = 0; i < Room::camera_count; ++i) {
      cameras_.push_back(std::make_shared<Camera>(room, i));
    }
  }

  std::shared_ptr<host::RobotDeviceSkeleton> get_robdevice(std::int32_t index) override {
    return find(devices_, index, "device");
  }
  std::shared_ptr<host::RobotCameraSkeleton> get_robcamera(std::int32_t index) override {
    return find(cameras_, index, "camera");
  }
  std::int32_t get_RobotDeviceCount() override {
    return static_cast<std::int32_t>(devices_.size());
  }
  std::int32_t get_RobotCameraCount() override {
    return static_cast<std::int32_t>(cameras_.size());
  }
  void set_RobotDeviceCount(std::int32_t) override { refuse("the number of devices is fixed"); }
  void set_RobotCameraCount(std::int32_t) override { refuse("the number of cameras is fixed"); }

 private:
  template <class T>
  static std::shared_ptr<T> find(const std::vector<std::shared_ptr<T>>& all, std::int32_t index,
                                 const char* what) {
    if (index < 0 || static_cast<std::size_t>(index) >= all.size()) {
      refuse(std::string("there is no ") + what + " " + std::to_string(index));
    }
    return all[static_cast<std::size_t>(index)];
  }

  std::vector<std::shared_ptr<host::RobotDeviceSkeleton>> devices_;
  std::vector<std::shared_ptr<host::RobotCameraSkeleton>> cameras_;
};

constexpr const char* usage =
    "usage: smart_room_service [--port N] [--seconds N] [--everywhere] "
    "[--inspector FILE]\n"
    "Serves the simulated smart room until it is interrupted, or for so many seconds.\n"
    "  --port N      TCP port, 0 for any free one (default 6257)\n"
    "  --everywhere  for clients of other machines, too; without it of this one only\n"
    "  --inspector   serves the page of the inspector, this file, at http://localhost:N/\n";

struct Options {
  int port = 6257;
  int seconds = 0;
  bool is_everywhere = false;
  std::string inspector;
};

/// False when the words are no options.
bool read(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view name = argv[i];
    if (name == "--everywhere") {
      options.is_everywhere = true;
      continue;
    }
    if (++i == argc) return false;
    if (name == "--inspector") {
      options.inspector = argv[i];
      continue;
    }
    int* const value = name == "--port"      ? &options.port
                       : name == "--seconds" ? &options.seconds
                                             : nullptr;
    const char* const end = argv[i] + std::strlen(argv[i]);
    if (value == nullptr || std::from_chars(argv[i], end, *value).ptr != end || *value < 0) {
      return false;
    }
  }
  return options.port <= 65535;
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  if (!read(argc, argv, options)) {
    std::fputs(usage, stderr);
    return 2;
  }
  serving::Stay stay(options.seconds);
  rr::Node node({.name = "RobotCameraHost", .web_socket = {.inspector_page = options.inspector}});
  const auto service =
      node.register_service("CameraHost", std::make_shared<Host>(std::make_shared<Room>()));
  const auto port = node.listen_tcp(static_cast<std::uint16_t>(options.port),
                                    options.is_everywhere ? "*" : "localhost");
  serving::say_where(port, options.is_everywhere);
  serving::announce("tcp://localhost:" + std::to_string(port) + "/RobotCameraHost/CameraHost");
  stay.wait_for_end();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "smart_room_service: %s\n", error.what());
  return 1;
}
