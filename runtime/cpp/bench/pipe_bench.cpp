// SPDX-License-Identifier: Apache-2.0
// Streams of small packets from a service to its clients over the loopback interface, flat out and
// paced.
//   pipe_bench [subscribers] [packets] [packets per second, 0 for flat out]
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "runtime/cpp/bench/source.hpp"

namespace {

using Clock = std::chrono::steady_clock;
using Sample = bench::Samples;
using bench::Source;
using bench::SourceStub;

double seconds(Clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

struct Subscriber {
  rr::Client<SourceStub> client;
  rr::PipeEndpoint<Sample> end;
  rr::Subscription subscription;
  std::uint32_t received = 0;
  std::uint32_t out_of_order = 0;
  std::vector<double> delays;
  std::atomic<bool> is_done{false};
};

}  // namespace

int main(int count, char** words) {
  const int subscribers = count > 1 ? std::atoi(words[1]) : 1;
  const auto packets = static_cast<std::uint32_t>(count > 2 ? std::atoi(words[2]) : 1'000'000);
  const double rate = count > 3 ? std::atof(words[3]) : 0;
  rr::Node server;
  const auto source = std::make_shared<Source>();
  server.register_service("source", source);
  const auto port = server.listen_tcp(0, "127.0.0.1");
  rr::Node node;
  std::vector<std::unique_ptr<Subscriber>> all;
  for (int i = 0; i < subscribers; ++i) {
    auto one = std::make_unique<Subscriber>();
    one->client =
        node.connect<SourceStub>("rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=source");
    one->end = one->client->samples().connect();
    one->delays.reserve(packets);
    one->subscription = one->end.on_packet([packets, me = one.get()](const Sample& sample) {
      if (sample[0] != me->received) ++me->out_of_order;
      me->delays.push_back(seconds(Clock::now()) - sample[1]);
      if (++me->received == packets) {
        me->is_done = true;
        me->is_done.notify_one();
      }
    });
    all.push_back(std::move(one));
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(100));

  const auto begin = Clock::now();
  const rr::PipeServer<Sample> pipe = source->samples();
  Sample sample(7);
  for (std::uint32_t i = 0; i < packets; ++i) {
    if (rate > 0) {
      std::this_thread::sleep_until(begin + std::chrono::duration_cast<Clock::duration>(
                                                std::chrono::duration<double>(i / rate)));
    }
    sample.mutate()[0] = i;
    sample.mutate()[1] = seconds(Clock::now());
    if (!pipe.wait_sent(std::chrono::seconds(10))) break;
    pipe.send(sample);
  }
  const double sending = std::chrono::duration<double>(Clock::now() - begin).count();
  std::uint64_t received = 0;
  std::uint64_t wrong = 0;
  std::vector<double> delays;
  for (auto& one : all) {
    if (one->end.is_open()) one->is_done.wait(false);
    received += one->received;
    wrong += one->out_of_order;
    delays.insert(delays.end(), one->delays.begin(), one->delays.end());
  }
  const double time = std::chrono::duration<double>(Clock::now() - begin).count();
  std::sort(delays.begin(), delays.end());
  const auto quantile = [&](double part) {
    return delays.empty()
               ? 0
               : 1e6 * delays[static_cast<std::size_t>(part * double(delays.size() - 1))];
  };
  std::printf(
      "%d subscribers, %u packets: %llu received, %llu out of order, %.0f packets/s, sent in %.2f "
      "s, "
      "delay p50 %.1f us, p99 %.1f us\n",
      subscribers, packets, static_cast<unsigned long long>(received),
      static_cast<unsigned long long>(wrong), static_cast<double>(received) / time, sending,
      quantile(0.5), quantile(0.99));
}
