// SPDX-License-Identifier: Apache-2.0
// Ends of wires without a network, and the table of a session.
#include <gtest/gtest.h>

#include <cstddef>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "runtime/cpp/src/channel/wire_slots.hpp"
#include "runtime/cpp/src/endpoint/subscription.hpp"
#include "runtime/cpp/src/endpoint/testing/fake_connection.hpp"
#include "runtime/cpp/src/endpoint/wire_end.hpp"
#include "runtime/cpp/src/endpoint/wire_table.hpp"
#include "runtime/cpp/src/endpoint/wire_values.hpp"

namespace rr::endpoint {
namespace {

using std::chrono_literals::operator""h;
using std::chrono_literals::operator""ms;
using rr::testing::FakeConnection;

constexpr Member position = wire<double>("position");

class FakeEnd final : public WireEnd::State {
 public:
  FakeEnd(std::shared_ptr<Core> core, std::string path)
      : State(std::move(core), std::move(path), position) {}

  void close() override {
    if (begin_close()) finish_now();
  }
  mutable FakeConnection fake;
  /// What look() finds; empty: nothing.
  std::vector<std::byte> slot{};
  channel::Time published{};
  int awaited = 0;                         ///< calls of on_awaited()
  std::shared_ptr<const double> to_all{};  ///< sent to all
  SenderTime time_to_all = 0;
  using State::is_awaited;

 private:
  void look() override {
    if (slot.empty()) return;
    const std::vector<std::byte> bytes = std::exchange(slot, {});
    channel::SlotValue value;
    value.bytes = bytes;
    value.published = published;
    take_slot(value, *core().types(), false);
  }
  void on_awaited() override { ++awaited; }
  [[nodiscard]] std::shared_ptr<const void> sent_to_all(SenderTime& time) const override {
    time = time_to_all;
    return to_all;
  }
  [[nodiscard]] channel::Connection& connection() const override { return fake; }
  void check_sending() const override {}
  SenderTime draw_time() override { return ++time_; }
  void transmit(Writer& writer, const channel::Newest& newest) override {
    writer.entry({.type = EntryType::wire_packet}, wire_elements, 0);
    writer.message({}, 1);
    fake.send_newest(writer, newest, {});
  }

  SenderTime time_ = 0;
};

// A message with a value.
class ArrivedValue {
 public:
  ArrivedValue(double value, TimeSpec time) {
    begin();
    write_wire_value(writer_, type_of<double>, &value);
    end(time);
  }
  ArrivedValue(const std::string& value, TimeSpec time) {
    begin();
    write_wire_value(writer_, type_of<std::string>, &value);
    end(time);
  }
  Message message;
  Entry entry;

 private:
  void begin() { writer_.reset(MessageVersion::v4); }
  void end(TimeSpec time) {
    write_wire_time(writer_, time);
    writer_.entry({.type = EntryType::wire_packet}, wire_elements, 0);
    writer_.message({}, 1);
    bytes_ = writer_.copy();
    EXPECT_TRUE(read_message(bytes_, {}, false, message, entry));
  }
  Writer writer_;
  std::vector<std::byte> bytes_;
};

class WireEndTest : public ::testing::Test {
 protected:
  WireEndTest() { core_->start(); }
  // Not by the last work that is posted, on a thread of its own.
  ~WireEndTest() override { core_->stop(); }

  std::shared_ptr<FakeEnd> make(std::string path = "arm") {
    return std::make_shared<FakeEnd>(core_, std::move(path));
  }
  static double value_of(const std::shared_ptr<const void>& value) {
    return *static_cast<const double*>(value.get());
  }
  // The newest value that counts; -1 for none.
  double received() {
    const auto value = end_->received(time_);
    return value ? value_of(value) : -1;
  }
  template <class Value>
  void arrive(const Value& value, TimeSpec time) {
    const ArrivedValue arrived(value, time);
    end_->take(arrived.message, arrived.entry, {}, types_, deferred_);
  }

  const std::shared_ptr<Core> core_ = std::make_shared<Core>([] {
    NodeOptions options;
    options.max_threads = 4;
    return options;
  }());
  const TypeRegistry types_;
  const std::shared_ptr<FakeEnd> end_ = make();
  channel::DeferredCallbacks deferred_;
  TimeSpec time_;
};

TEST_F(WireEndTest, IsOfAMember) {
  EXPECT_EQ(end_->path(), "arm");
  EXPECT_EQ(&end_->member(), &position);
  EXPECT_EQ(end_->client(), 0U);
}

TEST_F(WireEndTest, SendsOnceBothSidesKnowOfIt) {
  const double value = 1.5;
  EXPECT_FALSE(end_->is_open());
  EXPECT_THROW(end_->send(&value), Error);
  EXPECT_EQ(end_->sent(time_), nullptr);
  end_->open();
  EXPECT_TRUE(end_->is_open());
  end_->send(&value);
  end_->send(&value);
  ASSERT_EQ(end_->fake.newest.size(), 2U);
  EXPECT_LT(end_->fake.newest[0].time, end_->fake.newest[1].time);
  EXPECT_EQ(value_of(end_->sent(time_)), 1.5);
  EXPECT_EQ(time_, (TimeSpec{0, 2}));
}

TEST_F(WireEndTest, KeepsTheNewestByItsSendersTime) {
  EXPECT_EQ(received(), -1);
  arrive(1.0, {5, 0});
  EXPECT_EQ(received(), 1);
  EXPECT_EQ(time_, (TimeSpec{5, 0}));
  arrive(2.0, {4, 0});
  EXPECT_EQ(received(), 1) << "an older one";
  arrive(3.0, {5, 1});
  EXPECT_EQ(received(), 3);
}

TEST_F(WireEndTest, ValuesExpire) {
  end_->set_lifespan(1ms);
  arrive(1.0, {1, 0});
  const auto begin = channel::Clock::now();
  while (channel::Clock::now() - begin <= 1ms) {
  }
  EXPECT_EQ(received(), -1);
  EXPECT_FALSE(end_->wait_received(0ms));
  EXPECT_GE(end_->fake.expected, 1) << "the reactor is to read";
}

TEST_F(WireEndTest, AValueMayBeLookedFor) {
  const ArrivedValue one(1.0, {1, 0});
  end_->slot.assign(one.entry.elements.begin(), one.entry.elements.end());
  end_->published = channel::Clock::now();
  EXPECT_EQ(received(), 1);
  arrive(3.0, {3, 0});
  const ArrivedValue two(2.0, {2, 0});
  end_->slot.assign(two.entry.elements.begin(), two.entry.elements.end());
  EXPECT_EQ(received(), 3) << "an older one comes too late";
  const ArrivedValue four(4.0, {4, 0});
  end_->slot.assign(four.entry.elements.begin(), four.entry.elements.end());
  end_->published = channel::Clock::now() - 1h;
  EXPECT_TRUE(end_->wait_received(0ms));
  EXPECT_EQ(received(), 4);
  end_->set_lifespan(1000ms);
  EXPECT_EQ(received(), -1) << "it was published long ago";
}

TEST_F(WireEndTest, WhatIsNoValueIsNotTakenFromASlot) {
  std::atomic<int> refused{0};
  end_->on_refused([&](const Error&) { ++refused; });
  end_->slot.assign(100, std::byte{0xFF});
  EXPECT_EQ(received(), -1);
  const ArrivedValue text(std::string("text"), {1, 0});
  end_->slot.assign(text.entry.elements.begin(), text.entry.elements.end());
  EXPECT_EQ(received(), -1);
  const auto deadline = channel::Clock::now() + 1h;
  while (refused != 2 && channel::Clock::now() < deadline) std::this_thread::yield();
  EXPECT_EQ(refused, 2);
}

TEST_F(WireEndTest, SaysWhenValuesAreAwaited) {
  EXPECT_FALSE(end_->is_awaited());
  Subscription subscription = end_->on_received([](const void*, const TimeSpec&) {});
  EXPECT_EQ(end_->awaited, 1);
  EXPECT_TRUE(end_->is_awaited());
  subscription.disconnect();
  EXPECT_FALSE(end_->is_awaited());
  EXPECT_FALSE(end_->wait_received(0ms));
  EXPECT_EQ(end_->awaited, 2);
}

TEST_F(WireEndTest, WhatWasSentToAllWasSentHereToo) {
  const double value = 1.5;
  end_->open();
  end_->send(&value);
  end_->to_all = std::make_shared<const double>(2.5);
  end_->time_to_all = 5;
  EXPECT_EQ(value_of(end_->sent(time_)), 2.5);
  EXPECT_EQ(time_, (TimeSpec{0, 5}));
  end_->time_to_all = 1;
  end_->to_all = std::make_shared<const double>(0.5);
  EXPECT_EQ(value_of(end_->sent(time_)), 1.5) << "that was later";
}

TEST_F(WireEndTest, AThreadWaitsForAValue) {
  std::future<bool> found = std::async(std::launch::async, [&] { return end_->wait_received(1h); });
  arrive(1.0, {1, 0});
  EXPECT_TRUE(found.get());
  EXPECT_TRUE(end_->wait_received(0ms));
}

TEST_F(WireEndTest, FunctionsSeeTheNewestValueUntilTheyAreDisconnected) {
  std::promise<double> first;
  std::atomic<int> calls{0};
  Subscription subscription = end_->on_received([&](const void* value, const TimeSpec&) {
    if (++calls == 1) first.set_value(*static_cast<const double*>(value));
  });
  arrive(7.0, {1, 0});
  EXPECT_EQ(first.get_future().get(), 7);
  subscription.disconnect();
  const int before = calls;
  arrive(8.0, {2, 0});
  std::promise<void> behind;
  core_->reactor().post([&] { behind.set_value(); });
  behind.get_future().get();
  EXPECT_EQ(calls, before);
}

TEST_F(WireEndTest, AValueOfAnotherTypeIsToldAndDropped) {
  std::vector<ErrorCode> refused;
  arrive(std::string("text"), {1, 0});
  EXPECT_TRUE(deferred_.empty()) << "nobody wants to know";
  end_->on_refused([&](const Error& why) { refused.push_back(why.code()); });
  EXPECT_EQ(refused.size(), 1U) << "one had come already";
  arrive(std::string("text"), {2, 0});
  ASSERT_EQ(deferred_.size(), 1U);
  deferred_.front()();
  EXPECT_EQ(refused, (std::vector<ErrorCode>(2, ErrorCode::data_type_mismatch)));
  EXPECT_EQ(received(), -1);
}

TEST_F(WireEndTest, EndsOnce) {
  std::promise<void> told;
  end_->on_closed([&] { told.set_value(); });
  end_->open();
  end_->finish(deferred_);
  for (const auto& later : deferred_) later();
  told.get_future().get();
  deferred_.clear();
  end_->finish(deferred_);
  EXPECT_TRUE(deferred_.empty());
  EXPECT_FALSE(end_->is_open());
  end_->open();
  EXPECT_FALSE(end_->is_open());
  arrive(1.0, {1, 0});
  EXPECT_EQ(received(), -1) << "too late";
  std::promise<void> late;
  end_->on_closed([&] { late.set_value(); });
  late.get_future().get();
}

TEST_F(WireEndTest, ATableHasOneEndForEachObjectAndMember) {
  WireTable table;
  const auto below = make("arm.tool");
  const auto beside = make("arms");
  EXPECT_EQ(table.find("arm", "position"), nullptr);
  for (const auto& end : {end_, below, beside}) EXPECT_EQ(table.add(end), WireTable::Added::yes);
  EXPECT_EQ(table.add(make("arm")), WireTable::Added::exists);
  EXPECT_EQ(table.size(), 3U);
  EXPECT_EQ(table.all().size(), 3U);
  EXPECT_EQ(table.find("arm", "position"), end_);
  EXPECT_EQ(table.find("arm", "speed"), nullptr);
  table.remove(*make("arm"));  // not the one that is there
  EXPECT_EQ(table.find("arm", "position"), end_);
  const auto denied = [&](const WireEnd::State& end) { return &end != end_.get(); };
  EXPECT_EQ(table.take_below("arm", denied), std::vector<WireTable::End>{below});
  EXPECT_EQ(table.take_below("arm"), std::vector<WireTable::End>{end_});
  table.remove(*beside);
  EXPECT_EQ(table.size(), 0U);
  EXPECT_EQ(table.add(end_), WireTable::Added::yes);
  EXPECT_EQ(table.take_all(), std::vector<WireTable::End>{end_});
  EXPECT_EQ(table.add(end_), WireTable::Added::ended);
}

// A function of the program that counts its calls.
class Counting final : public Subscription::Handler {
 public:
  template <class Run>
  void call(const Run& function) {
    run(function);
  }
  int dropped = 0;

 private:
  void drop() override { ++dropped; }
};

TEST(SubscriptionHandler, IsNotCalledAfterItWasDisconnected) {
  Counting handler;
  int calls = 0;
  EXPECT_TRUE(handler.is_connected());
  handler.call([&] { ++calls; });
  handler.disconnect();
  handler.disconnect();
  EXPECT_FALSE(handler.is_connected());
  handler.call([&] { ++calls; });
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(handler.dropped, 1);
}

TEST(SubscriptionHandler, MayDisconnectItselfAndIsDroppedWhenItReturns) {
  Counting handler;
  handler.call([&] {
    handler.disconnect();
    EXPECT_EQ(handler.dropped, 0);
  });
  EXPECT_EQ(handler.dropped, 1);
}

}  // namespace
}  // namespace rr::endpoint
