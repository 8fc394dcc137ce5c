// SPDX-License-Identifier: Apache-2.0
// A loop at 1 kHz that exchanges packets with itself, while clients read and write its bus over
// TCP: what it allocated and locked, how late it was, and, where cyclictest is installed, how late
// a program is here that does nothing else.
#include <algorithm>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "experimental/arm.hpp"
#include "rr/node.hpp"
#include "rr/realtime/service.hpp"
#include "rr/realtime/state_channel.hpp"
#include "runtime/cpp/src/realtime/testing/cost.hpp"

namespace {

using namespace std::chrono_literals;
using namespace rr::realtime;
namespace arm = experimental::arm;

class ArmObject final : public arm::ArmDefault {
 public:
  explicit ArmObject(LookupTable& table) : memory_(std::make_shared<TableMemory>(table)) {}
  std::shared_ptr<rr::ArrayMemorySource<double>> table() override { return memory_; }
  void start() override { memory_->load(2); }

 private:
  std::shared_ptr<TableMemory> memory_;
};

/// The real-time side.
class Loop {
 public:
  Loop() { socket_.connect("127.0.0.1", socket_.port()); }

  void run(testing::Cost& cost) {
    rights = become_realtime(80);
    const testing::Watched watched(cost);
    loop.run([this](const Cycle& cycle) { step(cycle); });
  }

  SteadyClock clock;
  CyclicLoop loop{1ms, clock};
  SignalGroup<arm::State> state;
  CommandGroup<arm::Command> command;
  LookupTable table{6, 100};
  ThreadRights rights;
  std::uint64_t commands = 0;

  [[nodiscard]] const ReceiveCounts& counts() const { return receiver_.counts(); }

 private:
  void step(const Cycle& cycle) {
    receiver_.poll(socket_, clock.now());
    if (command.take()) ++commands;
    table.begin_sample(cycle.number);
    std::array<double, 6> positions = command.value().target;
    table.read(static_cast<double>(cycle.number % 1000), positions);
    now_.sample = cycle.number;
    now_.mode = command.value().mode;
    for (std::size_t i = 0; i < positions.size(); ++i) now_.joints[i].angle = positions[i];
    state.write(now_);
    sender_.send(now_, clock.now());
  }

  UdpSocket socket_{"127.0.0.1", 0};
  StateSender<arm::State> sender_{layout_of<arm::State>(), socket_};
  StateReceiver<arm::State> receiver_{layout_of<arm::State>(), 5ms};
  arm::State now_{};
};

/// Reads and writes the bus as quickly as it goes, and now and then loads a table.
void use(const std::string& url, unsigned number, const std::atomic<bool>& is_over,
         std::atomic<std::uint64_t>& calls) {
  rr::Node node;
  const auto stub = node.connect<arm::ArmStub>(url);
  auto wire = stub->state().connect();
  for (std::uint64_t i = 0; !is_over; ++i) {
    (void)stub->state().peek_in();
    arm::Command command{.mode = static_cast<std::uint8_t>(number)};
    command.target.fill(static_cast<double>(i));
    stub->command().poke_out(command);
    if (i % 16 == number) {
      std::vector<double> rows(14, static_cast<double>(i));
      rows[0] = 0;
      rows[7] = 1000;
      stub->table().write(0, rows);
      stub->start();
    }
    calls += 2;
  }
}

/// The same; one that cannot connect, or whose call fails, begins anew.
void use_again(const std::string& url, unsigned number, const std::atomic<bool>& is_over,
               std::atomic<std::uint64_t>& calls, std::atomic<std::uint64_t>& failures) {
  while (!is_over) {
    try {
      use(url, number, is_over, calls);
    } catch (const rr::Error&) {
      ++failures;
    }
  }
}

long long microseconds(Nanoseconds time) { return static_cast<long long>(time / 1us); }

void print_times(const char* what, const JitterHistogram& times) {
  std::printf("realtime load: %s: mean %lld us, 99 %% %lld, 99.9 %% %lld, largest %lld\n", what,
              microseconds(times.mean()), microseconds(times.quantile(0.99)),
              microseconds(times.quantile(0.999)), microseconds(times.largest()));
}

bool read_number(std::string_view text, unsigned& number) {
  return std::from_chars(text.data(), text.data() + text.size(), number).ec == std::errc();
}

}  // namespace

int main(int argc, char** argv) try {
  unsigned seconds = 3;
  unsigned clients = 8;
  for (int i = 1; i < argc; i += 2) {
    const std::string_view word = argv[i];
    unsigned* const number = word == "--seconds"   ? &seconds
                             : word == "--clients" ? &clients
                                                   : nullptr;
    if (number == nullptr || i + 1 == argc || !read_number(argv[i + 1], *number)) {
      std::fputs("usage: realtime_load [--seconds N] [--clients N]\n", stderr);
      return 2;
    }
  }
  testing::Cost cost;
  Loop loop;
  const auto object = std::make_shared<ArmObject>(loop.table);
  rr::Node server;
  const auto service = server.register_service("arm", object);
  const std::string url =
      "rr+tcp://127.0.0.1:" + std::to_string(server.listen_tcp(0, "127.0.0.1")) + "?service=arm";
  std::atomic<bool> is_over{false};
  std::atomic<std::uint64_t> calls{0};
  std::atomic<std::uint64_t> failures{0};
  {
    BusService bus(5ms);
    bus.publish(loop.state, object->state());
    BusService::accept(object->command(), loop.command);
    std::thread realtime([&] { loop.run(cost); });
    std::vector<std::thread> users;
    for (unsigned i = 0; i < clients; ++i) {
      users.emplace_back([&, i] { use_again(url, i, is_over, calls, failures); });
    }
    // The floor of this machine, under the same load.
    const std::string floor =
        "command -v cyclictest >/dev/null && cyclictest -q -t1 -i1000 -p80 -m -D" +
        std::to_string(seconds) + " 2>&1 | tail -n 1 || sleep " + std::to_string(seconds);
    std::fflush(stdout);
    const int status = std::system(floor.c_str());
    is_over = true;
    for (std::thread& user : users) user.join();
    loop.loop.stop();
    realtime.join();
    if (status != 0) std::printf("realtime load: cyclictest ended with %d\n", status);
  }
  const LoopCounts& counts = loop.loop.counts();
  std::printf(
      "realtime load: %u s, %u clients, %llu calls, %llu failed, %llu commands taken, table %llu\n",
      seconds, clients, static_cast<unsigned long long>(calls.load()),
      static_cast<unsigned long long>(failures.load()),
      static_cast<unsigned long long>(loop.commands),
      static_cast<unsigned long long>(loop.table.current()));
  std::printf("realtime load: priority %s, memory locked %s\n",
              loop.rights.has_priority ? "yes" : "no",
              loop.rights.has_locked_memory ? "yes" : "no");
  std::printf("realtime load: %llu cycles, %llu overruns, %llu skipped\n",
              static_cast<unsigned long long>(counts.cycles.load()),
              static_cast<unsigned long long>(counts.overruns.load()),
              static_cast<unsigned long long>(counts.skipped.load()));
  print_times("lateness", counts.lateness);
  print_times("duration", counts.duration);
  std::printf("realtime load: %llu packets accepted, %llu lost\n",
              static_cast<unsigned long long>(loop.counts().accepted.load()),
              static_cast<unsigned long long>(loop.counts().lost.load()));
  std::printf("realtime load: %llu heap calls, %llu locks in the loop\n",
              static_cast<unsigned long long>(cost.allocations.load()),
              static_cast<unsigned long long>(cost.locks.load()));
  const bool has_worked = counts.cycles > 100 && calls > 0 && loop.commands > 0;
  return has_worked && cost.allocations == 0 && cost.locks == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "realtime_load: %s\n", error.what());
  return 1;
}
