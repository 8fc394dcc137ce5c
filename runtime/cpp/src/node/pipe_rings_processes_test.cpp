// SPDX-License-Identifier: Apache-2.0
// Pipes whose packets come through a ring in shared memory: processes that are killed and stopped
// at any time, and sides that write over what the other one reads.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <future>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/pipe_rings_rig.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;

// Sends numbers until the test is over.
class Sending {
 public:
  explicit Sending(const PipeBoard& board) {
    thread_ = std::thread([this, &board] {
      for (double number = 1; !is_over_; ++number) {
        if (!board.numbers().wait_sent(plenty)) return;
        board.numbers().send(number);
      }
    });
  }
  ~Sending() {
    is_over_ = true;
    thread_.join();
  }
  Sending(const Sending&) = delete;
  Sending& operator=(const Sending&) = delete;

 private:
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

// Each time at another moment.
TEST_F(PipeRings, AReaderMayBeKilledAtAnyTime) {
  serve(options());
  auto end = connect_numbers();
  std::atomic<double> last{0};
  std::atomic<int> missed{0};
  const Subscription subscription = end.on_packet([&](double number) {
    if (number != last.exchange(number) + 1) ++missed;
  });
  const std::size_t before = ProcessState::now().descriptors;
  {
    const Sending sending(*object_);
    std::mt19937 random(61);
    for (int round = 0; round < 100 / slowness(); ++round) {
      Child reader(words({"receive", url()}), RR_SHARED_MEMORY_PEER);
      reader.wait_for("receiving");
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
      reader.signal(SIGKILL);
      const double now = last;
      ASSERT_TRUE(eventually([&] { return last > now; }))
          << now << ", open: " << end.is_open() << ", read: " << rings_read()
          << ", ends: " << object_->numbers().endpoint_count();
    }
  }
  EXPECT_EQ(missed, 0);
  EXPECT_TRUE(eventually([&] { return object_->numbers().endpoint_count() == 1; }));
  EXPECT_TRUE(eventually([&] { return ProcessState::now().descriptors <= before; }));
}

TEST_F(PipeRings, AReaderThatIsKilledDoesNotKeepTheSenderWaiting) {
  serve(options(false));  // whose socket wakes the sender at once
  double number = 0;
  for (int round = 0; round < 20; ++round) {
    Child reader(words({"receive", url()}), RR_SHARED_MEMORY_PEER);
    ASSERT_TRUE(eventually([&] { return object_->numbers().endpoint_count() == 1; }));
    object_->numbers().send(++number);
    reader.wait_for("receiving");
    reader.stop();
    while (object_->numbers().wait_sent(0ms)) object_->numbers().send(++number);
    auto has_sent =
        std::async(std::launch::async, [&] { return object_->numbers().wait_sent(plenty); });
    EXPECT_EQ(has_sent.wait_for(1ms), std::future_status::timeout);
    reader.signal(SIGKILL);
    EXPECT_TRUE(has_sent.get());
    ASSERT_TRUE(eventually([&] { return object_->numbers().endpoint_count() == 0; }));
  }
}

TEST_F(PipeRings, AServiceMayBeKilledAtAnyTime) {
  std::mt19937 random(62);
  for (int round = 0; round < 60 / slowness(); ++round) {
    {
      Child server(words({"send"}), RR_SHARED_MEMORY_PEER);
      Node client(options());
      auto board = client.connect<PipeBoardStub>(server.wait_for("ready"));
      auto end = board->numbers().connect();
      const auto first = end.receive_for(plenty);
      ASSERT_TRUE(first);
      double last = *first;
      std::thread killer([&, wait = random() % 3000] {
        std::this_thread::sleep_for(std::chrono::microseconds(wait));
        server.signal(SIGKILL);
      });
      while (const auto number = end.receive_for(plenty)) ASSERT_EQ(*number, ++last);
      killer.join();
      EXPECT_FALSE(end.is_open());
    }
    EXPECT_TRUE(eventually([] { return mappings().empty(); }));
  }
}

TEST_F(PipeRings, AReaderThatIsStoppedHoldsUpNobodyAndLosesNothing) {
  serve(options());
  auto end = connect_numbers();
  Child reader(words({"receive", url()}), RR_SHARED_MEMORY_PEER);
  // A packet that comes before it has connected is not for it.
  ASSERT_TRUE(eventually([&] { return object_->numbers().endpoint_count() == 2; }));
  send(1, 1);
  reader.wait_for("receiving");
  reader.stop();
  send(2, 20'000);
  expect_numbers(end, 1, 20'000);
  reader.signal(SIGCONT);
  reader.wait_for("at 20000");
}

// Both sides are in this process: each reader finds what a lying service could have written.
// Nothing but the connection may come to harm.
TEST_F(PipeRings, MayBeWrittenOverByTheService) {
  serve(options());
  std::mt19937_64 random(63);
  int broken = 0;
  for (int round = 0; round < 40 / slowness(); ++round) {
    {
      Node client(options());
      auto board = client.connect<PipeBoardStub>(url());
      auto numbers = board->numbers().connect();
      auto blobs = board->blobs().connect();
      const Subscription subscription = numbers.on_packet([](double /*number*/) {});
      std::vector<SecondMapping> memories;
      for (const Mapping& mapping : mappings()) {
        if (mapping.kind != 3 || !mapping.is_writable) continue;
        SecondMapping second(mapping);
        ASSERT_TRUE(second.is_there());
        memories.push_back(std::move(second));
      }
      ASSERT_EQ(memories.size(), 2U);
      std::atomic<bool> is_over{false};
      std::thread writer([&, seed = random()] {
        std::mt19937_64 chance(seed);
        while (!is_over) {
          SecondMapping& memory = memories[chance() % memories.size()];
          switch (chance() % 4) {
            case 0:
              memory.scribble_at(0x100, 0x80, chance);  // words of the ring
              break;
            case 1:
              memory.scribble_at(0x1000, 0x10, chance);  // and of its readers
              break;
            default:
              memory.scribble(chance);
          }
          if (chance() % 4 == 0) std::this_thread::yield();
        }
      });
      for (int i = 0; i < 3000 && numbers.is_open(); ++i) {
        object_->numbers().send(i);
        object_->blobs().send(Array<std::uint8_t>(static_cast<std::size_t>(i % 500)));
        (void)blobs.try_receive();
      }
      is_over = true;
      writer.join();
      broken += numbers.is_open() ? 0 : 1;
    }
    EXPECT_TRUE(eventually([] { return mappings().empty(); }));
  }
  EXPECT_GT(broken, 0);
}

// The same for what a client can write: the words of its connection. Other clients get all packets.
TEST_F(PipeRings, MayBeWrittenOverByAClient) {
  serve(options());
  std::mt19937_64 random(64);
  auto end = connect_numbers();
  const std::vector<Mapping> own = mappings();
  int last = 0;
  for (int round = 0; round < 40 / slowness(); ++round) {
    Node client(options());
    auto board = client.connect<PipeBoardStub>(url());
    auto numbers = board->numbers().connect();
    std::vector<SecondMapping> rings;
    for (const Mapping& mapping : mappings()) {
      const bool is_own = std::ranges::any_of(
          own, [&](const Mapping& other) { return other.begin == mapping.begin; });
      if (mapping.kind == 1 && !is_own) rings.emplace_back(mapping);
    }
    ASSERT_FALSE(rings.empty());
    std::atomic<bool> is_over{false};
    std::thread writer([&, seed = random()] {
      std::mt19937_64 chance(seed);
      while (!is_over) rings[chance() % rings.size()].scribble_at(0x400, 0x40, chance);
    });
    for (int i = 0; i < 2000; ++i) {
      send(last + 1, last + 1);
      ++last;
      expect_numbers(end, last, last);
      (void)numbers.try_receive();
    }
    is_over = true;
    writer.join();
  }
}

}  // namespace
}  // namespace rr::testing
