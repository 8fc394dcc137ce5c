// SPDX-License-Identifier: Apache-2.0
// The runtime as a contender of the wire benchmark: its server.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "bench.hpp"
#include "bench/wire.hpp"
#include "rr/node.hpp"

namespace {

class Service final : public bench::wire::BenchSkeleton {
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

  void subscribe(std::uint32_t, double, std::uint32_t, bool) override {
    throw rr::Error(rr::ErrorCode::not_implemented_error, "streams need pipes");
  }

 private:
  std::vector<std::uint8_t> frame_;
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
