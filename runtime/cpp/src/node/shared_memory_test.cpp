// SPDX-License-Identifier: Apache-2.0
// Two nodes that exchange their messages through shared memory: who has it, processes that are
// killed, and a memory that is written over at any time.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>

#include <array>
#include <atomic>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "runtime/cpp/src/node/testing/child.hpp"
#include "runtime/cpp/src/node/testing/mappings.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/raw_peer.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;

class SharedMemory : public ::testing::Test {
 protected:
  SharedMemory() {
    static int count = 0;
    run_ = test_folder() + "/shm" + std::to_string(count++);
  }
  [[nodiscard]] NodeOptions options(bool shares = true) const {
    NodeOptions options;
    options.local.user_run_dir = run_;
    options.local.shared_memory = shares;
    return options;
  }
  static std::string url(const Node& node) {
    return "rr+local:///?nodeid=" + node.id().text() + "&service=counter";
  }
  [[nodiscard]] std::vector<std::string> words(std::vector<std::string> more) const {
    more.insert(more.begin(), run_);
    return more;
  }

  std::string run_;
};

// A service that is listened to in this process.
struct Served {
  explicit Served(NodeOptions options) : node(std::move(options)) {
    node.register_service("counter", object);
    node.listen("rr+local://");
  }
  std::shared_ptr<Counter> object = std::make_shared<Counter>();
  Node node;
};

TEST_F(SharedMemory, IsUsedWhereBothWantIt) {
  const Served server(options());
  {
    Node client(options());
    auto counter = client.connect<CounterStub>(url(server.node));
    counter->set_value(1.5);
    EXPECT_EQ(counter->get_value(), 1.5);
    EXPECT_EQ(mappings().size(), 2U);
  }
  EXPECT_TRUE(eventually([] { return mappings().empty(); }));
}

TEST_F(SharedMemory, IsNotUsedWhereOneDoesNotWantIt) {
  for (const bool is_server : {true, false}) {
    const Served server(options(is_server));
    Node client(options(!is_server));
    auto counter = client.connect<CounterStub>(url(server.node));
    counter->set_value(2.5);
    EXPECT_EQ(counter->get_value(), 2.5);
    EXPECT_TRUE(mappings().empty());
  }
}

// A server of another implementation is asked for the capability, and for no memory.
TEST_F(SharedMemory, IsAskedForByTheNameOfTheCapability) {
  const std::string path = test_folder() + "/plain";
  const int listening = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(::bind(listening, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(::listen(listening, 1), 0);
  std::vector<std::string> asked;
  std::thread server([&] {
    RawPeer peer(RawPeer::Accepted{::accept(listening, nullptr, nullptr)});
    const NodeId node = NodeId::random();
    for (int i = 0; i < 3; ++i) {
      const RawPeer::Received request = peer.next();
      asked.push_back(std::to_string(static_cast<int>(request.type)) + " " + request.member);
      Writer writer;
      writer.reset(MessageVersion::v2);
      const std::size_t end = writer.position();
      const std::uint32_t level = 0;
      const bool is_capability = request.type == EntryType::stream_check_capability;
      if (is_capability) type_of<std::uint32_t>.write(writer, "return", &level);
      writer.entry({.type = static_cast<EntryType>(static_cast<int>(request.type) + 1),
                    .member = request.member,
                    .request_id = request.request_id},
                   is_capability ? 1 : 0, end);
      writer.message({.sender_node = node}, 1);
      peer.send(writer.copy());
    }
  });
  Node client(options());
  EXPECT_THROW(client.connect<CounterStub>("rr+local://" + path + "?service=counter"), Error);
  server.join();
  ::close(listening);
  ASSERT_EQ(asked.size(), 3U);
  EXPECT_EQ(asked[0], "1 CreateConnection");
  EXPECT_EQ(asked[1], "3 robdef.shared_memory");
  EXPECT_EQ(asked[2].substr(0, 4), "101 ") << "the service is asked next";
}

TEST_F(SharedMemory, AThreadThatWaitsForAnAnswerTakesNoProcessor) {
  const Served server(options());
  Node client(options());
  auto counter = client.connect<CounterStub>(url(server.node));
  const auto used = [] {
    timespec time{};
    ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  };
  const auto before = used();
  counter->slow(500);
  EXPECT_LT(used() - before, 200ms);
}

TEST_F(SharedMemory, IsNotUsedWhereTheClientMayNotHoldSoMuch) {
  NodeOptions small = options();
  small.budget.before_session = 64 * 1024;
  small.budget.reserve = 16 * 1024;
  const Served server(small);
  Node client(options());
  auto counter = client.connect<CounterStub>(url(server.node));
  counter->set_value(3.5);
  EXPECT_EQ(counter->get_value(), 3.5);
  EXPECT_TRUE(mappings().empty());
}

TEST_F(SharedMemory, CarriesWhatIsLargerThanARing) {
  const Served server(options());
  Node client(options());
  auto counter = client.connect<CounterStub>(url(server.node));
  const Array<std::uint8_t> bytes = counter->blob(3'000'000);
  ASSERT_EQ(bytes.size(), 3'000'000U);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] != static_cast<std::uint8_t>(i * 31 + 7)) ++wrong;
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_EQ(counter->take(Array<double>(std::size_t{400'000})), 400'000U);
}

TEST_F(SharedMemory, IsForManyCallersWhoSpin) {
  NodeOptions spinning = options();
  spinning.spin = std::chrono::microseconds(30);
  const Served server(spinning);
  Node client(spinning);
  auto counter = client.connect<CounterStub>(url(server.node));
  std::atomic<int> right{0};
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&, caller] {
      for (int i = 0; i < 500; ++i) {
        if (counter->add(caller, i) == caller + i) ++right;
      }
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(right, 2000);
}

// Each time at another moment of its calls.
TEST_F(SharedMemory, AServerMayBeKilledAtAnyTime) {
  std::mt19937 random(46);
  Node client(options());
  for (int round = 0; round < 150 / slowness(); ++round) {
    Child server(words({"serve"}), RR_SHARED_MEMORY_PEER);
    auto counter = client.connect<CounterStub>(server.wait_for("ready"));
    std::atomic<int> failed{0};
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 2; ++caller) {
      callers.emplace_back([&, caller] {
        try {
          while (true) {
            if (caller == 0) counter->get_value();
            if (caller == 1) counter->blob(100'000);
          }
        } catch (const Error& error) {
          EXPECT_EQ(error.code(), ErrorCode::connection_error) << error.message();
          ++failed;
        }
      });
    }
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
    server.signal(SIGKILL);
    for (std::thread& caller : callers) caller.join();
    EXPECT_EQ(failed, 2);
  }
  EXPECT_TRUE(eventually([] { return mappings().empty(); }));
}

TEST_F(SharedMemory, AClientMayBeKilledAtAnyTime) {
  std::mt19937 random(47);
  const Served server(options());
  Node other(options());
  auto counter = other.connect<CounterStub>(url(server.node));
  counter->set_value(4.5);
  const std::size_t before = mappings().size();
  const std::size_t descriptors = ProcessState::now().descriptors;
  for (int round = 0; round < 150 / slowness(); ++round) {
    Child client(words({"call", url(server.node)}), RR_SHARED_MEMORY_PEER);
    client.wait_for("calling");
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
    client.signal(SIGKILL);
    EXPECT_EQ(counter->get_value(), 4.5);
  }
  EXPECT_TRUE(eventually([&] { return mappings().size() == before; })) << mappings().size();
  EXPECT_TRUE(eventually([&] { return ProcessState::now().descriptors <= descriptors; }));
}

// Both sides are in this process, and each finds what the other one could have written. Nothing
// but the connection may come to harm.
TEST_F(SharedMemory, MayBeWrittenOverByTheOtherSide) {
  NodeOptions hasty = options();
  hasty.request_timeout = 50ms;
  const Served server(options());
  Node client(hasty);
  Node other(options(false));
  auto undisturbed = other.connect<CounterStub>(url(server.node));
  undisturbed->set_value(5.5);
  std::mt19937_64 random(48);
  int broken = 0;
  for (int round = 0; round < 200 / slowness(); ++round) {
    auto counter = client.connect<CounterStub>(url(server.node));
    counter->get_value();
    std::vector<SecondMapping> memories;
    for (const Mapping& mapping : mappings()) {
      SecondMapping second(mapping);
      if (second.is_there()) memories.push_back(std::move(second));
    }
    std::atomic<bool> is_over{false};
    std::thread writer([&, seed = random()] {
      std::mt19937_64 chance(seed);
      while (!is_over && !memories.empty()) {
        memories[chance() % memories.size()].scribble(chance);
        if (chance() % 4 == 0) std::this_thread::yield();
      }
    });
    for (int i = 0; i < 20 && counter.is_open(); ++i) {
      try {
        counter->get_value();
        counter->blob(10'000);
      } catch (const Error&) {
        ++broken;
      }
    }
    is_over = true;
    writer.join();
    EXPECT_EQ(undisturbed->get_value(), 5.5);
  }
  EXPECT_NE(broken, 0);
  EXPECT_TRUE(eventually([] { return mappings().empty(); })) << mappings().size();
}

}  // namespace
}  // namespace rr::testing
