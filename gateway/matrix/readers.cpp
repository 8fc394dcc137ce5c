// SPDX-License-Identifier: Apache-2.0
// A reader for gateway/fleet_matrix: a client of each robot at a serving gateway.
//   fleet_readers READER PORT FIRST COUNT
// Services are called `r<number of the robot>`. READER is a number that no other reader has. Prints
// `ready` when all are connected. Commands: `calls PER_SECOND` of each robot; `phase NAME` of ages;
// `progress`; `newest`; `waiting` calls; `report FILE`.
#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "gateway/matrix/ages.hpp"
#include "gateway/matrix/commands.hpp"
#include "gateway/matrix/load.hpp"
#include "rr/dynamic.hpp"
#include "rr/error.hpp"
#include "rr/mutex.hpp"
#include "rr/node.hpp"

namespace rr::gateway::matrix {
namespace {

constexpr std::chrono::seconds connect_time{60};
constexpr std::size_t most_faults = 20;     // of a robot, that are reported
constexpr std::uint32_t most_waiting = 16;  // calls of a robot

/// What one client has seen of a robot. Handlers of its members run on threads of the node.
class Seen {
 public:
  Seen(std::uint64_t robot, Ages& ages) : robot_(robot), ages_(ages) {}

  void packet(const dynamic::Value& value) {
    const auto items = value.array<std::uint64_t>();
    const MutexLock lock(mutex_);
    const std::uint64_t number = items.size() == packet_size ? items.data()[1] : 0;
    const auto wanted = packet_of(robot_, number);
    if (!std::equal(items.begin(), items.end(), wanted.begin(), wanted.end())) {
      fault("a packet after " + std::to_string(last_) + " is not as it was sent");
    } else if (number != last_ + 1) {
      fault("packet " + std::to_string(number) + " after " + std::to_string(last_));
    }
    last_ = std::max(last_, number);
    ++packets_;
  }
  void value(const dynamic::Value& value) {
    const auto items = value.array<double>();
    const double now = seconds_now();
    const MutexLock lock(mutex_);
    if (items.size() != 2) return fault("a value of " + std::to_string(items.size()) + " items");
    const auto number = static_cast<std::uint64_t>(items.data()[0]);
    if (number < newest_) {
      fault("value " + std::to_string(number) + " after " + std::to_string(newest_));
    }
    if (number > 0) ages_.arrived(robot_, number, items.data()[1], now);
    newest_ = std::max(newest_, number);
  }
  void closed() {
    const MutexLock lock(mutex_);
    if (!is_over_) fault("the pipe was closed after " + std::to_string(last_));
  }
  void begin_call() {
    const MutexLock lock(mutex_);
    ++waiting_;
  }
  void end_call(std::uint64_t id, const std::exception_ptr& error, const dynamic::Value& value) {
    const MutexLock lock(mutex_);
    --waiting_;
    try {
      if (error) std::rethrow_exception(error);
      if (value.as<std::uint64_t>() != answer_of(robot_, id)) {
        fault("call " + std::to_string(id) + " gave " + std::to_string(value.as<std::uint64_t>()));
      }
      answered_.push_back(id);
    } catch (const Error& reason) {
      ++failed_[reason.message()];
    }
  }
  void end() {
    const MutexLock lock(mutex_);
    is_over_ = true;
  }

  [[nodiscard]] std::uint64_t last() const {
    const MutexLock lock(mutex_);
    return last_;
  }
  [[nodiscard]] std::uint64_t newest() const {
    const MutexLock lock(mutex_);
    return newest_;
  }
  [[nodiscard]] std::uint32_t waiting() const {
    const MutexLock lock(mutex_);
    return waiting_;
  }
  void write(std::ostream& file) const {
    const MutexLock lock(mutex_);
    file << "{\"robot\": " << robot_ << ", \"packets\": " << packets_ << ", \"last\": " << last_
         << ", \"newest\": " << newest_ << ", \"answered\": [";
    const char* comma = "";
    for (const std::uint64_t id : answered_) file << std::exchange(comma, ", ") << id;
    file << "], \"failed\": {";
    comma = "";
    for (const auto& [reason, count] : failed_) {
      file << std::exchange(comma, ", ") << quoted(reason) << ": " << count;
    }
    file << "}, \"fault_count\": " << fault_count_ << ", \"faults\": [";
    comma = "";
    for (const std::string& text : faults_) file << std::exchange(comma, ", ") << quoted(text);
    file << "]}";
  }

 private:
  static std::string quoted(const std::string& text) { return dynamic::Value(text).to_json(); }
  void fault(std::string text) RR_REQUIRES(mutex_) {
    ++fault_count_;
    if (faults_.size() < most_faults) faults_.push_back(std::move(text));
  }

  const std::uint64_t robot_;
  Ages& ages_;
  mutable Mutex mutex_;
  std::uint64_t packets_ RR_GUARDED_BY(mutex_) = 0;
  std::uint64_t last_ RR_GUARDED_BY(mutex_) = 0;    // number of the newest packet
  std::uint64_t newest_ RR_GUARDED_BY(mutex_) = 0;  // number of the newest value
  std::uint32_t waiting_ RR_GUARDED_BY(mutex_) = 0;
  bool is_over_ RR_GUARDED_BY(mutex_) = false;
  std::vector<std::uint64_t> answered_ RR_GUARDED_BY(mutex_);
  std::map<std::string, std::uint64_t> failed_ RR_GUARDED_BY(mutex_);  // by their reasons
  std::uint64_t fault_count_ RR_GUARDED_BY(mutex_) = 0;
  std::vector<std::string> faults_ RR_GUARDED_BY(mutex_);
};

class Reader {
 public:
  Reader(Node& node, int port, std::uint64_t robot, Ages& ages)
      : seen_(std::make_shared<Seen>(robot, ages)) {
    client_ = connect(node, port, "r" + std::to_string(robot));
    end_ = client_->pipe("packets").connect();
    end_.on_packet([seen = seen_](const dynamic::Value& packet) { seen->packet(packet); }).detach();
    end_.on_closed([seen = seen_] { seen->closed(); });
    wire_ = client_->wire("level").connect();
    wire_
        .on_in([seen = seen_](const dynamic::Value& value, const TimeSpec&) { seen->value(value); })
        .detach();
  }
  ~Reader() { seen_->end(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[nodiscard]] const Seen& seen() const { return *seen_; }
  void call(std::uint64_t id) {
    if (seen_->waiting() >= most_waiting) return;
    seen_->begin_call();
    client_->async_call(
        "run", {id},
        [seen = seen_, id](const std::exception_ptr& error, const dynamic::Value& value) {
          seen->end_call(id, error, value);
        });
  }

 private:
  /// The service appears when the broker has its definition.
  static dynamic::Client connect(Node& node, int port, const std::string& name) {
    const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=" + name;
    const auto end = std::chrono::steady_clock::now() + connect_time;
    for (;;) {
      try {
        return dynamic::connect(node, url);
      } catch (const Error&) {
        if (std::chrono::steady_clock::now() > end) throw;
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
    }
  }

  std::shared_ptr<Seen> seen_;
  dynamic::Client client_;
  dynamic::PipeEndpoint end_;
  dynamic::WireConnection wire_;
};

class Desk {
 public:
  Desk(std::uint64_t number, int port, std::uint64_t first, std::uint64_t count)
      : next_id_(number << 32U) {
    for (std::uint64_t i = 0; i < count; ++i) {
      readers_.push_back(std::make_unique<Reader>(node_, port, first + i, ages));
    }
    thread_ = std::thread([this] { run(); });
  }
  ~Desk() {
    is_over_ = true;
    thread_.join();
  }
  Desk(const Desk&) = delete;
  Desk& operator=(const Desk&) = delete;

  template <class Function>
  [[nodiscard]] std::string list(Function function) const {
    std::string all;
    for (const auto& reader : readers_) {
      all += (all.empty() ? "" : " ") + std::to_string(function(reader->seen()));
    }
    return all;
  }
  void set_calls(double per_second) { rate_ = per_second; }
  void write(const std::string& path) const {
    std::ofstream file(path);
    file << "{\"ages\": " << ages.json() << ",\n\"robots\": ";
    const char* comma = "[";
    for (const auto& reader : readers_) {
      file << std::exchange(comma, ",\n");
      reader->seen().write(file);
    }
    file << "]}\n";
  }

  Ages ages;

 private:
  void run() {
    double due = 0;
    double before = seconds_now();
    while (!is_over_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      const double now = seconds_now();
      due += (now - before) * rate_;
      before = now;
      for (; due >= 1; due -= 1) {
        for (const auto& reader : readers_) reader->call(++next_id_);
      }
    }
  }

  Node node_;
  std::vector<std::unique_ptr<Reader>> readers_;
  std::uint64_t next_id_;
  std::atomic<double> rate_{0};
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

void run(std::uint64_t number, int port, std::uint64_t first, std::uint64_t count) {
  Desk desk(number, port, first, count);
  take_commands(
      std::to_string(count),
      {{"calls", with_value<double>("set", [&](double rate) { desk.set_calls(rate); })},
       {"phase",
        with_value<std::string>("begun", [&](const std::string& name) { desk.ages.begin(name); })},
       {"progress", [&](auto&) { return desk.list([](const Seen& one) { return one.last(); }); }},
       {"newest", [&](auto&) { return desk.list([](const Seen& one) { return one.newest(); }); }},
       {"waiting", [&](auto&) { return desk.list([](const Seen& one) { return one.waiting(); }); }},
       {"report",
        with_value<std::string>("written", [&](const std::string& path) { desk.write(path); })}});
}

}  // namespace
}  // namespace rr::gateway::matrix

int main(int count, char** words) {
  if (count != 5) {
    std::cerr << "usage: fleet_readers READER PORT FIRST COUNT\n";
    return 2;
  }
  try {
    rr::gateway::matrix::run(std::strtoull(words[1], nullptr, 10), std::atoi(words[2]),
                             std::strtoull(words[3], nullptr, 10),
                             std::strtoull(words[4], nullptr, 10));
  } catch (const rr::Error& error) {
    std::cerr << "fleet_readers: " << error.what() << "\n";
    return 1;
  }
}
