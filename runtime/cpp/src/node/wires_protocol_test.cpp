// SPDX-License-Identifier: Apache-2.0
// What a service does with the messages of a client that is not ours (07, section 13).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "rr/lock_keeper.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"
#include "runtime/cpp/src/node/testing/wired.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;

// The elements of a packet.
template <class T>
RawClient::Elements packet(TimeSpec time, T value) {
  return [time, value = std::move(value)](Writer& writer) {
    type_of<T>.write(writer, "packet", &value);
    type_of<TimeSpec>.write(writer, "packettime", &time);
    return 2U;
  };
}

template <class T>
RawClient::Elements packet(std::int64_t seconds, T value) {
  return packet(TimeSpec{.seconds = seconds, .nanoseconds = 0}, std::move(value));
}

RawClient::Elements without_time(double value) {
  return [value](Writer& writer) {
    type_of<double>.write(writer, "packet", &value);
    return 1U;
  };
}

constexpr std::uint16_t code(ErrorCode error) { return static_cast<std::uint16_t>(error); }

class WireProtocol : public ::testing::Test {
 protected:
  // Requests are answered in order, so that packets before one have been handled.
  double last_level() {
    const auto answer = client_.ask(EntryType::wire_peek_out_value_req, "wired", "level");
    return answer.error == 0 ? answer.number("packet") : -1;
  }

  WiredPair pair_;
  RawClient client_{pair_.server, "wired"};
};

TEST_F(WireProtocol, PacketsThatDoNotCountAreDroppedInSilence) {
  client_.send(EntryType::wire_packet, "wired", "level", packet(1, 1.0));
  EXPECT_EQ(last_level(), -1);  // not connected
  EXPECT_EQ(client_.ask(EntryType::wire_connect_req, "wired", "level").error, 0);
  client_.send(EntryType::wire_packet, "wired", "level", packet(1000, 10.0));
  EXPECT_EQ(last_level(), 10);
  client_.send(EntryType::wire_packet, "wired", "level", packet(999, 9.0));
  EXPECT_EQ(last_level(), 10);
  client_.send(EntryType::wire_packet, "wired", "level", packet(1000, 9.0));
  EXPECT_EQ(last_level(), 10);
  client_.send(EntryType::wire_packet, "wired", "level", packet(1001, std::string("x")));
  client_.send(EntryType::wire_packet, "wired", "level", without_time(11));
  EXPECT_EQ(last_level(), 10);
  client_.send(EntryType::wire_packet, "wired", "level", packet(1001, 12.0));
  EXPECT_EQ(last_level(), 12);
  EXPECT_EQ(client_.ask(EntryType::wire_connect_req, "wired", "reading").error, 0);
  client_.send(EntryType::wire_packet, "wired", "reading", packet(1, 1.0));
  EXPECT_EQ(last_level(), 12);
  EXPECT_FALSE(pair_.object->reading().out());
}

// Slots are for who shares memory with the service: elsewhere the elements mean nothing.
TEST_F(WireProtocol, SlotsAreNotGivenWhereNoMemoryIsShared) {
  const auto wish = [](const char* name) {
    return [name](Writer& writer) {
      const std::uint32_t woken = 2;
      type_of<std::uint32_t>.write(writer, name, &woken);
      return 1U;
    };
  };
  const auto first =
      client_.ask(EntryType::wire_connect_req, "wired", "level", wish("robdef.slots"));
  EXPECT_EQ(first.error, 0);
  EXPECT_EQ(first.element_count, 0U);
  const auto again =
      client_.ask(EntryType::wire_connect_req, "wired", "level", wish("robdef.slots_again"));
  EXPECT_EQ(again.error, 0);
  EXPECT_EQ(again.element_count, 0U);
  EXPECT_EQ(pair_.object->level().connection_count(), 1U);
}

// A program may rely on nanoseconds that are less than a second (rr/time_spec.hpp).
// Keeps no lock, and counts what it is asked.
class Counting final : public LockKeeper {
 public:
  void keep(LockRequest /*request*/, Answer answer) override { answer(nullptr, false); }
  void check_connect(const ConnectAttempt& /*attempt*/) override { ++asked; }

  std::atomic<int> asked{0};
};

TEST_F(WireProtocol, ALockKeeperIsAskedOnceForAConnectionThatIsAskedForTwice) {
  const auto keeper = std::make_shared<Counting>();
  const Service kept =
      pair_.server.register_service("kept", std::make_shared<Wired>(), {.lock_keeper = keeper});
  RawClient client(pair_.server, "kept");
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(client.ask(EntryType::wire_connect_req, "kept", "level").error, 0);
    EXPECT_EQ(keeper->asked, 1);
  }
}

TEST_F(WireProtocol, TimesOfOthersHaveSoundNanoseconds) {
  constexpr std::int64_t first = std::numeric_limits<std::int64_t>::min();
  constexpr std::int64_t last = std::numeric_limits<std::int64_t>::max();
  const std::pair<TimeSpec, TimeSpec> times[] = {{{first, -1}, {first, 0}},
                                                 {{-5, -1}, {-6, 999'999'999}},
                                                 {{5, -2'147'483'647}, {2, 852'516'353}},
                                                 {{6, 2'147'483'647}, {8, 147'483'647}},
                                                 {{9, 1}, {9, 1}},
                                                 {{last, 1'000'000'000}, {last, 999'999'999}}};
  EXPECT_EQ(client_.ask(EntryType::wire_connect_req, "wired", "level").error, 0);
  for (const auto& [sent, received] : times) {
    client_.send(EntryType::wire_packet, "wired", "level", packet(sent, 1.0));
    EXPECT_EQ(last_level(), 1.0);
    const auto value = pair_.object->level().out();
    ASSERT_TRUE(value);
    EXPECT_EQ(value->time, received) << sent.seconds << " " << sent.nanoseconds;
  }
}

TEST_F(WireProtocol, PacketsToNobodyAreAnsweredWithAnError) {
  const auto member = client_.ask(EntryType::wire_packet, "wired", "nothing", packet(1, 1.0));
  EXPECT_EQ(member.type, EntryType::wire_packet_ret);
  EXPECT_EQ(member.error, code(ErrorCode::member_not_found));
  const auto object = client_.ask(EntryType::wire_packet, "wired.nothing", "level", packet(1, 1.0));
  EXPECT_EQ(object.type, EntryType::wire_packet_ret);
  EXPECT_EQ(object.error, code(ErrorCode::member_not_found));
  EXPECT_EQ(client_.ask(EntryType::wire_connect_req, "wired", "set_level").error,
            code(ErrorCode::member_not_found));
}

TEST_F(WireProtocol, DisconnectingNeedsAConnection) {
  EXPECT_EQ(client_.ask(EntryType::wire_disconnect_req, "wired", "level").error,
            code(ErrorCode::service_error));
  EXPECT_EQ(client_.ask(EntryType::wire_connect_req, "wired", "level").error, 0);
  const auto answer = client_.ask(EntryType::wire_disconnect_req, "wired", "level");
  EXPECT_EQ(answer.type, EntryType::wire_disconnect_ret);
  EXPECT_EQ(answer.error, 0);
  EXPECT_EQ(client_.ask(EntryType::wire_disconnect_req, "wired", "level").error,
            code(ErrorCode::service_error));
}

TEST_F(WireProtocol, ConnectingAgainSucceedsAndIsToldAgain) {
  int told = 0;
  pair_.object->level().on_connect([&](ServedWire<double> served) { served.set_in(++told); });
  for (int i = 1; i <= 2; ++i) {
    client_.send(EntryType::wire_connect_req, "wired", "level");
    const auto value = client_.receive().value();
    EXPECT_EQ(value.type, EntryType::wire_packet);
    EXPECT_EQ(value.number("packet"), i);
    EXPECT_EQ(value.header_metadata, "unreliable\n");
    EXPECT_EQ(value.entry_metadata, "unreliable\n");
    const auto answer = client_.receive().value();
    EXPECT_EQ(answer.type, EntryType::wire_connect_ret);
    EXPECT_EQ(answer.error, 0);
    EXPECT_EQ(answer.header_metadata, "");
  }
  EXPECT_EQ(pair_.object->level().connection_count(), 1U);
}

TEST_F(WireProtocol, TheFarewellOfTheServiceIsMarkedInTheHeader) {
  EXPECT_EQ(client_.ask(EntryType::wire_connect_req, "wired", "level").error, 0);
  pair_.object->level().connections().front().close();
  const auto farewell = client_.receive().value();
  EXPECT_EQ(farewell.type, EntryType::wire_closed);
  EXPECT_EQ(farewell.member, "level");
  EXPECT_EQ(farewell.header_metadata, "unreliable\n");
  EXPECT_EQ(farewell.entry_metadata, "");
  EXPECT_EQ(farewell.element_count, 0U);
  client_.send(EntryType::wire_packet, "wired", "level", packet(1, 1.0));
  EXPECT_EQ(last_level(), -1);
}

TEST_F(WireProtocol, PokesThatAreWrongAreRefused) {
  EXPECT_EQ(
      client_.ask(EntryType::wire_poke_out_value_req, "wired", "level", without_time(1)).error,
      code(ErrorCode::message_element_not_found));
  EXPECT_EQ(
      client_.ask(EntryType::wire_poke_out_value_req, "wired", "level", packet(1, std::string("x")))
          .error,
      code(ErrorCode::data_type_mismatch));
  EXPECT_EQ(
      client_.ask(EntryType::wire_poke_out_value_req, "wired", "reading", packet(1, 1.0)).error,
      code(ErrorCode::read_only_member));
  EXPECT_EQ(client_.ask(EntryType::wire_peek_in_value_req, "wired", "target").error,
            code(ErrorCode::write_only_member));
  EXPECT_EQ(last_level(), -1);
}

TEST_F(WireProtocol, ASlowReaderGetsTheNewestValueAndNoBacklog) {
  EXPECT_EQ(client_.ask(EntryType::wire_connect_req, "wired", "trace").error, 0);
  EXPECT_EQ(client_.ask(EntryType::wire_connect_req, "wired", "level").error, 0);
  // 400 MB, more than the socket takes and than may wait: each value takes the place of the last.
  Array<double> values(5000);
  constexpr int count = 10000;
  for (int i = 1; i <= count; ++i) {
    values.mutate()[0] = i;
    pair_.object->trace().set_in(values);
    pair_.object->level().set_in(i);
  }
  int received = 0;
  double last_trace = 0;
  double last_level = 0;
  while (last_trace < count || last_level < count) {
    const auto answer = client_.receive();
    ASSERT_TRUE(answer);
    ++received;
    if (answer->member == "level") {
      EXPECT_GT(answer->number("packet"), last_level);
      last_level = answer->number("packet");
      continue;
    }
    Decoder decoder(MessageVersion::v2);
    Element element;
    Array<double> trace;
    ASSERT_TRUE(find_element(decoder, answer->elements, answer->element_count, "packet", element));
    ASSERT_TRUE(type_of<Array<double>>.read(decoder, element, &trace));
    EXPECT_GT(trace[0], last_trace);
    last_trace = trace[0];
  }
  EXPECT_LT(received, count / 4);
  EXPECT_FALSE(client_.receive(50));
  pair_.object->level().set_in(0.5);  // and goes on
  EXPECT_EQ(client_.receive().value().number("packet"), 0.5);
}

}  // namespace
}  // namespace rr::testing
