// SPDX-License-Identifier: Apache-2.0
// light_client URL: a light of example.light is used by URL, with generated code and with the
// dynamic client. The same asserts hold for a board at rr+serial, for one behind `robdef bridge`,
// and for a service in C++.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "example/light.hpp"
#include "rr/dynamic.hpp"
#include "rr/node.hpp"
#include "rr/serial.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::serial::testing {
namespace {

using namespace std::chrono_literals;
using dynamic::Value;
using example::light::Color;
using rr::testing::error_of;
using rr::testing::eventually;

std::string url;

/// A client, whatever it is made of.
class Light {
 public:
  virtual ~Light() = default;
  [[nodiscard]] virtual std::string type_name() const = 0;
  virtual std::optional<Color> color() = 0;
  virtual void set_color(const std::optional<Color>& color) = 0;
  virtual double brightness() = 0;
  virtual void fade(const Color& target, double duration) = 0;
  virtual void on_faded(std::function<void(Color)> handler) = 0;
  virtual double peek_sensor() = 0;
  /// Connects the wire; the handler gets its values.
  virtual void on_sensor(std::function<void(double)> handler) = 0;
};

class StubLight final : public Light {
 public:
  explicit StubLight(Node& node) : client_(node.connect<example::light::LightStub>(url)) {}
  [[nodiscard]] std::string type_name() const override {
    return std::string(client_->rr_object_type().name);
  }
  std::optional<Color> color() override { return client_->get_color(); }
  void set_color(const std::optional<Color>& color) override { client_->set_color(color); }
  double brightness() override { return client_->get_brightness(); }
  void fade(const Color& target, double duration) override { client_->fade(target, duration); }
  void on_faded(std::function<void(Color)> handler) override {
    faded_ =
        client_->faded().connect([handler = std::move(handler)](const std::optional<Color>& color) {
          if (color) handler(*color);
        });
  }
  double peek_sensor() override { return client_->sensor().peek_in().value; }
  void on_sensor(std::function<void(double)> handler) override {
    wire_ = client_->sensor().connect();
    values_ = wire_.on_in(
        [handler = std::move(handler)](double value, const TimeSpec&) { handler(value); });
  }

 private:
  rr::Client<example::light::LightStub> client_;
  WireConnection<double> wire_;
  Subscription faded_;
  Subscription values_;
};

class DynamicLight final : public Light {
 public:
  explicit DynamicLight(Node& node) : client_(dynamic::connect(node, url)) {}
  [[nodiscard]] std::string type_name() const override { return client_->type_name(); }
  std::optional<Color> color() override { return color_in(client_->get("color")); }
  void set_color(const std::optional<Color>& color) override {
    client_->set("color", color ? value_of(*color) : Value());
  }
  double brightness() override { return client_->get("brightness").as<double>(); }
  void fade(const Color& target, double duration) override {
    client_->call("fade", {value_of(target), duration});
  }
  void on_faded(std::function<void(Color)> handler) override {
    faded_ =
        client_->on_event("faded", [handler = std::move(handler)](const dynamic::List& arguments) {
          handler(color_in(arguments.at(0)));
        });
  }
  double peek_sensor() override { return client_->wire("sensor").peek_in().value.as<double>(); }
  void on_sensor(std::function<void(double)> handler) override {
    wire_ = client_->wire("sensor").connect();
    values_ = wire_.on_in([handler = std::move(handler)](const Value& value, const TimeSpec&) {
      handler(value.as<double>());
    });
  }

 private:
  static Value value_of(const Color& color) {
    return Value::record({{"red", color.red}, {"green", color.green}, {"blue", color.blue}});
  }
  static Color color_in(const Value& value) {
    return {value.at("red").as<float>(), value.at("green").as<float>(),
            value.at("blue").as<float>()};
  }

  dynamic::Client client_;
  dynamic::WireConnection wire_;
  Subscription faded_;
  Subscription values_;
};

std::unique_ptr<Light> stub_light(Node& node) { return std::make_unique<StubLight>(node); }
std::unique_ptr<Light> dynamic_light(Node& node) { return std::make_unique<DynamicLight>(node); }

/// What comes by itself, in order.
template <class T>
class Came {
 public:
  std::function<void(T)> handler() {
    return [this](const T& value) {
      const std::lock_guard lock(mutex_);
      values_.push_back(value);
    };
  }
  std::vector<T> values() {
    const std::lock_guard lock(mutex_);
    return values_;
  }

 private:
  std::mutex mutex_;
  std::vector<T> values_;
};

class ALight : public ::testing::TestWithParam<std::unique_ptr<Light> (*)(Node&)> {
 protected:
  // Declared before its clients: they go first.
  Came<Color> faded;
  Came<Color> faded_too;
  Came<double> sensed;
  Node node{{.channels = {{"rr+serial", serial_channel()}}}};
  std::unique_ptr<Light> light = GetParam()(node);
};

TEST_P(ALight, KeepsItsColour) {
  EXPECT_EQ(light->type_name(), "example.light.Light");
  const Color color{0.7F, 0.3F, 0.1F};
  light->set_color(color);
  EXPECT_EQ(light->color(), color);
  EXPECT_EQ(error_of([&] {
              light->set_color(Color{0, 1.25F, 0});
            }).code(),
            ErrorCode::out_of_range);
  EXPECT_EQ(error_of([&] { light->set_color(std::nullopt); }).code(), ErrorCode::null_value);
  EXPECT_EQ(light->color(), color);
}

TEST_P(ALight, SeesLight) {
  EXPECT_NEAR(light->brightness(), 255.5, 1);
  EXPECT_NEAR(light->peek_sensor(), 255.5, 1);
  light->on_sensor(sensed.handler());
  EXPECT_TRUE(eventually([&] { return sensed.values().size() >= 3; }));
  for (const double value : sensed.values()) EXPECT_NEAR(value, 255.5, 1);
}

TEST_P(ALight, TellsAllClientsWhenAFadeHasEnded) {
  const auto another = GetParam()(node);
  light->on_faded(faded.handler());
  another->on_faded(faded_too.handler());
  const Color target{1, 0.5F, 0.25F};
  light->set_color(Color{});
  light->fade(target, 0.2);
  EXPECT_TRUE(eventually([&] { return !faded.values().empty() && !faded_too.values().empty(); }));
  EXPECT_EQ(faded.values(), std::vector{target});
  EXPECT_EQ(faded_too.values(), std::vector{target});
  EXPECT_EQ(another->color(), target);
}

TEST_P(ALight, RefusesAFadeThatCannotBe) {
  for (const double duration : {61.0, -0.5}) {
    EXPECT_EQ(error_of([&] {
                light->fade({0, 0, 0}, duration);
              }).code(),
              ErrorCode::out_of_range)
        << duration;
  }
  EXPECT_EQ(error_of([&] { light->fade({0, 0, -1}, 1); }).code(), ErrorCode::out_of_range);
}

INSTANTIATE_TEST_SUITE_P(Clients, ALight, ::testing::Values(&stub_light, &dynamic_light),
                         [](const auto& one) { return one.index == 0 ? "Stub" : "Dynamic"; });

}  // namespace
}  // namespace rr::serial::testing

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  if (argc != 2) {
    std::fputs("usage: light_client URL\n", stderr);
    return 2;
  }
  rr::serial::testing::url = argv[1];
  return RUN_ALL_TESTS();
}
