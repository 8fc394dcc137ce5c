// SPDX-License-Identifier: Apache-2.0
// A get over TCP, a local socket and shared memory, in turns in one run, between two processes on
// the same processor and on different ones.
//   local_bench [rounds] [calls of a round] [spin in microseconds]
#include <sched.h>

#include <algorithm>
#include <array>
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

#include "rr/node.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/node/testing/child.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using rr::testing::Child;

extern const rr::Definition definition;
extern const rr::ObjectType value_type;

constexpr rr::Parameter blob_parameters[] = {rr::parameter<std::uint32_t>("size")};
enum Place : std::size_t { value_place, blob_place };
constexpr rr::Member members[] = {rr::property<double>("value", rr::readonly),
                                  rr::function<rr::Array<std::uint8_t>>("blob", blob_parameters)};

class ValueStub : public virtual rr::Stub {
 public:
  [[nodiscard]] const rr::ObjectType& rr_object_type() const override { return value_type; }
  double get_value() { return rr_get<double>(members[value_place], {}); }
  rr::Array<std::uint8_t> blob(std::uint32_t size) {
    return rr_call<rr::Array<std::uint8_t>>(members[blob_place], {}, size);
  }
};

constexpr const rr::ObjectType* objects[] = {&value_type};
constinit const rr::ObjectType value_type{
    "bench.local.Value", definition, {}, members, []() -> std::shared_ptr<rr::Stub> {
      return std::make_shared<ValueStub>();
    }};
constinit const rr::Definition definition{"bench.local",
                                          "service bench.local\n"
                                          "stdver 0.10\n"
                                          "object Value\n"
                                          "  property double value [readonly]\n"
                                          "  function uint8[] blob(uint32 size)\n"
                                          "end\n",
                                          {0, 10, 0, 0},
                                          {},
                                          {},
                                          {},
                                          objects};

class Value final : public rr::Skeleton {
 public:
  [[nodiscard]] const rr::ObjectType& rr_object_type() const override { return value_type; }
  void rr_dispatch(std::size_t member, rr::Request& request) override {
    if (member == value_place) {
      const double value = 42.5;
      request.answer(&value);
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
      times.push_back(std::chrono::duration<double, std::nano>(Clock::now() - begin).count());
    }
  }
  [[nodiscard]] double at(double share) {
    const auto place =
        times.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(times.size() - 1));
    std::nth_element(times.begin(), place, times.end());
    return *place;
  }
};

Way way_of(std::string name, const std::string& folder, const std::string& url, bool shares,
           int spin) {
  Way way{std::move(name), std::make_unique<rr::Node>(options(folder, shares, spin)), nullptr};
  way.client = std::make_unique<rr::Client<ValueStub>>(way.node->connect<ValueStub>(url));
  return way;
}

void compare(const std::string& folder, bool is_split, int rounds, int calls, int spin) {
  Child server({"serve", folder, is_split ? "1" : "0", std::to_string(spin)});
  const std::string ready = server.wait_for("ready");
  const std::string port = ready.substr(0, ready.find(' '));
  const std::string local =
      "rr+local:///?nodeid=" + ready.substr(ready.find(' ') + 1) + "&service=value";
  pin_to(0);
  std::vector<Way> ways;
  ways.push_back(
      way_of("tcp", folder, "rr+tcp://127.0.0.1:" + port + "/?service=value", false, spin));
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
