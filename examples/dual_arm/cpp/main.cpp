// SPDX-License-Identifier: Apache-2.0
// The dual arm, all of it in one program: four real-time nodes, the host that offers them, and a
// client that uses the host over TCP as a script would from elsewhere.
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "examples/drawing/plot.hpp"
#include "examples/dual_arm/cpp/host.hpp"
#include "examples/serving/serving.hpp"
#include "rr/node.hpp"

namespace {

using namespace std::chrono_literals;
namespace wire = dual_arm::wire;

constexpr const char* usage =
    "usage: dual_arm [--picture FILE.png] [--real-time] [--serve SECONDS] [--inspector FILE]\n"
    "Moves both arms: first along a table, then by a scripted gamepad.\n"
    "  --real-time      each node in a thread on the machine's clock, not all on a simulated one\n"
    "  --serve SECONDS  moves nothing by itself, and is there for clients for so long; 0 is until "
    "it\n"
    "                   is interrupted\n"
    "  --inspector FILE serves the page of the inspector at the host's port\n";

struct Options {
  std::string picture;
  bool is_timed = false;
  std::optional<int> serve;  // seconds
  std::string inspector;
};

bool read(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string_view word = argv[i];
    if (word == "--real-time") {
      options.is_timed = true;
    } else if (i + 1 < argc && word == "--picture") {
      options.picture = argv[++i];
    } else if (i + 1 < argc && word == "--inspector") {
      options.inspector = argv[++i];
    } else if (i + 1 < argc && word == "--serve") {
      options.serve = serving::read_seconds(argv[++i]);
      if (!options.serve) return false;
    } else {
      return false;
    }
  }
  return true;
}

/// What was seen of the robot.
struct Recording {
  drawing::Series axis(const std::string& name, std::size_t index) const {
    drawing::Series series{name, times, {}};
    for (const auto& state : states) series.y.push_back(state.position[index]);
    return series;
  }
  std::vector<double> times;
  std::vector<wire::RobotState> states;
};

/// The robot moves on while the script looks at it.
class World {
 public:
  World(dual_arm::Robot& robot, bool is_timed) {
    if (is_timed) {
      timed_ = std::make_unique<dual_arm::TimedRun>(robot);
    } else {
      simulated_ = std::make_unique<dual_arm::SimulatedRun>(robot);
    }
  }
  void wait(std::chrono::milliseconds time) {
    if (simulated_) return simulated_->run_for(time);
    std::this_thread::sleep_for(time);
  }
  [[nodiscard]] const dual_arm::TimedRun* timed() const { return timed_.get(); }

 private:
  std::unique_ptr<dual_arm::TimedRun> timed_;
  std::unique_ptr<dual_arm::SimulatedRun> simulated_;
};

/// The script: what somebody at the other end of the network does.
Recording use(wire::DualArmStub& robot, World& world) {
  Recording recording;
  const auto watch = [&](int steps) {
    for (int i = 0; i < steps; ++i) {
      world.wait(10ms);
      const wire::RobotState state = robot.state().peek_in().value;
      recording.times.push_back(static_cast<double>(state.sample) * dual_arm::period);
      recording.states.push_back(state);
    }
  };
  const auto rows = dual_arm::figure(4, 401);
  robot.table().write(0, rows);
  robot.follow_table(401, 0);
  robot.change_mode(1);
  watch(420);
  robot.change_mode(2);
  // The gamepad: both sticks forward, the left one to the side, then all at rest.
  robot.gamepad().poke_out({.sticks = {1, 0, 1, 0}, .buttons = 1});
  watch(60);
  robot.gamepad().poke_out({.sticks = {0, -1, 0, 0}, .buttons = 0});
  watch(60);
  robot.gamepad().poke_out({});
  watch(30);
  robot.change_mode(0);
  return recording;
}

void draw(const Recording& recording, const std::string& file) {
  drawing::Canvas canvas(900, 660);
  drawing::draw(canvas,
                {"arms, rad",
                 "s",
                 "",
                 {recording.axis("left 1", 0), recording.axis("left 2", 1),
                  recording.axis("right 1", 6), recording.axis("right 2", 7)}},
                0, 0, 900, 330);
  drawing::draw(canvas,
                {"bases", "s", "", {recording.axis("left x", 12), recording.axis("right x", 15)}},
                0, 330, 900, 330);
  canvas.write(file);
}

}  // namespace

int main(int argc, char** argv) try {
  Options options;
  if (!read(argc, argv, options)) {
    std::fputs(usage, stderr);
    return 2;
  }
  std::optional<serving::Stay> stay;
  if (options.serve) stay.emplace(*options.serve);
  dual_arm::Robot robot;
  const auto host = std::make_shared<dual_arm::Host>(robot);
  rr::Node server(
      {.name = "experimental.dual_arm_host", .web_socket = {.inspector_page = options.inspector}});
  const auto service = server.register_service("DualArm", host);
  const auto port = server.listen_tcp(0, "127.0.0.1");
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "?service=DualArm";
  rr::realtime::BusService bus(10ms);
  host->join(bus);

  World world(robot, options.is_timed);
  if (stay) {
    serving::announce(url);
    // The machine's clock paces the simulated one.
    while (stay->wait(10ms)) {
      if (!options.is_timed) world.wait(10ms);
    }
    return 0;
  }
  rr::Node client;
  const auto stub = client.connect<wire::DualArmStub>(url);
  const Recording recording = use(*stub, world);
  double largest = 0;
  for (const auto& state : recording.states) {
    largest = std::max(largest, std::abs(state.position[0] - state.target[0]));
  }
  const auto& last = recording.states.back();
  std::printf(
      "18 axes on 3 nodes: %zu looks in %.2f s, axis 1 at most %.4f rad behind its target\n",
      recording.states.size(), recording.times.back(), largest);
  std::printf("at the end: left arm %.6f %.6f, right arm %.6f %.6f, bases %.6f %.6f\n",
              last.position[0], last.position[1], last.position[6], last.position[7],
              last.position[12], last.position[15]);
  for (std::uint32_t i = 0; i < dual_arm::node_count; ++i) {
    const auto counts = stub->link_counts(i);
    std::printf("node %u: %.0f packets, %.0f lost, %.0f late, %.0f twice\n", i, counts[0],
                counts[1], counts[2], counts[3]);
  }
  for (std::size_t i = 0; world.timed() != nullptr && i <= dual_arm::node_count; ++i) {
    const auto& counts = world.timed()->counts(i);
    std::printf(
        "loop %zu: %llu cycles, %llu too long, late by %lld us at most, 99.9 %% by %lld us\n", i,
        static_cast<unsigned long long>(counts.cycles.load()),
        static_cast<unsigned long long>(counts.overruns.load()),
        static_cast<long long>(counts.lateness.largest() / 1us),
        static_cast<long long>(counts.lateness.quantile(0.999) / 1us));
  }
  if (!options.picture.empty()) {
    draw(recording, options.picture);
    std::printf("written to %s\n", options.picture.c_str());
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "dual_arm: %s\n", error.what());
  return 1;
}
