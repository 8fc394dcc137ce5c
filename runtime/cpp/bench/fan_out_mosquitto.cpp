// SPDX-License-Identifier: Apache-2.0
// The peer of fan_out_bench: one MQTT publisher, many subscribers in other processes, and mosquitto
// between them. Same values, same line at the end; the CPU time is that of the broker.
//   fan_out_mosquitto [clients] [values] [values per second] [bytes]
//   fan_out_mosquitto read PORT CLIENTS TOPIC       the subscribers of a process, for a topic
//   fan_out_mosquitto publish PORT TOPIC VALUES PER_SECOND BYTES     the publisher alone
#include <arpa/inet.h>
#include <mosquitto.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "runtime/cpp/src/node/testing/child.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using rr::testing::Child;

constexpr int clients_of_a_process = 250;
constexpr const char* bench_topic = "bench/level";

void say(const std::string& line) { std::cout << line << std::endl; }

void check(int result, const char* what) {
  if (result == MOSQ_ERR_SUCCESS) return;
  throw std::runtime_error(std::string(what) + ": " + mosquitto_strerror(result));
}

struct Ended {
  void operator()(mosquitto* client) const { mosquitto_destroy(client); }
};
using Client = std::unique_ptr<mosquitto, Ended>;

Client connected(int port, void* user) {
  Client client(mosquitto_new(nullptr, true, user));
  if (!client) throw std::runtime_error("no client");
  for (int i = 0; mosquitto_connect(client.get(), "127.0.0.1", port, 600) != 0; ++i) {
    if (i == 100) throw std::runtime_error("the broker does not answer");
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  check(mosquitto_int_option(client.get(), MOSQ_OPT_TCP_NODELAY, 1), "TCP_NODELAY");
  return client;
}

struct Reader {
  Client client;
  std::atomic<std::uint32_t> values{0};
  std::atomic<std::uint32_t> newest{0};
  std::atomic<bool> is_subscribed{false};
};

void on_message(mosquitto*, void* user, const mosquitto_message* message) {
  auto& reader = *static_cast<Reader*>(user);
  double number = 0;
  if (message->payloadlen >= static_cast<int>(sizeof number)) {
    std::memcpy(&number, message->payload, sizeof number);
  }
  ++reader.values;
  reader.newest = static_cast<std::uint32_t>(number);
}

void on_subscribe(mosquitto*, void* user, int, int, const int*) {
  static_cast<Reader*>(user)->is_subscribed = true;
}

// One thread reads for all clients of the process.
void pump(int poll, const std::atomic<bool>& is_over) {
  std::array<epoll_event, 64> events{};
  while (!is_over) {
    const int count = ::epoll_wait(poll, events.data(), static_cast<int>(events.size()), 100);
    for (int i = 0; i < count; ++i) {
      auto& reader = *static_cast<Reader*>(events[static_cast<std::size_t>(i)].data.ptr);
      mosquitto_loop_read(reader.client.get(), 1);
      if (mosquitto_want_write(reader.client.get())) mosquitto_loop_write(reader.client.get(), 1);
    }
  }
}

// A process with subscribers: `report` says how many values have come, and how many have the
// newest.
void read(int port, int count, const char* topic) {
  std::vector<std::unique_ptr<Reader>> readers;
  const int poll = ::epoll_create1(0);
  for (int i = 0; i < count; ++i) {
    auto one = std::make_unique<Reader>();
    one->client = connected(port, one.get());
    mosquitto_message_callback_set(one->client.get(), on_message);
    mosquitto_subscribe_callback_set(one->client.get(), on_subscribe);
    check(mosquitto_subscribe(one->client.get(), nullptr, topic, 0), "subscribe");
    while (mosquitto_want_write(one->client.get())) mosquitto_loop_write(one->client.get(), 1);
    epoll_event event{.events = EPOLLIN, .data = {.ptr = one.get()}};
    ::epoll_ctl(poll, EPOLL_CTL_ADD, mosquitto_socket(one->client.get()), &event);
    readers.push_back(std::move(one));
  }
  std::atomic<bool> is_over{false};
  std::thread thread([&] { pump(poll, is_over); });
  while (!std::all_of(readers.begin(), readers.end(),
                      [](const auto& one) { return one->is_subscribed.load(); })) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
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
  is_over = true;
  thread.join();
  ::close(poll);
}

int free_port() {
  const int probe = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  static_cast<void>(::bind(probe, reinterpret_cast<sockaddr*>(&address), size));
  ::getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
  ::close(probe);
  return ntohs(address.sin_port);
}

// Microseconds that the first thread of a process has run; the broker has no other.
double cpu_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/schedstat");
  double nanoseconds = 0;
  file >> nanoseconds;
  return nanoseconds / 1000;
}

double resident(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  double all = 0;
  double pages = 0;
  file >> all >> pages;
  return pages * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

// Values with numbers from 1, at times that do not depend on how long each takes.
void publish(mosquitto* publisher, const char* topic, int count, double rate, int bytes) {
  std::vector<double> value(static_cast<std::size_t>(bytes) / sizeof(double));
  const auto begin = Clock::now();
  for (int i = 0; i < count; ++i) {
    std::this_thread::sleep_until(begin + std::chrono::duration_cast<Clock::duration>(
                                              std::chrono::duration<double>(i / rate)));
    value[0] = i + 1;
    check(
        mosquitto_publish(publisher, nullptr, topic,
                          static_cast<int>(value.size() * sizeof(double)), value.data(), 0, false),
        "publish");
  }
}

void publish_alone(int port, const char* topic, int count, double rate, int bytes) {
  const Client publisher = connected(port, nullptr);
  check(mosquitto_loop_start(publisher.get()), "thread");
  publish(publisher.get(), topic, count, rate, bytes);
  mosquitto_disconnect(publisher.get());
  mosquitto_loop_stop(publisher.get(), false);
}

class Broker {
 public:
  explicit Broker(int port) : settings_(std::filesystem::temp_directory_path() / name(port)) {
    std::ofstream(settings_) << "listener " << port << " 127.0.0.1\nallow_anonymous true\n"
                             << "persistence false\nlog_dest none\nset_tcp_nodelay true\n";
    process_ = std::make_unique<Child>(std::vector<std::string>{"-c", settings_.string()},
                                       "/usr/sbin/mosquitto");
  }
  ~Broker() {
    process_.reset();
    std::filesystem::remove(settings_);
  }
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;
  [[nodiscard]] pid_t id() const { return process_->id(); }

 private:
  static std::string name(int port) { return "fan_out_" + std::to_string(port) + ".conf"; }

  std::filesystem::path settings_;
  std::unique_ptr<Child> process_;
};

void measure(int clients, int values, double rate, int bytes) {
  const int port = free_port();
  const Broker broker(port);
  Client publisher = connected(port, nullptr);
  check(mosquitto_loop_start(publisher.get()), "thread");
  const double empty = resident(broker.id());
  std::vector<Child> processes;
  for (int first = 0; first < clients; first += clients_of_a_process) {
    const int count = std::min(clients_of_a_process, clients - first);
    processes.push_back(Child({"read", std::to_string(port), std::to_string(count)}));
  }
  for (Child& one : processes) one.wait_for("ready");
  const double idle = resident(broker.id());
  const auto send = [&](int count) {
    const double before = cpu_of(broker.id());
    publish(publisher.get(), bench_topic, count, rate, bytes);
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    const double cpu = cpu_of(broker.id()) - before;
    double received = 0;
    double current = 0;
    for (Child& one : processes) {
      one.tell("report " + std::to_string(count));
      received += std::stod(one.wait_for("values"));
      current += std::stod(one.wait_for("current"));
    }
    return std::array<double, 3>{cpu, received, current};
  };
  const auto warm = send(static_cast<int>(rate));
  const auto [cpu, all, current] = send(values);
  const double wanted = double(clients) * values;
  std::printf(
      "%d clients, %d values of %d B at %.0f Hz: %.3f %% of the values delivered, %.1f %% of the "
      "clients have the newest, %.2f us of CPU for a delivery, %.1f KB for an idle client\n",
      clients, values, bytes, rate, 100 * (all - warm[1]) / wanted, 100 * current / clients,
      cpu / wanted, (idle - empty) / clients / 1024);
  mosquitto_disconnect(publisher.get());
  mosquitto_loop_stop(publisher.get(), false);
}

}  // namespace

int main(int count, char** words) {
  mosquitto_lib_init();
  const std::string role = count > 1 ? words[1] : "";
  if (role == "read") {
    read(std::atoi(words[2]), std::atoi(words[3]), count > 4 ? words[4] : bench_topic);
  } else if (role == "publish" && count == 7) {
    publish_alone(std::atoi(words[2]), words[3], std::atoi(words[4]), std::atof(words[5]),
                  std::atoi(words[6]));
  } else {
    const auto number = [&](int place, double otherwise) {
      return count > place ? std::atof(words[place]) : otherwise;
    };
    measure(static_cast<int>(number(1, 1000)), static_cast<int>(number(2, 500)), number(3, 50),
            static_cast<int>(number(4, 200)));
  }
  mosquitto_lib_cleanup();
}
