// SPDX-License-Identifier: Apache-2.0
// The robots of a site for gateway/fleet_matrix: each a node with one service.
//   fleet_robots FIRST COUNT
// Robots have the numbers FIRST, FIRST + 1, ... Prints `ready` with their ports. Commands:
// `connected`; `start`; `rate PACKETS VALUES LIMIT`, of each robot in a second, and packets of all
// time at most; `values 1` or `0`; `progress`; `newest`; `report FILE`.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "gateway/matrix/commands.hpp"
#include "gateway/matrix/load.hpp"
#include "rr/dynamic_service.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/node.hpp"

namespace rr::gateway::matrix {
namespace {

constexpr std::chrono::milliseconds step{10};

class Robot {
 public:
  explicit Robot(std::uint64_t number)
      : number_(number), definitions_({definition}), load_(definitions_, "test.load.Load") {
    load_.on_call("run", [this](const dynamic::List& arguments) {
      const auto id = arguments[0].as<std::uint64_t>();
      const MutexLock lock(mutex_);
      ++calls_[id];
      return answer_of(number_, id);
    });
    // Its address has to be there when the gateway asks for it.
    load_.wire("level").set_in(std::vector<double>{0, seconds_now()});
    port_ = node_.listen_tcp(0);
    service_.emplace(dynamic::register_service(node_, "load", load_));
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] bool is_connected() const { return load_.pipe("packets").endpoint_count() > 0; }
  [[nodiscard]] std::uint64_t sent() const { return sent_; }
  [[nodiscard]] std::uint64_t newest() const { return newest_; }
  void send_packet() { load_.pipe("packets").send(packet_of(number_, ++sent_)); }
  void send_value() {
    const std::uint64_t value = newest_ + 1;
    load_.wire("level").set_in(std::vector<double>{static_cast<double>(value), seconds_now()});
    newest_ = value;
  }
  void write(std::ostream& file) const {
    const MutexLock lock(mutex_);
    file << "{\"robot\": " << number_ << ", \"sent\": " << sent_ << ", \"newest\": " << newest_
         << ", \"calls\": {";
    const char* comma = "";
    for (const auto& [id, count] : calls_) {
      file << std::exchange(comma, ", ") << "\"" << id << "\": " << count;
    }
    file << "}}";
  }

 private:
  const std::uint64_t number_;
  dynamic::Definitions definitions_;
  dynamic::ServedObject load_;
  std::atomic<std::uint64_t> sent_{0};
  std::atomic<std::uint64_t> newest_{0};
  mutable Mutex mutex_;
  std::map<std::uint64_t, std::uint32_t> calls_ RR_GUARDED_BY(mutex_);
  Node node_;
  std::uint16_t port_ = 0;
  std::optional<Service> service_;
};

/// All robots of a process, and the thread that sends for them.
class Site {
 public:
  Site(std::uint64_t first, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count; ++i) {
      robots_.push_back(std::make_unique<Robot>(first + i));
    }
  }
  ~Site() {
    is_over_ = true;
    if (thread_.joinable()) thread_.join();
  }
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  /// A text for each robot, with blanks between them.
  template <class Function>
  [[nodiscard]] std::string list(Function function) const {
    std::string all;
    for (const auto& robot : robots_) {
      all += (all.empty() ? "" : " ") + std::to_string(function(*robot));
    }
    return all;
  }
  [[nodiscard]] bool is_connected() const {
    return std::ranges::all_of(robots_, [](const auto& robot) { return robot->is_connected(); });
  }
  void start() {
    thread_ = std::thread([this] { run(); });
  }
  void set_rate(double packets, double values, std::uint64_t limit) {
    packet_rate_ = packets;
    value_rate_ = values;
    limit_ = limit;
  }
  void set_values(bool are_sent) {
    // What is being sent is sent when this returns.
    const MutexLock lock(sending_);
    sends_values_ = are_sent;
  }
  void write(const std::string& path) const {
    std::ofstream file(path);
    const char* comma = "[";
    for (const auto& robot : robots_) {
      file << std::exchange(comma, ",\n");
      robot->write(file);
    }
    file << "]\n";
  }

 private:
  void run() {
    double packets_due = 0;
    double values_due = 0;
    double before = seconds_now();
    while (!is_over_) {
      std::this_thread::sleep_for(step);
      const double now = seconds_now();
      packets_due += (now - before) * packet_rate_;
      values_due += (now - before) * value_rate_;
      before = now;
      for (; packets_due >= 1; packets_due -= 1) send_packets();
      if (values_due >= 1) send_values();
      // A value that is late is not made up for.
      if (values_due >= 1) values_due -= static_cast<double>(static_cast<int>(values_due));
    }
  }
  void send_packets() {
    for (const auto& robot : robots_) {
      if (robot->sent() < limit_) robot->send_packet();
    }
  }
  void send_values() {
    const MutexLock lock(sending_);
    if (!sends_values_) return;
    for (const auto& robot : robots_) robot->send_value();
  }

  std::vector<std::unique_ptr<Robot>> robots_;
  std::atomic<double> packet_rate_{0};
  std::atomic<double> value_rate_{0};
  std::atomic<std::uint64_t> limit_{0};
  std::atomic<bool> is_over_{false};
  Mutex sending_;
  bool sends_values_ RR_GUARDED_BY(sending_) = true;
  std::thread thread_;
};

void run(std::uint64_t first, std::uint64_t count) {
  Site site(first, count);
  take_commands(
      site.list([](const Robot& robot) { return robot.port(); }),
      {{"connected", [&](auto&) { return site.is_connected() ? "yes" : "no"; }},
       {"start",
        [&](auto&) {
          site.start();
          return "started";
        }},
       {"rate",
        [&](std::istringstream& words) {
          double packets = 0;
          double values = 0;
          std::uint64_t limit = 0;
          words >> packets >> values >> limit;
          site.set_rate(packets, values, limit);
          return "set";
        }},
       {"values", with_value<bool>("set", [&](bool are_sent) { site.set_values(are_sent); })},
       {"progress", [&](auto&) { return site.list([](const Robot& one) { return one.sent(); }); }},
       {"newest", [&](auto&) { return site.list([](const Robot& one) { return one.newest(); }); }},
       {"report",
        with_value<std::string>("written", [&](const std::string& path) { site.write(path); })}});
}

}  // namespace
}  // namespace rr::gateway::matrix

int main(int count, char** words) {
  if (count != 3) {
    std::cerr << "usage: fleet_robots FIRST COUNT\n";
    return 2;
  }
  try {
    rr::gateway::matrix::run(std::strtoull(words[1], nullptr, 10),
                             std::strtoull(words[2], nullptr, 10));
  } catch (const rr::Error& error) {
    std::cerr << "fleet_robots: " << error.what() << "\n";
    return 1;
  }
}
