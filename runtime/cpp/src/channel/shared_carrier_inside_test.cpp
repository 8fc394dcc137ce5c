// SPDX-License-Identifier: Apache-2.0
// Two sides of one memory in one process, with their sockets.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "runtime/cpp/src/channel/shared_carrier.hpp"

namespace rr::channel {
namespace {

using std::chrono_literals::operator""s;
using std::chrono_literals::operator""us;

constexpr std::size_t carried_ring_size = 4096;

class SharedCarrierTest : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!platform::has_shared_memory()) GTEST_SKIP() << "this system has no shared memory";
    ASSERT_FALSE(platform::make_pair(client_socket_, server_socket_));
    platform::Descriptor handle;
    std::error_code error;
    SharedRings rings = SharedRings::make(carried_ring_size, handle, error);
    ASSERT_TRUE(rings) << error.message();
    memory_ = platform::map_shared_memory(handle, 1 << 20, error);
    client_ = std::make_unique<SharedCarrier>(SharedRings::open(handle, error), false,
                                              client_socket_.get(), 0us);
    server_ = std::make_unique<SharedCarrier>(std::move(rings), true, server_socket_.get(), 0us);
  }

  static std::ptrdiff_t send(SharedCarrier& carrier, std::string_view text) {
    const platform::Buffer piece{reinterpret_cast<const std::byte*>(text.data()), text.size()};
    return carrier.send({&piece, 1});
  }
  static std::string received(SharedCarrier& carrier, bool may_block = false) {
    std::vector<std::byte> room(2 * carried_ring_size);
    const std::ptrdiff_t size = carrier.receive(room, may_block);
    if (size == platform::nothing_now) return "nothing";
    if (size == platform::broken) return "broken";
    return {reinterpret_cast<const char*>(room.data()), static_cast<std::size_t>(size)};
  }
  // Bytes of a bell that nobody has taken.
  static std::ptrdiff_t bells(const platform::Descriptor& socket) {
    std::array<std::byte, 100> room;
    return platform::receive(socket.get(), room, platform::Wait::none);
  }

  platform::Descriptor client_socket_;
  platform::Descriptor server_socket_;
  platform::SharedMemory memory_;
  std::unique_ptr<SharedCarrier> client_;
  std::unique_ptr<SharedCarrier> server_;
};

TEST_F(SharedCarrierTest, CarriesBytesInBothDirections) {
  EXPECT_EQ(send(*client_, "asked"), 5);
  EXPECT_EQ(received(*server_), "asked");
  EXPECT_EQ(send(*server_, "answered"), 8);
  EXPECT_EQ(received(*client_), "answered");
  EXPECT_EQ(received(*client_), "nothing");
  EXPECT_EQ(received(*server_), "nothing");
  Carrier& carrier = *client_;
  EXPECT_EQ(carrier.shared(), client_.get());
}

TEST_F(SharedCarrierTest, PassesMemoriesOfWiresWithBells) {
  const auto make = [](std::uint64_t id) {
    std::error_code error;
    return SlotWriter::make(SlotSizes::for_value(100), id, error);
  };
  const auto one = make(1);
  EXPECT_FALSE(server_->has_slots());
  EXPECT_FALSE(server_->pass_memory(one->handle())) << "the client does not know them";
  server_->use_slots();
  client_->use_slots();
  EXPECT_TRUE(client_->has_slots());
  EXPECT_FALSE(client_->pass_memory(one->handle()));
  EXPECT_TRUE(server_->pass_memory(one->handle()));
  // More than one look takes; bells are among them.
  for (int i = 0; i < 40; ++i) {
    constexpr std::array<std::byte, 1> bell{};
    platform::send(server_socket_.get(), bell);
    EXPECT_TRUE(server_->pass_memory(one->handle())) << i;
  }
  const auto two = make(2);
  EXPECT_TRUE(server_->pass_memory(two->handle()));
  const auto taken = client_->take_slots(2);
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->id(), 2U);
  EXPECT_NE(client_->take_slots(1), nullptr);
  EXPECT_EQ(client_->take_slots(3), nullptr);
  EXPECT_EQ(received(*client_), "nothing");
  EXPECT_TRUE(client_->has_taken_bells());
}

TEST_F(SharedCarrierTest, AReaderOfARingSaysHowFarItIs) {
  std::error_code error;
  server_->use_slots();
  client_->use_slots();
  const auto ring = PipeRingWriter::make(PipeRingSize::for_packet(100), 5, error);
  ASSERT_NE(ring, nullptr);
  const auto holds = server_->draw_holds();
  ASSERT_NE(holds, nullptr);
  ring->put({});
  PipeRingStart start{.id = ring->id(),
                      .position = ring->position(),
                      .place = holds->place(),
                      .turn = 9,
                      .reader = ring->admit().value()};
  EXPECT_EQ(client_->take_ring(start), nullptr) << "it was not passed";
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(server_->pass_memory(ring->handle()));
  EXPECT_EQ(server_->take_ring(start), nullptr);
  const auto reader = client_->take_ring(start);
  ASSERT_NE(reader, nullptr);
  EXPECT_EQ(PipeRingWriter::Steps::cursor(holds->words(), 9), PipeRecord::whole(0));
  EXPECT_TRUE(reader->ask());
  EXPECT_EQ(PipeRingWriter::Steps::asked(holds->words(), 9), 1U);
  start.position = 4;
  EXPECT_EQ(client_->take_ring(start), nullptr) << "no packet can begin there";
  start = {.id = 5, .place = HoldPlaces::count};
  EXPECT_EQ(client_->take_ring(start), nullptr) << "there is no such place";
}

TEST_F(SharedCarrierTest, TheClientSaysWhichSlotsItUses) {
  std::error_code error;
  EXPECT_EQ(server_->draw_holds(), nullptr) << "the client does not know them";
  server_->use_slots();
  client_->use_slots();
  EXPECT_EQ(client_->draw_holds(), nullptr);
  const auto slots = SlotWriter::make(SlotSizes::for_value(100'000), 1, error);
  const auto holds = server_->draw_holds();
  ASSERT_NE(holds, nullptr);
  EXPECT_EQ(server_->draw_holds()->place(), holds->place() + 1);
  slots->add_holds(holds);
  const std::vector<std::byte> items(100'000, std::byte{9});
  const Piece piece{items.data(), items.size(), true};
  ASSERT_TRUE(slots->publish({&piece, 1}, items.size(), 1));
  ASSERT_TRUE(server_->pass_memory(slots->handle()));
  const auto reader = client_->take_slots(1, holds->place());
  ASSERT_NE(reader, nullptr);
  SlotValue value;
  ASSERT_EQ(reader->read(value), SlotReader::Found::value);
  EXPECT_EQ(holds->count(), 1U);
  // The same place for another reader: what the first one uses says nothing any more.
  ASSERT_TRUE(server_->pass_memory(slots->handle()));
  const auto next = client_->take_slots(1, holds->place());
  ASSERT_NE(next, nullptr);
  EXPECT_EQ(holds->count(), 0U);
  SlotValue other;
  ASSERT_EQ(next->read(other), SlotReader::Found::value);
  value = {};
  EXPECT_EQ(holds->count(), 1U);
  ASSERT_TRUE(server_->pass_memory(slots->handle()));
  const auto without = client_->take_slots(1, HoldPlaces::count);
  ASSERT_NE(without, nullptr);
  SlotValue copied;
  ASSERT_EQ(without->read(copied), SlotReader::Found::value);
  EXPECT_TRUE(copied.displaced.empty()) << "there is no such place";
}

TEST_F(SharedCarrierTest, PassesNoMoreMemoriesThanAClientMayLeaveInItsSocket) {
  std::error_code error;
  const auto slots = SlotWriter::make(SlotSizes::for_value(100), 1, error);
  server_->use_slots();
  client_->use_slots();
  for (std::size_t i = 0; i < PassedMemories::most; ++i)
    EXPECT_TRUE(server_->pass_memory(slots->handle())) << i;
  EXPECT_FALSE(server_->pass_memory(slots->handle()));
  EXPECT_FALSE(server_->pass_memory(slots->handle()));
  while (client_->take_slots(1) != nullptr) {
  }
  EXPECT_TRUE(server_->pass_memory(slots->handle())) << "all have been received";
}

TEST_F(SharedCarrierTest, RingsOnceForAServerThatWatches) {
  send(*client_, "one");
  send(*client_, "two");
  EXPECT_EQ(bells(server_socket_), 1);
  EXPECT_EQ(received(*server_), "onetwo");
  send(*client_, "three");  // nobody has said that the server does something else
  EXPECT_EQ(bells(server_socket_), platform::nothing_now);
  EXPECT_EQ(received(*server_), "three");
  EXPECT_FALSE(server_->rest());
  send(*client_, "four");
  EXPECT_EQ(bells(server_socket_), 1);
  EXPECT_TRUE(server_->rest());
}

TEST_F(SharedCarrierTest, TakesTheBellsThatItWasToldOf) {
  send(*client_, "one");
  server_->note_event();
  EXPECT_EQ(received(*server_), "one");
  EXPECT_EQ(bells(server_socket_), platform::nothing_now);
}

TEST_F(SharedCarrierTest, SleepsUntilThereIsSomething) {
  std::thread other([&] {
    EXPECT_EQ(received(*server_, true), "asked");
    send(*server_, "answered");
  });
  send(*client_, "asked");
  std::string answer = "nothing";
  while (answer == "nothing") answer = received(*client_, true);
  EXPECT_EQ(answer, "answered");
  other.join();
  EXPECT_EQ(bells(client_socket_), platform::nothing_now);
}

TEST_F(SharedCarrierTest, AFullRingRingsForRoom) {
  const std::string much(carried_ring_size + 100, 'x');
  EXPECT_EQ(send(*client_, much), static_cast<std::ptrdiff_t>(carried_ring_size));
  EXPECT_EQ(send(*client_, "more"), 0);
  EXPECT_EQ(bells(client_socket_), platform::nothing_now);
  EXPECT_EQ(received(*server_), std::string(carried_ring_size, 'x'));
  EXPECT_EQ(bells(client_socket_), 1);
  EXPECT_EQ(send(*client_, "more"), 4);
  EXPECT_EQ(received(*server_), "more");
}

TEST_F(SharedCarrierTest, WaitsForRoom) {
  const std::string much(carried_ring_size, 'x');
  send(*client_, much);
  std::thread other([&] {
    EXPECT_EQ(received(*server_, true), much);
    EXPECT_EQ(received(*server_, true), "more");
  });
  while (send(*client_, "more") == 0) client_->wait_for_room(Clock::now() + 20s);
  other.join();
}

TEST_F(SharedCarrierTest, WhatWasWrittenBeforeTheEndComesBeforeIt) {
  send(*client_, "last");
  client_socket_ = {};
  server_->note_event(true);
  EXPECT_EQ(received(*server_), "last");
  EXPECT_EQ(received(*server_), "");
  EXPECT_EQ(received(*server_, true), "");
}

TEST_F(SharedCarrierTest, WhoeverSleepsIsToldOfTheEnd) {
  std::thread sleeping([&] {
    std::string text = "nothing";
    while (text == "nothing") text = received(*server_, true);
    EXPECT_EQ(text, "");
  });
  client_socket_ = {};
  server_->interrupt();
  sleeping.join();
}

TEST_F(SharedCarrierTest, TheOtherSideIsToldByWhoeverCloses) {
  std::thread sleeping([&] {
    std::string text = "nothing";
    while (text == "nothing") text = received(*server_, true);
    EXPECT_EQ(text, "");
  });
  platform::shut_down(client_socket_.get());
  client_->interrupt_other();
  sleeping.join();
}

TEST_F(SharedCarrierTest, WaitsForWhatCanBeReceived) {
  const Time begin = Clock::now();
  server_->wait(begin);
  send(*client_, "asked");
  server_->wait(begin + 20s);
  EXPECT_EQ(received(*server_), "asked");
}

TEST_F(SharedCarrierTest, HasNothingOfItsOwnToSend) {
  EXPECT_FALSE(client_->carries_messages());
  EXPECT_FALSE(client_->has_received());
  EXPECT_EQ(client_->unsent(), 0U);
  EXPECT_TRUE(client_->flush());
  client_->set_on_room(nullptr);
  client_->end();
  Frame frame;
  EXPECT_EQ(client_->receive(frame, false), platform::broken) << "it has no messages";
  EXPECT_EQ(send(*client_, "asked"), 5);
  EXPECT_EQ(received(*server_), "asked");
}

TEST_F(SharedCarrierTest, SaysThatBellsWereTaken) {
  EXPECT_FALSE(server_->has_taken_bells());
  send(*client_, "asked");
  server_->note_event();
  EXPECT_EQ(received(*server_), "asked");
  EXPECT_TRUE(server_->has_taken_bells());
  EXPECT_FALSE(server_->has_taken_bells());
  EXPECT_EQ(server_->shared(), server_.get());
}

TEST_F(SharedCarrierTest, AWrongIndexEndsIt) {
  EXPECT_EQ(server_->failure(), "");
  const std::uint64_t wrong = carried_ring_size + 1;
  std::memcpy(memory_.bytes() + 0x100, &wrong, sizeof wrong);  // written by the client
  EXPECT_EQ(received(*server_), "broken");
  EXPECT_NE(server_->failure(), "");

  EXPECT_EQ(client_->failure(), "");
  std::memcpy(memory_.bytes() + 0x140, &wrong, sizeof wrong);  // taken by the server
  EXPECT_EQ(send(*client_, std::string(carried_ring_size, 'x')), platform::broken);
  EXPECT_NE(client_->failure(), "");
}

TEST_F(SharedCarrierTest, SpinsNoLongerThanItMay) {
  SharedCarrier spinning(
      [] {
        platform::Descriptor handle;
        std::error_code error;
        return SharedRings::make(carried_ring_size, handle, error);
      }(),
      true, server_socket_.get(), 50us);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(received(spinning, true), "nothing");
}

}  // namespace
}  // namespace rr::channel
