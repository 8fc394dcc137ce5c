// SPDX-License-Identifier: Apache-2.0
// A get, values of a wire and packets of a pipe, over TCP, a local socket and shared memory, in
// turns in one run, between two processes on the same processor and on different ones.
//   local_bench [rounds] [calls of a round] [spin in microseconds]
#include <sched.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "rr/node.hpp"
#include "rr/pipes.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "rr/wires.hpp"
#include "runtime/cpp/src/node/testing/child.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using rr::testing::Child;

// Of a packet of the pipe, in bytes.
constexpr std::size_t packet_size = 200;

extern const rr::Definition definition;
extern const rr::ObjectType value_type;

constexpr rr::Parameter blob_parameters[] = {rr::parameter<std::uint32_t>("size")};
constexpr rr::Parameter publish_parameters[] = {rr::parameter<std::uint32_t>("size"),
                                                rr::parameter<std::uint32_t>("count"),
                                                rr::parameter<std::uint32_t>("pause")};
constexpr rr::Parameter send_parameters[] = {rr::parameter<std::uint32_t>("count"),
                                             rr::parameter<std::uint32_t>("pause")};
enum Place : std::size_t {
  value_place,
  blob_place,
  publish_place,
  state_place,
  send_place,
  packets_place
};
constexpr rr::Member members[] = {rr::property<double>("value", rr::readonly),
                                  rr::function<rr::Array<std::uint8_t>>("blob", blob_parameters),
                                  rr::function<double>("publish", publish_parameters),
                                  rr::wire<rr::Array<std::uint8_t>>("state", rr::readonly),
                                  rr::function<double>("send", send_parameters),
                                  rr::pipe<rr::Array<std::uint8_t>>("packets", rr::readonly)};

class ValueStub : public virtual rr::Stub {
 public:
  [[nodiscard]] const rr::ObjectType& rr_object_type() const override { return value_type; }
  double get_value() { return rr_get<double>(members[value_place], {}); }
  rr::Array<std::uint8_t> blob(std::uint32_t size) {
    return rr_call<rr::Array<std::uint8_t>>(members[blob_place], {}, size);
  }
  // Publishes so many values with pauses in microseconds; the median of the time of one, in
  // nanoseconds.
  double publish(std::uint32_t size, std::uint32_t count, std::uint32_t pause) {
    return rr_call<double>(members[publish_place], {}, size, count, pause);
  }
  rr::Wire<rr::Array<std::uint8_t>> state() { return {*this, members[state_place]}; }
  // Sends so many packets with pauses in microseconds; the mean time of one, in nanoseconds.
  double send(std::uint32_t count, std::uint32_t pause) {
    return rr_call<double>(members[send_place], {}, count, pause);
  }
  rr::Pipe<rr::Array<std::uint8_t>> packets() { return {*this, members[packets_place]}; }
};

constexpr const rr::ObjectType* objects[] = {&value_type};
constinit const rr::ObjectType value_type{
    "bench.local.Value", definition, {}, members, []() -> std::shared_ptr<rr::Stub> {
      return std::make_shared<ValueStub>();
    }};
constinit const rr::Definition definition{
    "bench.local",
    "service bench.local\n"
    "stdver 0.10\n"
    "object Value\n"
    "  property double value [readonly]\n"
    "  function uint8[] blob(uint32 size)\n"
    "  function double publish(uint32 size, uint32 count, uint32 pause)\n"
    "  wire uint8[] state [readonly]\n"
    "  function double send(uint32 count, uint32 pause)\n"
    "  pipe uint8[] packets [readonly]\n"
    "end\n",
    {0, 10, 0, 0},
    {},
    {},
    {},
    objects};

double nanoseconds(Clock::duration time) {
  return std::chrono::duration<double, std::nano>(time).count();
}

// One of so many, in order; they are left in another order.
double at_share(std::vector<double>& times, double share) {
  const auto place =
      times.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(times.size() - 1));
  std::nth_element(times.begin(), place, times.end());
  return *place;
}

class Value final : public rr::Skeleton {
 public:
  [[nodiscard]] const rr::ObjectType& rr_object_type() const override { return value_type; }
  void rr_dispatch(std::size_t member, rr::Request& request) override {
    if (member == value_place) {
      const double value = 42.5;
      request.answer(&value);
    } else if (member == publish_place) {
      std::uint32_t size = 0;
      std::uint32_t count = 0;
      std::uint32_t pause = 0;
      request.read(size, count, pause);
      const double median = publish(size, count, std::chrono::microseconds(pause));
      request.answer(&median);
    } else if (member == send_place) {
      std::uint32_t count = 0;
      std::uint32_t pause = 0;
      request.read(count, pause);
      const double mean = send(count, std::chrono::microseconds(pause));
      request.answer(&mean);
    } else {
      std::uint32_t size = 0;
      request.read(size);
      if (blob_.size() != size) blob_ = rr::Array<std::uint8_t>(std::size_t{size});
      request.answer(&blob_);
    }
  }
  std::shared_ptr<rr::Skeleton> rr_child(std::size_t, const rr::ObjectIndex&) override {
    return nullptr;
  }

 private:
  // Each value begins with the time of its publishing.
  double publish(std::uint32_t size, std::uint32_t count, std::chrono::microseconds pause) const {
    const rr::WireServer<rr::Array<std::uint8_t>> state(*this, members[state_place]);
    std::vector<double> times;
    for (std::uint32_t i = 0; i < count; ++i) {
      rr::Array<std::uint8_t> value(std::size_t{size});
      const std::span<std::uint8_t> bytes = value.mutate();
      const Clock::time_point begin = Clock::now();
      std::memcpy(bytes.data(), &begin, sizeof begin);
      state.set_in(value);
      times.push_back(nanoseconds(Clock::now() - begin));
      std::this_thread::sleep_for(pause);
    }
    return at_share(times, 0.5);
  }
  // Each packet begins with the time of its sending.
  double send(std::uint32_t count, std::chrono::microseconds pause) const {
    const rr::PipeServer<rr::Array<std::uint8_t>> packets(*this, members[packets_place]);
    Clock::duration time{0};
    for (std::uint32_t i = 0; i < count; ++i) {
      rr::Array<std::uint8_t> packet(packet_size);
      if (!packets.wait_sent(std::chrono::seconds(10))) break;
      const Clock::time_point begin = Clock::now();
      std::memcpy(packet.mutate().data(), &begin, sizeof begin);
      packets.send(packet);
      time += Clock::now() - begin;
      if (pause.count() != 0) std::this_thread::sleep_for(pause);
    }
    return nanoseconds(time) / count;
  }

  rr::Array<std::uint8_t> blob_;
};

void pin_to(int processor) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(processor, &set);
  if (::sched_setaffinity(0, sizeof set, &set) != 0) {
    std::fprintf(stderr, "there is no processor %d\n", processor);
    std::exit(2);
  }
}

rr::NodeOptions options(const std::string& folder, bool shares, int spin) {
  rr::NodeOptions options;
  options.local.user_run_dir = folder;
  options.local.shared_memory = shares;
  options.spin = std::chrono::microseconds(spin);
  return options;
}

// The process with the service, until it reads the end.
int serve(const std::string& folder, int processor, int spin) {
  pin_to(processor);
  rr::Node node(options(folder, true, spin));
  node.register_service("value", std::make_shared<Value>());
  const int port = node.listen_tcp(0, "127.0.0.1");
  node.listen("rr+local://");
  std::cout << "ready " << port << ' ' << node.id().text() << std::endl;
  while (std::cin.get() != std::istream::traits_type::eof()) {
  }
  return 0;
}

/// Times of one way of connecting, in nanoseconds.
struct Way {
  std::string name;
  std::unique_ptr<rr::Node> node;
  std::unique_ptr<rr::Client<ValueStub>> client;
  std::vector<double> times{};

  void measure(int calls, std::uint32_t size) {
    for (int i = 0; i < calls; ++i) {
      const auto begin = Clock::now();
      if (size == 0) {
        (*client)->get_value();
      } else {
        (*client)->blob(size);
      }
      times.push_back(nanoseconds(Clock::now() - begin));
    }
  }
  [[nodiscard]] double at(double share) { return at_share(times, share); }
};

Way way_of(std::string name, const std::string& folder, const std::string& url, bool shares,
           int spin) {
  Way way{std::move(name), std::make_unique<rr::Node>(options(folder, shares, spin)), nullptr};
  way.client = std::make_unique<rr::Client<ValueStub>>(way.node->connect<ValueStub>(url));
  return way;
}

using Bytes = rr::Array<std::uint8_t>;

// How old a value is.
double age_of(const Bytes& value) {
  const Clock::time_point now = Clock::now();
  Clock::time_point published;
  std::memcpy(&published, value.data(), sizeof published);
  return nanoseconds(now - published);
}

// Ages of values that a function gets, or that are looked for all the time.
void measure_ages(Way& way, bool is_woken, std::uint32_t size, int count, std::uint32_t pause) {
  auto state = (*way.client)->state().connect();
  std::mutex mutex;
  rr::Subscription subscription;
  if (is_woken) {
    subscription = state.on_in([&](const Bytes& value, const rr::TimeSpec& /*time*/) {
      const double age = age_of(value);
      const std::lock_guard lock(mutex);
      way.times.push_back(age);
    });
  }
  std::atomic<bool> is_over{false};
  std::thread publisher([&] {
    (*way.client)->publish(size, static_cast<std::uint32_t>(count), pause);
    is_over = true;
  });
  rr::TimeSpec seen;
  while (!is_woken && !is_over) {
    const auto value = state.try_in();
    if (!value || value->time == seen) continue;
    way.times.push_back(age_of(value->value));
    seen = value->time;
  }
  publisher.join();
  state.close();
}

void compare_wires(std::vector<Way>& ways, bool is_split, int rounds, int count) {
  for (const bool is_woken : {true, false}) {
    if (!is_woken && !is_split) continue;  // who looks all the time would keep the other from it
    for (int round = 0; round < rounds; ++round) {
      for (Way& way : ways) measure_ages(way, is_woken, 200, count, 300);
    }
    const double tcp = ways.front().at(0.5);
    for (Way& way : ways) {
      std::printf("%-5s %-7s %6s 200 B  p50 %8.2f us  p99 %8.2f us  %5.2f of tcp\n",
                  is_split ? "split" : "same", way.name.c_str(), is_woken ? "woken" : "polled",
                  way.at(0.5) / 1000, way.at(0.99) / 1000, way.at(0.5) / tcp);
      way.times.clear();
    }
    std::fflush(stdout);
  }
}

// What publishing costs, and when the last of the readers has the value.
void compare_pictures(const std::string& folder, const std::vector<std::string>& urls,
                      bool is_split, int rounds) {
  constexpr std::uint32_t size = 10'000'000;
  constexpr std::uint32_t pictures = 5;
  for (const int count : {1, 8}) {
    for (std::size_t place = 0; place < urls.size(); ++place) {
      const bool shares = place == 2;
      std::vector<Way> readers;
      for (int i = 0; i < count; ++i) {
        readers.push_back(way_of("reader", folder, urls[place], shares, 0));
      }
      std::mutex mutex;
      std::vector<double> ages;
      std::vector<rr::WireConnection<Bytes>> wires;
      std::vector<rr::Subscription> subscriptions;
      for (Way& reader : readers) {
        wires.push_back((*reader.client)->state().connect());
        subscriptions.push_back(
            wires.back().on_in([&](const Bytes& value, const rr::TimeSpec& /*time*/) {
              const double age = age_of(value);
              const std::lock_guard lock(mutex);
              if (value.size() == size) ages.push_back(age);
            }));
      }
      (*readers.front().client)->publish(size, 2, 200'000);
      {
        const std::lock_guard lock(mutex);
        ages.clear();
      }
      std::vector<double> times;
      for (int round = 0; round < rounds; ++round) {
        times.push_back((*readers.front().client)->publish(size, pictures, 200'000));
      }
      for (auto& wire : wires) wire.close();
      const std::lock_guard lock(mutex);
      constexpr std::array<const char*, 3> names{"tcp", "local", "shm"};
      std::printf("%-5s %-7s 10 MB to %d: set_in %8.0f us  age p50 %8.0f us  of all %8.0f us\n",
                  is_split ? "split" : "same", names.at(place), count, at_share(times, 0.5) / 1000,
                  ages.empty() ? 0 : at_share(ages, 0.5) / 1000,
                  ages.empty() ? 0 : at_share(ages, 1) / 1000);
      std::fflush(stdout);
    }
  }
}

// Ages of packets that functions get, what sending one costs, and how soon all readers have many.
void compare_pipes(const std::string& folder, const std::vector<std::string>& urls, bool is_split,
                   int rounds) {
  constexpr std::uint32_t slow = 1000;
  constexpr std::uint32_t quick = 50'000;
  for (const int count : {1, 8}) {
    double tcp = 0;
    for (std::size_t place = 0; place < urls.size(); ++place) {
      std::vector<Way> readers;
      for (int i = 0; i < count; ++i) {
        readers.push_back(way_of("reader", folder, urls[place], place == 2, 0));
      }
      std::mutex mutex;
      std::vector<double> ages;
      std::atomic<std::uint64_t> received{0};
      std::vector<rr::PipeEndpoint<Bytes>> ends;
      std::vector<rr::Subscription> subscriptions;
      for (Way& reader : readers) {
        ends.push_back((*reader.client)->packets().connect());
        subscriptions.push_back(ends.back().on_packet([&](const Bytes& packet) {
          if (received.fetch_add(1) % 64 != 0) return;
          const double age = age_of(packet);
          const std::lock_guard lock(mutex);
          ages.push_back(age);
        }));
      }
      const auto all = [&](std::uint32_t packets) {
        return std::uint64_t{packets} * static_cast<std::uint64_t>(count);
      };
      const auto wait_for = [&](std::uint64_t packets) {
        while (received != packets) std::this_thread::sleep_for(std::chrono::microseconds(200));
        received = 0;
      };
      ValueStub& client = **readers.front().client;
      std::vector<double> sent;
      std::vector<double> taken;
      std::vector<double> slow_ages;
      for (int round = 0; round < rounds; ++round) {
        client.send(slow, 300);
        wait_for(all(slow));
        {
          const std::lock_guard lock(mutex);
          slow_ages.insert(slow_ages.end(), ages.begin(), ages.end());
          ages.clear();
        }
        const Clock::time_point begin = Clock::now();
        sent.push_back(client.send(quick, 0));
        wait_for(all(quick));
        taken.push_back(nanoseconds(Clock::now() - begin) / quick);
        const std::lock_guard lock(mutex);
        ages.clear();
      }
      const double age = at_share(slow_ages, 0.5);
      if (place == 0) tcp = age;
      constexpr std::array<const char*, 3> names{"tcp", "local", "shm"};
      std::printf(
          "%-5s %-7s packets to %d: age p50 %8.2f us  %5.2f of tcp  send %6.0f ns  all have one "
          "in %6.0f ns\n",
          is_split ? "split" : "same", names.at(place), count, age / 1000, age / tcp,
          at_share(sent, 0.5), at_share(taken, 0.5));
      std::fflush(stdout);
    }
  }
}

void compare(const std::string& folder, bool is_split, int rounds, int calls, int spin) {
  Child server({"serve", folder, is_split ? "1" : "0", std::to_string(spin)});
  const std::string ready = server.wait_for("ready");
  const std::string port = ready.substr(0, ready.find(' '));
  const std::string local =
      "rr+local:///?nodeid=" + ready.substr(ready.find(' ') + 1) + "&service=value";
  pin_to(0);
  std::vector<Way> ways;
  const std::string tcp_url = "rr+tcp://127.0.0.1:" + port + "/?service=value";
  ways.push_back(way_of("tcp", folder, tcp_url, false, spin));
  ways.push_back(way_of("local", folder, local, false, spin));
  ways.push_back(way_of("shm", folder, local, true, spin));
  for (const std::uint32_t size : {0U, 10'000U, 1'000'000U}) {
    const int count = size > 100'000 ? calls / 20 : calls;
    for (Way& way : ways) {
      way.measure(count / 4 + 100, size);
      way.times.clear();
    }
    for (int round = 0; round < rounds; ++round) {
      for (Way& way : ways) way.measure(count, size);
    }
    const double tcp = ways.front().at(0.5);
    for (Way& way : ways) {
      std::printf("%-5s %-7s %8u B  p50 %8.2f us  p99 %8.2f us  %5.2f of tcp\n",
                  is_split ? "split" : "same", way.name.c_str(), size, way.at(0.5) / 1000,
                  way.at(0.99) / 1000, way.at(0.5) / tcp);
      way.times.clear();
    }
    std::fflush(stdout);
  }
  compare_wires(ways, is_split, rounds, std::min(calls, 1000));
  compare_pipes(folder, {tcp_url, local, local}, is_split, rounds);
  compare_pictures(folder, {tcp_url, local, local}, is_split, rounds);
}

}  // namespace

int main(int count, char** words) {
  const std::vector<std::string> arguments(words + 1, words + count);
  const auto number = [&](std::size_t place, int otherwise) {
    return place < arguments.size() ? std::atoi(arguments[place].c_str()) : otherwise;
  };
  if (!arguments.empty() && arguments[0] == "serve") {
    return serve(arguments.at(1), number(2, 0), number(3, 0));
  }
  const int rounds = std::max(number(0, 5), 1);
  const int calls = std::max(number(1, 4000), 20);
  const int spin = std::max(number(2, 0), 0);
  std::string folder = std::filesystem::temp_directory_path() / "rr-local-bench-XXXXXX";
  if (::mkdtemp(folder.data()) == nullptr) return 2;
  compare(folder, false, rounds, calls, spin);
  if (std::thread::hardware_concurrency() > 1) compare(folder, true, rounds, calls, spin);
  std::error_code error;
  std::filesystem::remove_all(folder, error);
}
