// SPDX-License-Identifier: Apache-2.0
// A service in one process, and many clients in others that have connected its wire: what a value
// for all of them costs the service, and whether each gets the newest.
//   fan_out_bench [clients] [values] [values per second] [bytes] [watched]
// `watched`: the service counts, is asked for its metrics every second, and logs to a file.
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "rr/log.hpp"
#include "runtime/cpp/bench/source.hpp"
#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using Value = bench::Samples;
using bench::Source;
using bench::SourceStub;
using rr::testing::Child;
using rr::testing::ProcessState;

constexpr int clients_of_a_process = 250;
constexpr std::chrono::seconds patience{60};

double cpu_seconds() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(used.ru_utime) + seconds(used.ru_stime);
}

void say(const std::string& line) { std::cout << line << std::endl; }

// The process with the service: `memory` says what is resident, `send N RATE BYTES` sends.
void serve(const std::string& log) {
  rr::NodeOptions options;
  if (!log.empty()) {
    options.metrics.is_enabled = true;
    options.log_record = rr::LogFile(log);
  }
  rr::Node node(options);
  const auto source = std::make_shared<Source>();
  node.register_service("source", source);
  say("port " + std::to_string(node.listen_tcp(0, "127.0.0.1")));
  const auto wire = source->level();
  std::string command;
  while (std::cin >> command && command != "end") {
    if (command == "memory") {
      say("memory " + std::to_string(ProcessState::now().resident));
    } else if (command == "send") {
      int values = 0;
      double rate = 1;
      std::size_t bytes = 0;
      std::cin >> values >> rate >> bytes;
      Value value(bytes / sizeof(double));
      const double before = cpu_seconds();
      const auto begin = Clock::now();
      for (int i = 0; i < values; ++i) {
        std::this_thread::sleep_until(begin + std::chrono::duration_cast<Clock::duration>(
                                                  std::chrono::duration<double>(i / rate)));
        value.mutate()[0] = i + 1;
        wire.set_in(value);
      }
      // What waits for slow clients counts too.
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      say("cpu " + std::to_string(static_cast<long>(1e6 * (cpu_seconds() - before))));
    }
  }
}

// The process that asks for metrics, until its input ends.
void scrape(const std::string& port) {
  std::atomic<bool> is_over{false};
  std::atomic<int> answers{0};
  std::thread asking([&] {
    while (!is_over) {
      const rr::testing::RawSocket peer(static_cast<std::uint16_t>(std::stoul(port)));
      peer.send("GET /metrics HTTP/1.1\r\nHost: localhost\r\n\r\n");
      answers += peer.receive_until("# EOF\n").ends_with("# EOF\n") ? 1 : 0;
      std::this_thread::sleep_for(std::chrono::seconds(1));
    }
  });
  std::string command;
  while (std::cin >> command && command != "end") say("answers " + std::to_string(answers));
  is_over = true;
  asking.join();
}

struct Reader {
  rr::Client<SourceStub> client;
  rr::WireConnection<Value> wire;
  rr::Subscription subscription;
  std::atomic<std::uint32_t> values{0};
  std::atomic<std::uint32_t> newest{0};
};

// A process with clients: `report` says how many values have come, and how many clients have the
// newest.
void read(const std::string& port, int count) {
  rr::Node node({.request_timeout = patience, .connect_timeout = patience});
  std::vector<std::unique_ptr<Reader>> readers;
  for (int i = 0; i < count; ++i) {
    auto one = std::make_unique<Reader>();
    one->client = node.connect<SourceStub>("rr+tcp://127.0.0.1:" + port + "/?service=source");
    one->wire = one->client->level().connect();
    one->subscription = one->wire.on_in([me = one.get()](const Value& value, const rr::TimeSpec&) {
      ++me->values;
      me->newest = static_cast<std::uint32_t>(value[0]);
    });
    readers.push_back(std::move(one));
  }
  say("ready 0");
  std::string command;
  while (std::cin >> command && command != "end") {
    std::uint32_t newest = 0;
    std::cin >> newest;
    std::uint64_t values = 0;
    std::uint64_t current = 0;
    for (const auto& one : readers) {
      values += one->values;
      current += one->newest == newest ? 1 : 0;
    }
    say("values " + std::to_string(values));
    say("current " + std::to_string(current));
  }
}

// The number that a process answers with, behind a word.
double ask(Child& child, const std::string& command, const std::string& word) {
  child.tell(command);
  return std::stod(child.wait_for(word));
}

void measure(int clients, int values, double rate, int bytes, bool is_watched) {
  const auto log = std::filesystem::temp_directory_path() / "fan_out_bench.log";
  Child service(is_watched ? std::vector<std::string>{"serve", log.string()}
                           : std::vector<std::string>{"serve"});
  const auto port = service.wait_for("port");
  std::vector<Child> watching;
  if (is_watched) watching.push_back(Child({"scrape", port}));
  const double empty = ask(service, "memory", "memory");
  std::vector<Child> processes;
  for (int first = 0; first < clients; first += clients_of_a_process) {
    const int count = std::min(clients_of_a_process, clients - first);
    processes.push_back(Child({"read", port, std::to_string(count)}));
  }
  for (Child& one : processes) one.wait_for("ready");
  const double idle = ask(service, "memory", "memory");
  const auto send = [&](int count) {
    const double cpu = ask(
        service,
        "send " + std::to_string(count) + ' ' + std::to_string(rate) + ' ' + std::to_string(bytes),
        "cpu");
    double received = 0;
    double current = 0;
    for (Child& one : processes) {
      received += ask(one, "report " + std::to_string(count), "values");
      current += std::stod(one.wait_for("current"));
    }
    return std::array<double, 3>{cpu, received, current};
  };
  const auto warm = send(static_cast<int>(rate));
  const auto [cpu, all, current] = send(values);
  for (Child& one : watching) {
    std::printf("%.0f answers to GET /metrics; ", ask(one, "report", "answers"));
  }
  if (is_watched) std::filesystem::remove(log);
  const double received = all - warm[1];
  const double wanted = double(clients) * values;
  std::printf(
      "%d clients, %d values of %d B at %.0f Hz: %.3f %% of the values delivered, %.1f %% of the "
      "clients have the newest, %.2f us of CPU for a delivery, %.1f KB for an idle client\n",
      clients, values, bytes, rate, 100 * received / wanted, 100 * current / clients, cpu / wanted,
      (idle - empty) / clients / 1024);
}

}  // namespace

int main(int count, char** words) {
  const std::string role = count > 1 ? words[1] : "";
  if (role == "serve") {
    serve(count > 2 ? words[2] : "");
  } else if (role == "scrape") {
    scrape(words[2]);
  } else if (role == "read") {
    read(words[2], std::atoi(words[3]));
  } else {
    const auto number = [&](int place, double otherwise) {
      return count > place ? std::atof(words[place]) : otherwise;
    };
    measure(static_cast<int>(number(1, 1000)), static_cast<int>(number(2, 500)), number(3, 50),
            static_cast<int>(number(4, 200)), count > 5 && words[5] == std::string("watched"));
  }
}
