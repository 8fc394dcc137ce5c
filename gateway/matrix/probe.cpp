// SPDX-License-Identifier: Apache-2.0
// The broker's own latency for gateway/fleet_matrix: values as robots send them, by the broker's
// library alone.
//   fleet_probe publish NAME URL USER PASSWORD_FILE AUTHORITY REPLICAS
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

constexpr std::size_t payload_size = 32;  // about as the element of a wire

std::unique_ptr<ProbeBroker> connect(char** words) {
  ProbeOptions options;
  options.url = words[0];
  options.user = words[1];
  std::ifstream(words[2]) >> options.password;
  options.authority = words[3];
  options.replicas = std::atoi(words[4]);
  return options.url.starts_with("mqtt") ? make_mqtt_probe(options) : make_nats_probe(options);
}

void publish(const std::string& name, char** broker_words) {
  const auto broker = connect(broker_words);
  std::atomic<double> rate{0};
  std::atomic<bool> is_over{false};
  std::thread thread([&] {
    double due = 0;
    double before = seconds_now();
    while (!is_over) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      const double now = seconds_now();
      // What is late is not made up for.
      due = std::min(due + (now - before) * rate, 2.0);
      before = now;
      if (due < 1) continue;
      due -= 1;
      std::string payload(payload_size, '\0');
      std::memcpy(payload.data(), &now, sizeof now);
      broker->publish(name, payload);
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
    double sent = 0;
    if (payload.size() != payload_size) return;
    std::memcpy(&sent, payload.data(), sizeof sent);
    ages.add(seconds_now() - sent);
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
      rr::gateway::matrix::publish(words[2], words + 3);
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
