// SPDX-License-Identifier: Apache-2.0
// Sockets, and waiting for them, as the headers promise it on every system.
#include "runtime/cpp/src/platform/sockets.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "runtime/cpp/src/platform/datagrams.hpp"
#include "runtime/cpp/src/platform/interfaces.hpp"
#include "runtime/cpp/src/platform/memory.hpp"
#include "runtime/cpp/src/platform/sleep_word.hpp"
#include "runtime/cpp/src/platform/waiting.hpp"

namespace rr::platform {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using Clock = std::chrono::steady_clock;

Time soon() { return Clock::now() + 20s; }

struct Pair {
  Pair() { error = make_pair(first, second); }
  Descriptor first;
  Descriptor second;
  std::error_code error;
};

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

std::string received(int socket, std::size_t most = 100, Wait wait = Wait::some) {
  std::vector<std::byte> room(most);
  const std::ptrdiff_t size = receive(socket, room, wait);
  if (size < 0) return size == nothing_now ? "nothing now" : "broken";
  return {reinterpret_cast<const char*>(room.data()), static_cast<std::size_t>(size)};
}

Address loopback(std::uint16_t port = 0) { return address_of(parse_ip("127.0.0.1").value(), port); }

TEST(IpAddresses, AreReadAndWritten) {
  EXPECT_EQ(parse_ip("10.0.0.5").value().text(), "10.0.0.5");
  EXPECT_EQ(parse_ip("fe80:0:0::1").value().text(), "fe80::1");
  EXPECT_FALSE(parse_ip("10.0.0"));
  EXPECT_FALSE(parse_ip("fe80::1%eth0"));
  EXPECT_TRUE(parse_ip("fe80::1").value().is_link_local());
  EXPECT_FALSE(parse_ip("fec0::1").value().is_link_local());
  EXPECT_TRUE(parse_ip("127.3.2.1").value().is_loopback());
  EXPECT_TRUE(parse_ip("::1").value().is_loopback());
  EXPECT_FALSE(parse_ip("::2").value().is_loopback());
  EXPECT_TRUE(parse_ip("::ffff:10.0.0.5").value().is_v4_in_v6());
  EXPECT_EQ(parse_ip("::ffff:10.0.0.5").value().as_v4().text(), "10.0.0.5");
}

TEST(Addresses, AreWrittenAsInUrls) {
  EXPECT_EQ(loopback(2355).text(), "127.0.0.1:2355");
  EXPECT_EQ(address_of(parse_ip("::1").value(), 80).text(), "[::1]:80");
  EXPECT_EQ(loopback(2355).port(), 2355);
  EXPECT_EQ(Address().family(), Family::none);
  EXPECT_EQ(look_up("127.0.0.1", LookUp::digits).at(0).family(), Family::v4);
  EXPECT_TRUE(look_up("no digits", LookUp::digits).empty());
  EXPECT_FALSE(local_socket_address(std::string(longest_local_path() + 1, 'a')));
  EXPECT_EQ(local_socket_address("/run/a.sock").value().text(), "/run/a.sock");
}

TEST(Sockets, CarryBytesUntilTheEnd) {
  Pair pair;
  ASSERT_FALSE(pair.error) << pair.error.message();
  EXPECT_EQ(received(pair.second.get(), 100, Wait::none), "nothing now");
  EXPECT_EQ(send(pair.first.get(), bytes_of("hello")), 5);
  EXPECT_EQ(received(pair.second.get()), "hello");
  const std::array<Buffer, 3> buffers{
      {{bytes_of("a").data(), 1}, {bytes_of("bc").data(), 2}, {bytes_of("def").data(), 3}}};
  EXPECT_EQ(send_gathered(pair.first.get(), buffers), 6);
  EXPECT_EQ(received(pair.second.get(), 6, Wait::all), "abcdef");
  shut_down_sending(pair.first.get());
  EXPECT_EQ(received(pair.second.get()), "");
  EXPECT_EQ(send(pair.second.get(), bytes_of("back")), 4);
  EXPECT_EQ(received(pair.first.get()), "back");
}

TEST(Sockets, AReceiveThatWaitsIsFilledOrEndsInTime) {
  Pair pair;
  ASSERT_FALSE(pair.error);
  std::thread sender([&] {
    send(pair.first.get(), bytes_of("abc"));
    std::this_thread::sleep_for(20ms);
    send(pair.first.get(), bytes_of("def"));
  });
  EXPECT_EQ(received(pair.second.get(), 6, Wait::all), "abcdef");
  sender.join();
  set_receive_timeout(pair.second.get(), 30ms);
  const auto begin = Clock::now();
  EXPECT_EQ(received(pair.second.get()), "nothing now");
  EXPECT_GE(Clock::now() - begin, 25ms);
}

TEST(Sockets, NeverWaitForRoom) {
  Pair pair;
  ASSERT_FALSE(pair.error);
  const std::vector<std::byte> much(1 << 20);
  std::size_t sent = 0;
  std::ptrdiff_t size = 0;
  while ((size = send(pair.first.get(), much)) > 0 && sent < (1U << 30)) {
    sent += static_cast<std::size_t>(size);
  }
  EXPECT_EQ(size, nothing_now);
  EXPECT_FALSE(wait_for(pair.first.get(), ready::room, Clock::now() + 10ms));
  std::vector<std::byte> room(1 << 20);
  while (sent != 0) {
    size = receive(pair.second.get(), room, Wait::some);
    ASSERT_GT(size, 0);
    sent -= static_cast<std::size_t>(size);
  }
  EXPECT_TRUE(wait_for(pair.first.get(), ready::room, soon()));
  EXPECT_EQ(send(pair.first.get(), bytes_of("x")), 1);
}

TEST(Sockets, ConnectToOneThatListens) {
  std::error_code error;
  const Descriptor listening = listen_at(loopback(), error);
  ASSERT_TRUE(listening) << error.message();
  EXPECT_FALSE(accept_one(listening.get(), error));
  EXPECT_EQ(error, std::errc::operation_would_block) << error.message();
  Descriptor socket;
  EXPECT_NE(begin_connect(local_address(listening.get()), socket, error), Connecting::failed);
  ASSERT_TRUE(wait_for(socket.get(), ready::room, soon()));
  EXPECT_FALSE(connect_result(socket.get()));
  ASSERT_TRUE(wait_for(listening.get(), ready::input, soon()));
  const Descriptor accepted = accept_one(listening.get(), error);
  ASSERT_TRUE(accepted);
  EXPECT_EQ(remote_address(accepted.get()).text(), local_address(socket.get()).text());
  set_stream_options(accepted.get());
  EXPECT_EQ(send(socket.get(), bytes_of("hello")), 5);
  EXPECT_EQ(received(accepted.get()), "hello");
  EXPECT_FALSE(listen_at(local_address(listening.get()), error));
  EXPECT_EQ(error, std::errc::address_in_use) << error.message();
}

TEST(Sockets, SayThatNobodyListens) {
  std::error_code error;
  Address nowhere;
  {
    const Descriptor listening = listen_at(loopback(), error);
    nowhere = local_address(listening.get());
  }
  Descriptor socket;
  if (begin_connect(nowhere, socket, error) != Connecting::failed) {
    ASSERT_TRUE(wait_for(socket.get(), ready::room, soon()));
    error = connect_result(socket.get());
  }
  EXPECT_EQ(error, std::errc::connection_refused) << error.message();
  EXPECT_FALSE(error.message().empty());
}

TEST(Sockets, AreShutDownForThoseThatWait) {
  Pair pair;
  ASSERT_FALSE(pair.error);
  set_receive_timeout(pair.second.get(), 1s);
  std::thread waiting([&] { EXPECT_NE(received(pair.second.get()), "broken"); });
  std::this_thread::sleep_for(20ms);
  shut_down(pair.first.get());
  waiting.join();
  EXPECT_EQ(received(pair.second.get()), "");
}

TEST(Waiting, FindsWhichOfSeveralHasInput) {
  Pair one;
  Pair other;
  send(other.first.get(), bytes_of("x"));
  std::array<Awaited, 3> wanted{
      {{one.second.get(), ready::input}, {-1, ready::input}, {other.second.get(), ready::input}}};
  EXPECT_TRUE(wait_for_any(wanted, soon()));
  EXPECT_EQ(wanted[0].found, 0U);
  EXPECT_EQ(wanted[1].found, 0U);
  EXPECT_EQ(wanted[2].found, ready::input);
  std::array<Awaited, 1> never{{{one.second.get(), ready::input}}};
  EXPECT_FALSE(wait_for_any(never, Clock::now() + 5ms));
  EXPECT_FALSE(wait_for_any({}, Clock::now() + 1ms));
}

TEST(Waiting, ABellIsHeardFromThenOn) {
  std::error_code error;
  const Bell bell(error);
  ASSERT_FALSE(error) << error.message();
  EXPECT_FALSE(wait_for(bell.descriptor(), ready::input, Clock::now() + 5ms));
  std::thread ringer([&] { bell.ring(); });
  EXPECT_TRUE(wait_for(bell.descriptor(), ready::input, soon()));
  EXPECT_TRUE(wait_for(bell.descriptor(), ready::input, soon()));
  ringer.join();
}

TEST(SleepWords, WakeOneThatSleepsAndNoticeChanges) {
  SleepWord word{1};
  EXPECT_TRUE(sleep_on(word, 0, Time::max()));
  EXPECT_FALSE(sleep_on(word, 1, Clock::now() + 5ms));
  std::thread waker([&] {
    word = 2;
    wake(&word);
  });
  while (word == 1) EXPECT_TRUE(sleep_on(word, 1, soon()));
  waker.join();
}

TEST(Datagrams, ComeWithTheAddressOfTheSender) {
  std::error_code error;
  const Descriptor ear = open_datagrams(loopback(), std::nullopt, error);
  ASSERT_TRUE(ear) << error.message();
  const Descriptor mouth = open_datagrams(loopback(), std::nullopt, error);
  ASSERT_TRUE(mouth) << error.message();
  std::array<char, 16> room{};
  Address sender;
  EXPECT_EQ(receive_datagram(ear.get(), room, sender), nothing_now);
  send_datagram(mouth.get(), "packet", local_address(ear.get()));
  ASSERT_TRUE(wait_for(ear.get(), ready::input, soon()));
  EXPECT_TRUE(has_datagram(ear.get()));
  ASSERT_EQ(receive_datagram(ear.get(), room, sender), 6);
  EXPECT_EQ(std::string_view(room.data(), 6), "packet");
  EXPECT_EQ(sender.text(), local_address(mouth.get()).text());
}

TEST(Interfaces, HaveTheLoopbackOne) {
  bool has_loopback = false;
  for (const LocalAddress& address : local_addresses()) {
    has_loopback = has_loopback || (address.is_loopback() && !address.interface.empty());
  }
  EXPECT_TRUE(has_loopback);
}

TEST(Memory, IsZeroAndGivenBackFromItsEnd) {
  const std::size_t size = 64 * page_size;
  std::byte* const block = map_pages(size);
  ASSERT_NE(block, nullptr);
  EXPECT_EQ(block[size - 1], std::byte{0});
  std::memset(block, 1, size);
  unmap_pages(block, size, size / 2);
  EXPECT_EQ(block[size / 2 - 1], std::byte{1});
  unmap_pages(block, size / 2, 0);
}

}  // namespace
}  // namespace rr::platform
