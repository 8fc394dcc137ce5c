// SPDX-License-Identifier: Apache-2.0
// A light as a service of this computer, which does what the sketch of the library's examples does:
// light_client cannot tell which of them it has. Prints its port, and stays until standard input
// ends.
#include <chrono>
#include <condition_variable>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <rr/error.hpp>
#include <rr/node.hpp>
#include <thread>

#include "example/light.hpp"
#include "runtime/arduino/bench/light/stay.hpp"

namespace {

using namespace std::chrono_literals;
using example::light::Color;
using Clock = std::chrono::steady_clock;

class Lamp final : public example::light::LightSkeleton {
 public:
  Lamp() : thread_([this] { run(); }) {
    sensor().on_peek_in([this] { return get_brightness(); });
  }
  ~Lamp() override {
    {
      const std::lock_guard lock(mutex_);
      stops_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }

  std::optional<Color> get_color() override {
    const std::lock_guard lock(mutex_);
    return color_;
  }
  void set_color(const std::optional<Color>& value) override {
    const std::lock_guard lock(mutex_);
    color_ = checked(value);
    fade_end_.reset();
  }
  // Half of what the converter of a board can see, in its steps of half a lux.
  double get_brightness() override { return 255.5; }
  void fade(const std::optional<Color>& target, double duration) override {
    if (!(duration >= 0) || duration > 60) throw rr::Error(rr::ErrorCode::out_of_range, "too long");
    const std::lock_guard lock(mutex_);
    target_ = checked(target);
    fade_end_ = Clock::now() + std::chrono::milliseconds(static_cast<int>(duration * 1000));
    changed_.notify_all();
  }

 private:
  static Color checked(const std::optional<Color>& value) {
    if (!value) throw rr::Error(rr::ErrorCode::null_value, "a colour is needed");
    for (const float part : {value->red, value->green, value->blue}) {
      if (!(part >= 0 && part <= 1)) throw rr::Error(rr::ErrorCode::out_of_range, "no colour");
    }
    return *value;
  }

  void run() {
    auto sample = Clock::now();
    std::unique_lock lock(mutex_);
    while (!stops_) {
      changed_.wait_until(lock, fade_end_ ? std::min(*fade_end_, sample) : sample);
      const auto now = Clock::now();
      if (fade_end_ && *fade_end_ <= now) {
        color_ = target_;
        fade_end_.reset();
        lock.unlock();
        faded(target_);
        lock.lock();
      }
      if (sample <= now) {
        sample = now + 100ms;
        lock.unlock();
        sensor().set_in(get_brightness());
        lock.lock();
      }
    }
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  Color color_;
  Color target_;
  std::optional<Clock::time_point> fade_end_;
  bool stops_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace

int main() {
  rr::Node node({.name = "light.host"});
  const auto service = node.register_service("Light", std::make_shared<Lamp>());
  std::cout << "port " << node.listen_tcp(0, "127.0.0.1") << std::endl;
  rr::serial::testing::stay();
  return 0;
}
