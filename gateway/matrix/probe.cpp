// SPDX-License-Identifier: Apache-2.0
// The broker's own latency for gateway/fleet_matrix: values as robots send them, by the broker's
// library alone.
//   fleet_probe publish NUMBER URL USER PASSWORD_FILE AUTHORITY REPLICAS
//   fleet_probe read URL USER PASSWORD_FILE AUTHORITY REPLICAS
// Prints `ready` when connected. Commands of the first: `rate VALUES` in a second; of the second:
// `phase NAME` of ages; `report FILE`.
#include <algorithm>
#include <atomic>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "gateway/matrix/ages.hpp"
#include "gateway/matrix/commands.hpp"
#include "gateway/matrix/load.hpp"
#include "gateway/matrix/probe_broker.hpp"

namespace rr::gateway::matrix {
namespace {

/// About as large as the element of a wire.
struct ProbeValue {
  std::uint64_t source = 0;
  std::uint64_t number = 0;
  double sent = 0;
  std::uint64_t filler = 0;
};

std::unique_ptr<ProbeBroker> connect(char** words) {
  ProbeOptions options;
  options.url = words[0];
  options.user = words[1];
  std::ifstream(words[2]) >> options.password;
  options.authority = words[3];
  options.replicas = std::atoi(words[4]);
  return options.url.starts_with("mqtt") ? make_mqtt_probe(options) : make_nats_probe(options);
}

void publish(std::uint64_t source, char** broker_words) {
  const std::string name = "p" + std::to_string(source);
  const auto broker = connect(broker_words);
  std::atomic<double> rate{0};
  std::atomic<bool> is_over{false};
  std::thread thread([&] {
    double due = 0;
    double before = seconds_now();
    ProbeValue value{source};
    while (!is_over) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      const double now = seconds_now();
      // What is late is not made up for.
      due = std::min(due + (now - before) * rate, 2.0);
      before = now;
      if (due < 1) continue;
      due -= 1;
      ++value.number;
      value.sent = now;
      broker->publish(name, std::string(reinterpret_cast<const char*>(&value), sizeof value));
    }
  });
  take_commands(name, {{"rate", [&](std::istringstream& words) {
                          double wanted = 0;
                          words >> wanted;
                          rate = wanted;
                          return "set";
                        }}});
  is_over = true;
  thread.join();
}

void read(char** broker_words) {
  Ages ages;
  const auto broker = connect(broker_words);
  broker->subscribe([&](const std::string& payload) {
    ProbeValue value;
    if (payload.size() != sizeof value) return;
    std::memcpy(&value, payload.data(), sizeof value);
    ages.arrived(value.source, value.number, value.sent, seconds_now());
  });
  take_commands("", {{"phase",
                      [&](std::istringstream& words) {
                        std::string phase;
                        words >> phase;
                        ages.begin(phase);
                        return "begun";
                      }},
                     {"report", [&](std::istringstream& words) {
                        std::string path;
                        words >> path;
                        std::ofstream(path) << "{\"ages\": " << ages.json() << "}\n";
                        return "written";
                      }}});
}

}  // namespace
}  // namespace rr::gateway::matrix

int main(int count, char** words) {
  const std::string role = count > 1 ? words[1] : "";
  try {
    if (role == "publish" && count == 8) {
      rr::gateway::matrix::publish(std::stoull(words[2]), words + 3);
    } else if (role == "read" && count == 7) {
      rr::gateway::matrix::read(words + 2);
    } else {
      std::cerr << "usage: see gateway/matrix/probe.cpp\n";
      return 2;
    }
  } catch (const std::exception& error) {
    std::cerr << "fleet_probe: " << error.what() << "\n";
    return 1;
  }
}
