// SPDX-License-Identifier: Apache-2.0
// The runtime as a contender of the wire benchmark: its server.
#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "bench.hpp"
#include "bench/wire.hpp"
#include "rr/node.hpp"

namespace {

namespace wire = bench::wire;

// Pushes packets to all subscribers of a run, once they are there.
class Service final : public wire::BenchSkeleton {
 public:
  Service() : frame_(10'000'000) { bench::fill_blob(frame_.data(), frame_.size()); }

  double get_value() override { return bench::kValue; }

  std::array<double, 16> call(const std::string& s, const std::array<double, 16>& a) override {
    std::array<double, 16> result;
    bench::serve_call(s.size(), a.data(), result.data());
    return result;
  }

  rr::Array<std::uint8_t> blob(std::uint32_t n) override {
    return rr::Array<std::uint8_t>::view({frame_.data(), std::min<std::size_t>(n, frame_.size())});
  }

  void subscribe(std::uint32_t n, double rate, std::uint32_t subscribers,
                 bool is_over_wire) override {
    if (is_over_wire) throw rr::Error(rr::ErrorCode::invalid_argument, "not over the wire");
    const std::lock_guard lock(mutex_);
    if (++subscribed_ < subscribers) return;
    subscribed_ = 0;
    producer_ = std::jthread([this, n, rate] {
      bench::sleep_s(0.05);
      produce(n, rate);
    });
  }

 private:
  void produce(std::uint32_t n, double rate) const {
    const auto pipe = states();
    wire::JointState state;
    bench::produce(n, rate, [&](const bench::JointState& from) {
      state.t_ns = from.t_ns;
      std::memcpy(state.q.data(), from.q, sizeof state.q);
      // Whoever sends more than a client takes has to wait for it, or the client is given up.
      if (rate == 0) (void)pipe.wait_sent(std::chrono::seconds(10));
      pipe.send(state);
    });
  }

  std::vector<std::uint8_t> frame_;
  std::mutex mutex_;
  std::uint32_t subscribed_ = 0;
  std::jthread producer_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  sigset_t stop;
  sigemptyset(&stop);
  sigaddset(&stop, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &stop, nullptr);
  rr::Node node;
  node.register_service("bench", std::make_shared<Service>());
  node.listen("rr+tcp://127.0.0.1:" + std::string(argv[1]));
  bench::ready();
  int signal = 0;
  sigwait(&stop, &signal);
  return 0;
}
