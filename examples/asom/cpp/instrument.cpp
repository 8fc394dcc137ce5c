// SPDX-License-Identifier: Apache-2.0
#include "examples/asom/cpp/instrument.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "rr/error.hpp"

namespace asom {
namespace {

using namespace std::chrono_literals;

[[noreturn]] void refuse(std::string message) {
  throw rr::Error(rr::ErrorCode::invalid_argument, std::move(message));
}

/// Both mirrors are devices with one property, whose name and length are all that differs.
class MirrorDevice : public host::RobotDeviceDefault {
 public:
  MirrorDevice(const std::string& name, std::string property, std::size_t count, double limit)
      : property_(std::move(property)), count_(count), limit_(limit) {
    set_Name(name);
  }
  rr::Array<double> GetProperty(const std::string& name) override {
    if (name != property_) refuse(get_Name() + " has no property `" + name + "`");
    return get();
  }
  std::int32_t SetProperty(const std::string& name, const rr::Array<double>& val) override {
    if (name != property_) refuse(get_Name() + " has no property `" + name + "`");
    if (val.size() != count_) refuse(property_ + " are " + std::to_string(count_) + " numbers");
    for (const double number : val) {
      if (!(std::abs(number) <= limit_)) refuse("a number is out of the reach of " + get_Name());
    }
    return set(val);
  }

 protected:
  virtual rr::Array<double> get() = 0;
  virtual std::int32_t set(const rr::Array<double>& values) = 0;

 private:
  const std::string property_;
  const std::size_t count_;
  const double limit_;
};

class ScanningMirror final : public MirrorDevice {
 public:
  explicit ScanningMirror(std::shared_ptr<Instrument> instrument)
      : MirrorDevice("scanning mirror", "Angles", 2, 1), instrument_(std::move(instrument)) {}

 private:
  rr::Array<double> get() override {
    const MirrorAngles angles = instrument_->angles();
    return {angles.x, angles.y};
  }
  std::int32_t set(const rr::Array<double>& values) override {
    return instrument_->point(values[0], values[1]);
  }
  std::shared_ptr<Instrument> instrument_;
};

class DeformableMirror final : public MirrorDevice {
 public:
  explicit DeformableMirror(std::shared_ptr<Instrument> instrument)
      : MirrorDevice("deformable mirror", "Actuators", actuator_count, 2),
        instrument_(std::move(instrument)) {}

 private:
  rr::Array<double> get() override {
    const auto actuators = instrument_->actuators();
    return rr::Array<double>(std::span<const double>(actuators));
  }
  std::int32_t set(const rr::Array<double>& values) override {
    std::array<double, actuator_count> actuators{};
    std::copy(values.begin(), values.end(), actuators.begin());
    instrument_->push(actuators);
    return 0;
  }
  std::shared_ptr<Instrument> instrument_;
};

class Camera final : public host::RobotCameraDefault {
 public:
  explicit Camera(std::shared_ptr<Instrument> instrument) : instrument_(std::move(instrument)) {
    set_Name("microscope camera");
  }
  rr::Array<double> GetProperty(const std::string& name) override {
    refuse("the camera has no property `" + name + "`");
  }
  std::int32_t SetProperty(const std::string& name, const rr::Array<double>&) override {
    refuse("the camera has no property `" + name + "`");
  }
  std::optional<host::CameraBitmap> GetCurrentStreamFrameCameraBitmap() override {
    const Frame frame = instrument_->expose();
    return host::CameraBitmap{frame.width, frame.height,
                              rr::Array<std::uint8_t>(std::span<const std::uint8_t>(frame.gray))};
  }

 private:
  std::shared_ptr<Instrument> instrument_;
};

class Host final : public host::CameraHostDefault {
 public:
  explicit Host(const std::shared_ptr<Instrument>& instrument)
      : devices_{std::make_shared<ScanningMirror>(instrument),
                 std::make_shared<DeformableMirror>(instrument)},
        camera_(std::make_shared<Camera>(instrument)) {}

  std::shared_ptr<host::RobotDeviceSkeleton> get_robdevice(std::int32_t index) override {
    if (index < 0 || index > 1) refuse("there is no device " + std::to_string(index));
    return devices_[static_cast<std::size_t>(index)];
  }
  std::shared_ptr<host::RobotCameraSkeleton> get_robcamera(std::int32_t index) override {
    if (index != 0) refuse("there is no camera " + std::to_string(index));
    return camera_;
  }
  std::int32_t get_RobotDeviceCount() override { return 2; }
  std::int32_t get_RobotCameraCount() override { return 1; }
  void set_RobotDeviceCount(std::int32_t) override { refuse("the number of devices is fixed"); }
  void set_RobotCameraCount(std::int32_t) override { refuse("the number of cameras is fixed"); }

 private:
  std::array<std::shared_ptr<host::RobotDeviceSkeleton>, 2> devices_;
  std::shared_ptr<host::RobotCameraSkeleton> camera_;
};

}  // namespace

void MirrorNode::step() {
  target_.take();
  // A first-order servo with a time constant of 2 ms.
  constexpr double part = 0.4;
  now_.x += part * (target_.value().x - now_.x);
  now_.y += part * (target_.value().y - now_.y);
  angles_.write(now_);
}

Instrument::Instrument() {
  lockstep_.add(1ms, [this](const rr::realtime::Cycle&) { mirror_.step(); });
}

int Instrument::point(double x, double y) {
  const std::lock_guard lock(mutex_);
  mirror_.target().set({x, y});
  int cycles = 0;
  MirrorAngles now;
  do {
    lockstep_.run_until(lockstep_.clock().now() + 1ms);
    ++cycles;
    now = mirror_.angles().read();
  } while (std::hypot(now.x - x, now.y - y) > 1e-4);
  return cycles;
}

void Instrument::push(const std::array<double, actuator_count>& actuators) {
  const std::lock_guard lock(mutex_);
  actuators_ = actuators;
}

std::array<double, actuator_count> Instrument::actuators() const {
  const std::lock_guard lock(mutex_);
  return actuators_;
}

Frame Instrument::expose() {
  const std::lock_guard lock(mutex_);
  lockstep_.run_until(lockstep_.clock().now() + 5ms);
  const MirrorAngles now = mirror_.angles().read();
  return microscope_.expose(now.x, now.y, actuators_);
}

std::shared_ptr<host::CameraHostSkeleton> make_host(const std::shared_ptr<Instrument>& instrument) {
  return std::make_shared<Host>(instrument);
}

}  // namespace asom
