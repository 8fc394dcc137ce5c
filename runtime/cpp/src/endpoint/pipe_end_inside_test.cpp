// SPDX-License-Identifier: Apache-2.0
// Ends of pipes without a network: what leaves one, what arrives, and the table of a session.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <future>
#include <limits>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/stub.hpp"
#include "runtime/cpp/src/channel/metrics.hpp"
#include "runtime/cpp/src/channel/metrics_text.hpp"
#include "runtime/cpp/src/endpoint/pipe_arrival.hpp"
#include "runtime/cpp/src/endpoint/pipe_packets.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/endpoint/pipe_table.hpp"
#include "runtime/cpp/src/endpoint/testing/pipe_end_rig.hpp"

namespace rr::endpoint {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;
using rr::testing::numbers_member;
using rr::testing::PipeEndTest;

constexpr Member from_service = pipe<double>("from_service", readonly);
constexpr Member to_service = pipe<double>("to_service", writeonly);

TEST_F(PipeEndTest, NumbersItsPackets) {
  const End end = make();
  const double value = 1.5;
  EXPECT_EQ(end->send(&value), 1U);
  EXPECT_EQ(end->send(&value), 2U);
  side_->fake.refusal = Error(ErrorCode::buffer_limit_violation, "full");
  EXPECT_EQ(failure([&] { end->send(&value); }), ErrorCode::buffer_limit_violation);
  side_->fake.refusal.reset();
  EXPECT_EQ(end->send(&value), 3U) << "what was not sent has taken no number";
  EXPECT_EQ(side_->fake.sent.size(), 3U);
}

// The element `packet` of a number, written once for each format.
class WrittenNumber final : public PipeEnd::State::Written {
 public:
  const Form& in(MessageVersion version) override {
    writer_.reset(version);
    const double value = 1.5;
    type_of<double>.write(writer_, "packet", &value);
    bytes_ = writer_.copy();
    form_ = {bytes_, {}};
    return form_;
  }

 private:
  Writer writer_;
  std::vector<std::byte> bytes_;
  Form form_;
};

TEST_F(PipeEndTest, SendsWhatIsWrittenAlreadyAsItSendsAValue) {
  const End end = make();
  const End other = make();
  const double value = 1.5;
  end->send(&value);
  WrittenNumber written;
  EXPECT_EQ(other->send_written(written), 1U);
  ASSERT_EQ(side_->fake.sent.size(), 2U);
  EXPECT_EQ(side_->fake.sent[0], side_->fake.sent[1]);
}

TEST_F(PipeEndTest, EachSideSendsWhereTheMemberLetsIt) {
  const double value = 1;
  const End reader = make(from_service);
  EXPECT_EQ(failure([&] { reader->send(&value); }), ErrorCode::read_only_member);
  EXPECT_TRUE(reader->may_receive());
  EXPECT_FALSE(make(to_service)->may_receive());
  const End service = make(to_service, 4, false);
  EXPECT_EQ(failure([&] { service->send(&value); }), ErrorCode::write_only_member);
  EXPECT_TRUE(service->may_receive());
  EXPECT_FALSE(make(from_service, 4, false)->may_receive());
}

TEST_F(PipeEndTest, CountsWhatIsNotAcknowledged) {
  const End end = make();
  const double value = 1;
  end->send(&value);
  EXPECT_EQ(end->unacknowledged(), 0U) << "not asked for";
  end->ask_for_acknowledgements(true);
  end->send(&value);
  end->send(&value);
  EXPECT_EQ(end->unacknowledged(), 2U);
  std::vector<std::uint32_t> acknowledged;
  end->on_acknowledged([&](std::uint32_t number) { acknowledged.push_back(number); });
  for (const std::uint32_t number : {2U, 3U, 9U}) end->take_acknowledgement(number);
  EXPECT_EQ(end->unacknowledged(), 0U);
  EXPECT_EQ(acknowledged, (std::vector<std::uint32_t>{2, 3, 9}));
  end->ask_for_acknowledgements(false);
  end->send(&value);
  EXPECT_EQ(end->unacknowledged(), 0U);
}

TEST_F(PipeEndTest, KnowsWhetherTheOtherSideTakesWhatIsSent) {
  const End end = make();
  EXPECT_TRUE(end->has_sent(0));
  EXPECT_TRUE(end->wait_sent(1h, 0));
  side_->fake.has_room = false;
  EXPECT_FALSE(end->has_sent(0));
  EXPECT_FALSE(end->wait_sent(1ms, 0));
  side_->fake.has_room = true;
  end->finish();
  EXPECT_FALSE(end->has_sent(0));
  EXPECT_FALSE(end->wait_sent(1h, 0));
}

TEST_F(PipeEndTest, CountsADroppedPacketInTheMetricsOfItsNode) {
  make()->count_dropped();
  channel::MetricsText text;
  core_->reactor().metrics()->write(text);
  EXPECT_NE(std::move(text).finish().find("robdef_pipe_packets_total{outcome=\"dropped\"} 1\n"),
            std::string::npos);
}

TEST_F(PipeEndTest, PacketsAreTakenInTheirOrder) {
  const End end = make();
  EXPECT_EQ(end->take(), nullptr);
  EXPECT_EQ(end->peek(), nullptr);
  EXPECT_FALSE(end->wait(0ms));
  EXPECT_TRUE(end->accept(2, packet(2), 8));
  EXPECT_EQ(end->available(), 0U);
  EXPECT_TRUE(end->accept(1, packet(1), 8));
  EXPECT_TRUE(end->wait(1h));
  EXPECT_EQ(end->available(), 2U);
  EXPECT_EQ(value_of(end->peek()), 1);
  EXPECT_EQ(value_of(end->take()), 1);
  EXPECT_EQ(value_of(end->take()), 2);
  EXPECT_EQ(end->available(), 0U);
}

TEST_F(PipeEndTest, AnUnreliableOneTakesPacketsAsTheyCome) {
  const End end = make(numbers_member, 4, true, "arm", true);
  EXPECT_TRUE(end->accept(7, packet(7), 8));
  EXPECT_TRUE(end->accept(3, packet(3), 8));
  EXPECT_EQ(value_of(end->take()), 7);
}

TEST_F(PipeEndTest, AThreadThatWaitsIsWokenByAPacketOrTheEnd) {
  for (const bool is_ended : {false, true}) {
    const End end = make();
    std::future<bool> found = std::async(std::launch::async, [&] { return end->wait(1h); });
    if (is_ended) {
      end->finish();
    } else {
      EXPECT_TRUE(end->accept(1, packet(1), 8));
    }
    EXPECT_EQ(found.get(), !is_ended);
  }
}

TEST_F(PipeEndTest, AFullQueueLosesPacketsOrClosesTheEnd) {
  const End end = make();
  end->set_queue_limit(1, WhenFull::drop_newest, 1'000'000);
  EXPECT_TRUE(end->accept(1, packet(1), 8));
  EXPECT_TRUE(end->accept(2, packet(2), 8));
  EXPECT_EQ(end->lost_count(), 1U);
  end->set_queue_limit(1, WhenFull::close, 1'000'000);
  EXPECT_FALSE(end->accept(3, packet(3), 8));
  EXPECT_EQ(value_of(end->take()), 1);
}

TEST_F(PipeEndTest, AFunctionGetsThePackets) {
  const End end = make();
  std::vector<double> got;
  Subscription subscription =
      end->on_received([&](const std::shared_ptr<void>& value) { got.push_back(value_of(value)); });
  for (const std::uint32_t number : {1U, 2U}) {
    EXPECT_TRUE(end->accept(number, packet(number), 8));
    end->deliver();
  }
  EXPECT_EQ(got, (std::vector<double>{1, 2}));
  subscription.disconnect();
  EXPECT_TRUE(end->accept(3, packet(3), 8));
  end->deliver();
  EXPECT_EQ(got.size(), 2U);
  EXPECT_EQ(end->available(), 1U);
}

TEST_F(PipeEndTest, AFunctionGetsWhatWasThereBefore) {
  const End end = make();
  EXPECT_TRUE(end->accept(1, packet(1), 8));
  std::promise<double> first;
  const Subscription subscription = end->on_received(
      [&](const std::shared_ptr<void>& value) { first.set_value(value_of(value)); });
  EXPECT_EQ(first.get_future().get(), 1);
}

// Such a function often has the end itself.
TEST_F(PipeEndTest, FunctionsThatComeAfterItsEndAreNotKept) {
  const auto held = std::make_shared<int>();
  const std::weak_ptr<int> seen = held;
  const End end = make();
  end->finish();
  end->on_received([held](const std::shared_ptr<void>&) {}).detach();
  end->on_acknowledged([held](std::uint32_t) {});
  core_->stop();  // all that was posted has run
  EXPECT_EQ(seen.use_count(), 1);
}

TEST_F(PipeEndTest, FunctionsGoWithItsEnd) {
  const auto held = std::make_shared<int>();
  const std::weak_ptr<int> seen = held;
  const End end = make();
  end->on_received([held](const std::shared_ptr<void>&) {}).detach();
  end->on_acknowledged([held](std::uint32_t) {});
  EXPECT_EQ(seen.use_count(), 3);
  end->finish();
  core_->stop();  // all that was posted has run
  EXPECT_EQ(seen.use_count(), 1);
}

class PromisedPacket final : public Completion {
 public:
  explicit PromisedPacket(std::promise<double>& promise) : promise_(promise) {}
  void* result() override { return &packet_; }
  void succeed() override { promise_.set_value(*static_cast<const double*>(packet_.get())); }
  void fail(std::exception_ptr error) override { promise_.set_exception(std::move(error)); }

 private:
  std::promise<double>& promise_;
  std::shared_ptr<void> packet_;
};

TEST_F(PipeEndTest, ACompletionGetsThePacketTheEndOrItsTimeOut) {
  const End end = make();
  std::promise<double> next;
  end->start_receive(std::make_unique<PromisedPacket>(next));
  EXPECT_TRUE(end->accept(1, packet(1.5), 8));
  end->deliver();
  EXPECT_EQ(next.get_future().get(), 1.5);
  std::promise<double> late;
  {
    const CallOptions options{1ms, {}};
    const CallOptionsScope scope(options);
    end->start_receive(std::make_unique<PromisedPacket>(late));
  }
  EXPECT_EQ(failure([&] { late.get_future().get(); }), ErrorCode::request_timeout);
  std::promise<double> never;
  end->start_receive(std::make_unique<PromisedPacket>(never));
  end->finish();
  EXPECT_EQ(failure([&] { never.get_future().get(); }), ErrorCode::invalid_operation);
}

TEST_F(PipeEndTest, EndsOnce) {
  const End end = make();
  EXPECT_TRUE(end->is_open());
  EXPECT_EQ(end->side(), side_);
  std::promise<void> told;
  end->on_closed([&] { told.set_value(); });
  EXPECT_TRUE(end->accept(1, packet(1), 8));
  EXPECT_TRUE(end->finish());
  EXPECT_FALSE(end->finish());
  told.get_future().get();
  EXPECT_FALSE(end->is_open());
  EXPECT_EQ(end->side(), nullptr);
  EXPECT_TRUE(end->accept(2, packet(2), 8)) << "too late";
  EXPECT_EQ(end->available(), 1U) << "what came before";
  const double value = 1;
  EXPECT_EQ(failure([&] { end->send(&value); }), ErrorCode::invalid_operation);
  std::promise<void> late;
  end->on_closed([&] { late.set_value(); });
  late.get_future().get();
}

TEST_F(PipeEndTest, AHandleLeadsToItsState) {
  const End end = make();
  const PipeEnd handle(end);
  EXPECT_EQ(PipeEnd::State::of(handle), end);
  end->deliver_soon();  // nothing to do
}

TEST_F(PipeEndTest, ATableFindsEndsByPathMemberAndIndex) {
  PipeTable table;
  const End first = make(numbers_member, 4);
  const End second = make(numbers_member, 5);
  const End below = make(numbers_member, 4, true, "arm.tool");
  const End beside = make(numbers_member, 4, true, "arms");
  for (const End& end : {first, second, below, beside}) EXPECT_TRUE(table.add(end));
  EXPECT_FALSE(table.add(make(numbers_member, 4)));
  EXPECT_EQ(table.size(), 4U);
  EXPECT_EQ(table.all().size(), 4U);
  EXPECT_EQ(table.find("arm", "numbers", 5), second);
  EXPECT_EQ(table.find("arm", "numbers", 5), second) << "found last";
  EXPECT_EQ(table.find("arm", "numbers", 6), nullptr);
  EXPECT_EQ(table.find("arm", "other", 4), nullptr);
  EXPECT_TRUE(table.remove(*second));
  EXPECT_FALSE(table.remove(*second));
  EXPECT_EQ(table.find("arm", "numbers", 5), nullptr);
  EXPECT_EQ(table.take_below("arm"), (std::vector<End>{first, below}));
  EXPECT_EQ(table.size(), 1U);
  EXPECT_EQ(table.take_all(), std::vector<End>{beside});
  EXPECT_EQ(table.size(), 0U);
}

TEST_F(PipeEndTest, ATableChoosesTheIndexOfANewEnd) {
  PipeTable table;
  EXPECT_EQ(table.choose("arm", "numbers", -1), 1);
  EXPECT_EQ(table.choose("arm", "numbers", 3), 3);
  table.add(make(numbers_member, 3));
  table.add(make(numbers_member, 4));
  EXPECT_EQ(table.choose("arm", "numbers", 3), 5);
  EXPECT_EQ(table.choose("arm", "numbers", 2), 5) << "behind the last one";
  EXPECT_EQ(table.choose("arm", "numbers", 9), 9);
  table.add(make(numbers_member, std::numeric_limits<std::int32_t>::max()));
  EXPECT_EQ(table.choose("arm", "numbers", 3), std::nullopt);
}

// A message with packets for these ends.
class ArrivedMessage {
 public:
  explicit ArrivedMessage(const std::vector<std::pair<std::string, std::uint32_t>>& packets) {
    Writer writer;
    writer.reset(MessageVersion::v4);
    const std::size_t end = writer.position();
    for (auto each = packets.rbegin(); each != packets.rend(); ++each) {
      const double value = each->second;
      write_packet(writer, each->first, each->second, true,
                   [&] { type_of<double>.write(writer, "packet", &value); });
    }
    writer.entry({.type = EntryType::pipe_packet}, static_cast<std::uint32_t>(packets.size()), end);
    writer.message({}, 1);
    bytes_ = writer.copy();
    EXPECT_TRUE(read_message(bytes_, {}, false, message, entry));
  }
  Message message;
  Entry entry;

 private:
  std::vector<std::byte> bytes_;
};

TEST_F(PipeEndTest, PacketsThatArriveAreTakenAcknowledgedAndDelivered) {
  const ArrivedMessage arrived({{"4", 1}, {"5", 1}, {"4", 2}, {"6", 1}});
  const TypeRegistry types;
  PipeArrival arrival(arrived.message, arrived.entry, {}, types, {});
  EXPECT_FALSE(arrival.has_acknowledgements());
  const End end = make(numbers_member, 4);
  std::vector<double> got;
  const Subscription subscription =
      end->on_received([&](const std::shared_ptr<void>& value) { got.push_back(value_of(value)); });
  arrival.take([&](const PipePacket& packet, Decoder&) {
    if (packet.index == 4) return PipeArrival::Taken{end, true};
    return PipeArrival::Taken{nullptr, packet.index == 5};  // somebody else's
  });
  EXPECT_TRUE(got.empty()) << "no user code runs yet";
  EXPECT_TRUE(arrival.has_acknowledgements());
  EXPECT_EQ(arrival.metadata(), "");
  Writer writer;
  writer.reset(MessageVersion::v4);
  EXPECT_EQ(arrival.write_acknowledgements(writer), 3U);
  arrival.deliver();
  EXPECT_EQ(got, (std::vector<double>{1, 2}));
  EXPECT_EQ(side_->closed, 0);
}

// Definitions that were read from a service are gone with the session, and ends may stay.
TEST_F(PipeEndTest, OutlivesTheDefinitionsOfItsMember) {
  std::string name = "frames";
  Member member = pipe<double>("", readonly);
  member.name = name;
  const End end = make(member);
  end->finish();
  name = "gone!!";
  member = {};
  end->on_closed([] { throw std::runtime_error("no"); });
  EXPECT_EQ(log_.get_future().get(), "a function of the pipe `frames` has thrown: no");
  const double value = 1;
  EXPECT_EQ(failure([&] { end->send(&value); }), ErrorCode::read_only_member);
  EXPECT_TRUE(end->may_receive());
}

TEST_F(PipeEndTest, AnEndWhoseQueueIsFullIsClosedWhenAllIsDelivered) {
  const ArrivedMessage arrived({{"4", 1}, {"4", 2}});
  const TypeRegistry types;
  PipeArrival arrival(arrived.message, arrived.entry, {}, types, {});
  const End end = make(numbers_member, 4, true, "arm", true);
  end->set_queue_limit(1, WhenFull::close, 1'000'000);
  arrival.take([&](const PipePacket&, Decoder&) { return PipeArrival::Taken{end, true}; });
  EXPECT_EQ(arrival.metadata(), unreliable_metadata);
  EXPECT_TRUE(end->is_open());
  arrival.deliver();
  EXPECT_FALSE(end->is_open());
  EXPECT_EQ(side_->closed, 1);
}

TEST(PipeArrival, HasLimitsWhereTheyDifferFromThoseOfADecoder) {
  EXPECT_FALSE(PipeArrival::Room{}.is_limited());
  EXPECT_TRUE(PipeArrival::Room{.containers = 100}.is_limited());
  const auto pool = std::make_shared<channel::Pool>(1000, 0);
  EXPECT_TRUE(
      PipeArrival::Room{.account = std::make_shared<channel::Account>(pool, 100)}.is_limited());
}

}  // namespace
}  // namespace rr::endpoint
