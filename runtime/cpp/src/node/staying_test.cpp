// SPDX-License-Identifier: Apache-2.0
// Threads of the reactor that stay with a busy connection.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <thread>

#include "rr/options.hpp"
#include "runtime/cpp/src/channel/stream_connection.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_peer.hpp"

namespace rr::testing {
namespace {

using namespace std::chrono_literals;

// Answers each request with an empty entry, after what the test gives it to do.
class Answering final : public channel::Receiver {
 public:
  std::function<void()> work;
  channel::Connection* connection = nullptr;
  std::atomic<bool> is_silent{false};  // nothing is answered then
  std::atomic<unsigned> handled{0};
  std::atomic<bool> is_closed{false};

  void take_answer(const Message& /*message*/, const Entry& /*entry*/, const MemoryRef& /*owner*/,
                   channel::DeferredCallbacks& /*deferred*/) override {}
  void handle(const Message& /*message*/, const Entry& /*first*/,
              const MemoryRef& /*owner*/) override {
    if (work) work();
    ++handled;
    if (is_silent) return;
    Writer writer;
    writer.reset(MessageVersion::v2);
    writer.entry({.type = EntryType::get_node_info_ret}, 0, writer.position());
    writer.message({}, 1);
    connection->reply(writer);
  }
  void lost(const Error& /*why*/, channel::DeferredCallbacks& /*deferred*/) override {}
  void closed() override { is_closed = true; }
};

// So many messages, to be sent by one call.
std::vector<std::byte> questions(int count) {
  std::vector<std::byte> bytes;
  for (int i = 0; i < count; ++i) {
    Writer writer;
    writer.reset(MessageVersion::v2);
    writer.entry({.type = EntryType::get_node_info}, 0, writer.position());
    writer.message({}, 1);
    const std::vector<std::byte> one = writer.copy();
    bytes.insert(bytes.end(), one.begin(), one.end());
  }
  return bytes;
}

class Staying : public ::testing::Test {
 protected:
  struct Link {
    std::unique_ptr<RawPeer> peer;
    std::shared_ptr<Answering> receiver = std::make_shared<Answering>();
    std::shared_ptr<channel::StreamConnection> connection;
    int socket = -1;  // the connection's

    void call() {
      peer->ask_for_node_info();
      ASSERT_EQ(peer->next_type(), EntryType::get_node_info_ret);
    }
    // Sends one message, for which no answer comes, and waits until it has been handled.
    void tell() {
      const unsigned before = receiver->handled;
      peer->ask_for_node_info();
      EXPECT_TRUE(eventually([&] { return receiver->handled > before; }));
    }
    // Whether what has come is taken out of the socket within a while.
    [[nodiscard]] bool is_read() const {
      const auto deadline = channel::Clock::now() + 200ms;
      int size = 0;
      do {
        ::ioctl(socket, FIONREAD, &size);
      } while (size != 0 && channel::Clock::now() < deadline);
      return size == 0;
    }
    // Whether TCP acknowledges together with what this side says next, where that is soon.
    [[nodiscard]] bool acknowledges_late() const {
      int at_once = 1;
      socklen_t size = sizeof at_once;
      ::getsockopt(socket, IPPROTO_TCP, TCP_QUICKACK, &at_once, &size);
      return at_once == 0;
    }
  };

  Staying() { reactor_->start(); }
  ~Staying() override {
    for (const auto& link : links_) {
      link->connection->close(Error(ErrorCode::connection_error, "the test is over"));
    }
    reactor_->connections().wait_for_none();
    reactor_->stop();
  }

  template <class Paired = RawPeer::Paired>
  Link& connect() {
    auto link = std::make_unique<Link>();
    link->peer = std::make_unique<RawPeer>(Paired{link->socket});
    link->connection = std::make_shared<channel::StreamConnection>(
        channel::StreamConnection::Role::server, channel::Descriptor(link->socket), reactor_,
        options_);
    link->receiver->connection = link->connection.get();
    link->connection->start(link->receiver);
    links_.push_back(std::move(link));
    return *links_.back();
  }
  // Until a thread stays with the connection, which is alone. On a crowded machine calls that seem
  // to pause come in between.
  void keep_busy(Link& link) {
    const auto deadline = channel::Clock::now() + 60s;
    while (reactor_->stays() != 1) {
      ASSERT_LT(channel::Clock::now(), deadline);
      link.call();
    }
  }

  std::shared_ptr<const NodeOptions> options_ = std::make_shared<NodeOptions>(
      NodeOptions{.first_message_timeout = 120s, .heartbeat_period = 120s});
  // Four threads: one may stay.
  std::shared_ptr<channel::Reactor> reactor_ = std::make_shared<channel::Reactor>(4);
  std::vector<std::unique_ptr<Link>> links_;
};

TEST_F(Staying, LastsWhileTheConnectionIsBusy) {
  Link& link = connect();
  EXPECT_EQ(reactor_->stays(), 0U);
  link.call();
  EXPECT_EQ(reactor_->stays(), 0U);
  keep_busy(link);
  for (int i = 0; i < 1000; ++i) link.call();
  EXPECT_TRUE(eventually([&] { return reactor_->stays() == 0; }));
  link.call();
  keep_busy(link);
}

// Answers to messages that were received by one call leave by one call, unless the thread is held
// up between two of them, as on a crowded machine: then those before leave meanwhile.
TEST_F(Staying, AnswersToWhatCameTogetherLeaveTogether) {
  Link& link = connect<RawPeer::PairedByPackets>();
  link.peer->send(questions(1));
  const std::size_t size = link.peer->receive_packet().size();
  EXPECT_GT(size, 0U);
  const auto deadline = channel::Clock::now() + 60s;
  for (int together = 0; together < 10;) {
    ASSERT_LT(channel::Clock::now(), deadline) << together << " have left together";
    link.peer->send(questions(3));
    const std::size_t first = link.peer->receive_packet().size();
    std::size_t received = first;
    while (received < 3 * size) {
      const std::size_t next = link.peer->receive_packet().size();
      ASSERT_NE(next, 0U) << "the connection has ended";
      received += next;
    }
    EXPECT_EQ(received, 3 * size);
    if (first == received) ++together;
  }
}

TEST_F(Staying, AnAnswerLeavesWhileTheHandlerOfTheNextMessageTakesLong) {
  Link& link = connect();
  keep_busy(link);
  Gate gate;
  link.receiver->work = [&gate, handled = 0]() mutable {
    if (++handled == 2) gate.pass();
  };
  link.peer->send(questions(2));
  EXPECT_EQ(link.peer->next_type(), EntryType::get_node_info_ret);
  gate.open();
  EXPECT_EQ(link.peer->next_type(), EntryType::get_node_info_ret);
}

TEST_F(Staying, IsForAsManyAsThereAreThreadsFor) {
  Link& first = connect();
  Link& second = connect();
  keep_busy(first);
  std::atomic<bool> is_over{false};
  std::thread other([&] {
    while (!is_over) first.call();
  });
  for (int i = 0; i < 1000; ++i) {
    second.call();
    EXPECT_LE(reactor_->stays(), 1U);
  }
  is_over = true;
  other.join();
}

TEST_F(Staying, DoesNotKeepASlowHandlersConnectionFromBeingRead) {
  Link& link = connect();
  Gate gate;
  std::atomic<bool> is_slow{false};
  link.receiver->work = [&] {
    if (is_slow) gate.pass();
  };
  keep_busy(link);
  is_slow = true;
  link.peer->ask_for_node_info();
  ASSERT_TRUE(gate.has_entered());
  link.peer->ask_for_node_info();
  link.peer->ask(EntryType::connection_test);
  EXPECT_EQ(link.peer->next_type(), EntryType::connection_test_ret);
  EXPECT_EQ(gate.entered(), 1);
  is_slow = false;
  gate.open();
  EXPECT_EQ(link.peer->next_type(), EntryType::get_node_info_ret);
  EXPECT_EQ(link.peer->next_type(), EntryType::get_node_info_ret);
  link.call();
}

// What the other threads have left in the socket, as the queue was full, is not reported once more.
TEST_F(Staying, ReadsOnAfterASlowHandlerBeforeAFullQueue) {
  NodeOptions options = *options_;
  options.request_queue_limit = 4096;
  options_ = std::make_shared<NodeOptions>(options);
  Link& link = connect();
  Gate gate;
  std::atomic<bool> is_slow{false};
  link.receiver->work = [&] {
    if (is_slow) gate.pass();
  };
  keep_busy(link);
  link.receiver->is_silent = true;
  is_slow = true;
  const unsigned before = link.receiver->handled;
  link.peer->ask_for_node_info();
  ASSERT_TRUE(gate.has_entered());
  is_slow = false;
  unsigned sent = 1;
  // The last of them stay in the socket, so none of the threads reads.
  while (link.is_read()) {
    link.peer->ask_for_node_info();
    ++sent;
  }
  EXPECT_GT(sent, 4096U / 256);
  gate.open();
  EXPECT_TRUE(eventually([&] { return link.receiver->handled == before + sent; }))
      << link.receiver->handled - before << " of " << sent;
}

// Otherwise each is acknowledged by a segment of its own, before it is handled. On a crowded
// machine a pause may look like a sender that waits, which ends it for that connection.
TEST_F(Staying, AcknowledgesLateWhatComesAlone) {
  bool is_late = false;
  for (int attempt = 0; attempt < 20 && !is_late; ++attempt) {
    Link& link = connect<RawPeer::PairedByTcp>();
    keep_busy(link);
    link.receiver->is_silent = true;
    // Calls have made the kernel do so by itself, until it has waited in vain, for 40 ms. A pause
    // as short as that would look like a sender that waits.
    link.tell();
    std::this_thread::sleep_for(100ms);
    EXPECT_TRUE(eventually([&] { return !link.acknowledges_late(); }));
    for (int i = 0; i < 300 && !is_late; ++i) {
      link.tell();
      is_late = link.acknowledges_late();
    }
    link.connection->close(Error(ErrorCode::connection_error, "the attempt is over"));
    EXPECT_TRUE(eventually([&] { return link.receiver->is_closed && reactor_->stays() == 0; }));
  }
  EXPECT_TRUE(is_late);
}

// As a small device needs it, whose TCP has one segment under way at a time.
TEST_F(Staying, AcknowledgesAtOnceAgainWhereTheSenderWaitsForThat) {
  Link& link = connect<RawPeer::PairedByTcp>();
  keep_busy(link);
  link.receiver->is_silent = true;
  int at_once = 0;
  for (int i = 0; i < 3000 && at_once < 200; ++i) {
    link.tell();
    at_once = link.acknowledges_late() ? 0 : at_once + 1;
    EXPECT_TRUE(eventually([&] { return link.peer->unacknowledged() == 0; }));
  }
  EXPECT_EQ(at_once, 200);
}

TEST_F(Staying, EndsWithTheConnection) {
  Link& link = connect();
  keep_busy(link);
  link.peer.reset();
  EXPECT_TRUE(eventually([&] { return link.receiver->is_closed.load(); }));
  EXPECT_TRUE(eventually([&] { return reactor_->stays() == 0; }));
}

TEST_F(Staying, EndsWhenTheConnectionIsClosedHere) {
  Link& link = connect();
  keep_busy(link);
  link.connection->close(Error(ErrorCode::connection_error, "no more"));
  EXPECT_TRUE(link.peer->is_closed());
  EXPECT_TRUE(eventually([&] { return link.receiver->is_closed.load(); }));
}

TEST_F(Staying, EndsWhenTheThreadIsNeeded) {
  Link& link = connect();
  keep_busy(link);
  std::atomic<bool> is_over{false};
  std::thread caller([&] {
    while (!is_over) link.call();
  });
  Gate gate;  // one thread stays, one polls, one watches: two that wait leave nobody to poll
  for (int i = 1; i <= 2; ++i) {
    reactor_->post([&] { gate.pass(); });
    ASSERT_TRUE(gate.has_entered(i));
  }
  std::promise<void> third;
  reactor_->post([&] { third.set_value(); });
  EXPECT_EQ(third.get_future().wait_for(20s), std::future_status::ready);
  EXPECT_EQ(reactor_->stays(), 0U);
  gate.open();
  is_over = true;
  caller.join();
  keep_busy(link);
}

TEST(StayingNodes, CanBeShutDownWhileClientsCall) {
  Pair pair;
  std::vector<std::thread> callers;
  std::atomic<int> calls{0};
  for (int i = 0; i < 3; ++i) {
    callers.emplace_back([&, counter = pair.connect()]() mutable {
      const Error error = error_of([&] {
        while (true) {
          EXPECT_EQ(counter->add(1, 2), 3);
          ++calls;
        }
      });
      // One call may be under way; if none is, the next one finds the session ended.
      EXPECT_TRUE(error.code() == ErrorCode::connection_error ||
                  error.code() == ErrorCode::invalid_operation)
          << error.what();
    });
  }
  EXPECT_TRUE(eventually([&] { return calls > 3000; }));
  pair.server.shutdown();
  for (std::thread& caller : callers) caller.join();
}

}  // namespace
}  // namespace rr::testing
