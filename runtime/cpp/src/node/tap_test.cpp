// SPDX-License-Identifier: Apache-2.0
// Recordings of nodes, and what is left of them when something goes wrong.
#include "rr/tap.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <initializer_list>
#include <map>
#include <set>
#include <thread>

#include "rr/message_tree.hpp"
#include "rr/recording.hpp"
#include "runtime/cpp/src/node/testing/all_members.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/recordings.hpp"

namespace rr::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Tapping : public ::testing::Test {
 protected:
  RecordingFolder folder_;
};

// A client waits half a second for the answer to its last request, and no longer: on a busy machine
// the service may give one that nobody hears.
bool is_last_answer(const std::vector<std::byte>& bytes) {
  MessageTree message;
  return read_tree(bytes, message) && !message.entries.empty() &&
         message.entries[0].type == EntryType::disconnect_client_ret;
}

// Nor does a client that has left hear that the service ends.
bool is_unheard(const std::vector<std::byte>& bytes) {
  MessageTree message;
  return is_last_answer(bytes) || (read_tree(bytes, message) && !message.entries.empty() &&
                                   message.entries[0].type == EntryType::service_closed);
}

Recorded without_unheard(Recorded recorded) {
  for (auto& [key, messages] : recorded.messages) std::erase_if(messages, is_unheard);
  return recorded;
}

TEST_F(Tapping, BothSidesKeepTheSameMessagesOfAllKindsOfMembers) {
  for (const int form : {2, 4, 5}) {
    const auto server_tap = std::make_shared<Recorder>(folder_ / "server");
    const auto client_tap = std::make_shared<Recorder>(folder_ / "client");
    const Offer offer{.message_v4 = form != 2, .string_table = form == 5};
    {
      Node server({.name = "server", .server_offer = offer, .tap = server_tap});
      Node client({.name = "client", .client_offer = offer, .tap = client_tap});
      AllMembers members(server);
      members.use(client, members.port());
    }
    server_tap->close();
    client_tap->close();
    const Recorded server = read_recorded(folder_ / "server");
    const Recorded client = read_recorded(folder_ / "client");
    EXPECT_EQ(server.end, RecordingEnd::complete);
    EXPECT_EQ(client.end, RecordingEnd::complete);
    EXPECT_EQ(client.opened.size(), AllMembers::connections);
    EXPECT_EQ(server.opened.size(), AllMembers::connections);
    EXPECT_EQ(client.closed.size(), AllMembers::connections);
    EXPECT_EQ(server.closed.size(), AllMembers::connections);
    EXPECT_EQ(difference_of_messages(without_unheard(client), without_unheard(server)), "");
    EXPECT_GT(client_tap->messages(), 80U);

    std::set<EntryType> types;
    for (const auto& [key, messages] : client.messages) {
      for (const auto& bytes : messages) {
        MessageTree tree;
        ASSERT_TRUE(read_tree(bytes, tree));
        EXPECT_EQ(write_tree(tree), bytes);
        for (const EntryTree& entry : tree.entries) types.insert(entry.type);
      }
    }
    for (const EntryType type :
         {EntryType::stream_op, EntryType::property_get_req, EntryType::property_set_req,
          EntryType::function_call_req, EntryType::generator_next_req, EntryType::event_req,
          EntryType::pipe_packet, EntryType::pipe_packet_ret, EntryType::callback_call_req,
          EntryType::callback_call_ret, EntryType::wire_packet, EntryType::wire_peek_in_value_req,
          EntryType::memory_read, EntryType::memory_write, EntryType::disconnect_client}) {
      EXPECT_THAT(types, Contains(type));
    }
    for (const auto& [number, agreed] : client.agreed) {
      EXPECT_EQ(agreed.client_name, "client");
      EXPECT_EQ(agreed.service_name, "server");
      EXPECT_EQ(agreed.version, form == 2 ? MessageVersion::v2 : MessageVersion::v4);
      EXPECT_EQ(agreed.standard_strings, form == 5);
    }
    EXPECT_THAT(server.definitions, Contains(std::string(rr_store_definition.text)));
    EXPECT_THAT(client.definitions, Contains(std::string(rr_store_definition.text)));
  }
}

TEST_F(Tapping, OneRecorderServesManyConnectionsAndNodesAtOnce) {
  const auto tap = std::make_shared<Recorder>(folder_ / "both");
  constexpr int clients = 8;
  constexpr int calls = 100;
  {
    Pair pair({.tap = tap}, {.tap = tap});
    std::vector<std::thread> threads;
    for (int i = 0; i < clients; ++i) {
      threads.emplace_back([&] {
        auto counter = pair.connect();
        for (int call = 0; call < calls; ++call) counter->add(call, 1);
      });
    }
    for (std::thread& thread : threads) thread.join();
  }
  tap->close();
  const Recorded recorded = read_recorded(folder_ / "both");
  EXPECT_EQ(recorded.opened.size(), 2U * clients);
  EXPECT_EQ(recorded.closed.size(), 2U * clients);
  EXPECT_EQ(recorded.message_count, tap->messages());
  std::multiset<std::vector<std::byte>> of_clients;
  std::multiset<std::vector<std::byte>> of_server;
  for (const auto& [key, messages] : recorded.messages) {
    const bool is_client = recorded.opened.at(key.first).side == TapSide::client;
    for (const std::vector<std::byte>& message : messages) {
      if (!is_last_answer(message)) (is_client ? of_clients : of_server).insert(message);
    }
  }
  EXPECT_GE(of_clients.size(), std::size_t{2} * clients * calls);
  EXPECT_EQ(of_clients, of_server);
}

TEST_F(Tapping, TimesDoNotGoBackAndRequestsComeBeforeTheirAnswers) {
  const auto tap = std::make_shared<Recorder>(folder_ / "times");
  {
    Pair pair({}, {.tap = tap});
    auto counter = pair.connect();
    for (int i = 0; i < 50; ++i) counter->add(i, 1);
  }
  tap->close();
  Recording recording(folder_ / "times");
  std::chrono::nanoseconds before{};
  std::set<std::uint32_t> asked;
  for (Record record; recording.next(record);) {
    EXPECT_GE(record.time, before);
    before = record.time;
    const auto* message = std::get_if<RecordedMessage>(&record.what);
    if (message == nullptr) continue;
    MessageTree tree;
    ASSERT_TRUE(read_tree(message->bytes, tree));
    for (const EntryTree& entry : tree.entries) {
      if (entry.type == EntryType::function_call_req) asked.insert(entry.request_id);
      if (entry.type == EntryType::function_call_res) {
        EXPECT_THAT(asked, Contains(entry.request_id));
      }
    }
  }
  EXPECT_EQ(asked.size(), 50U);
}

TEST_F(Tapping, AValueThatANewerOneReplacedIsMarked) {
  const auto tap = std::make_shared<Recorder>(folder_ / "newest");
  {
    Node server({.tap = tap});
    const auto wired = std::make_shared<Wired>();
    server.register_service("wired", wired);
    const std::uint16_t port = server.listen_tcp(0, "127.0.0.1");
    // Somebody who asks for the values and then reads nothing.
    StuckWireClient client(port, server.id());
    ASSERT_TRUE(eventually([&] { return wired->trace().connection_count() == 1; }));
    for (int i = 0; i < 400; ++i) wired->trace().set_in(Array<double>(20'000));
  }
  tap->close();
  const Recorded recorded = read_recorded(folder_ / "newest");
  EXPECT_GT(recorded.replaced.size(), 10U);
  for (const std::uint64_t number : recorded.replaced) EXPECT_LT(number, recorded.message_count);
}

TEST_F(Tapping, AFileThatWasCutOffIsReadUpToThere) {
  const std::string path = folder_ / "whole";
  std::vector<std::uint64_t> ends;
  {
    Recorder tap(path);
    const std::uint32_t number = tap.opened({});
    tap.agreed(number, {});
    for (const auto size : std::initializer_list<std::size_t>{1, 20, 100}) {
      const std::vector<std::byte> bytes(size, std::byte{0x5A});
      const Piece piece{bytes.data(), bytes.size()};
      tap.message(number, Direction::to_client, {&piece, 1});
    }
    tap.definition("service a\n");
    tap.closed(number, ErrorCode::connection_error, "gone");
  }
  {
    Recording recording(path);
    ends.push_back(recording.position());
    for (Record record; recording.next(record);) ends.push_back(recording.position());
    EXPECT_EQ(recording.end(), RecordingEnd::complete);
    EXPECT_EQ(recording.position(), std::filesystem::file_size(path));
  }
  ASSERT_EQ(ends.size(), 8U);
  const std::string bytes = read_file(path);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    write_file(folder_ / "cut", bytes.substr(0, size));
    if (size < ends.front()) {
      EXPECT_EQ(error_of([&] { Recording(folder_ / "cut"); }).code(), ErrorCode::data_type_error);
      continue;
    }
    Recording recording(folder_ / "cut");
    std::size_t count = 0;
    for (Record record; recording.next(record);) ++count;
    const auto whole = std::upper_bound(ends.begin(), ends.end(), size) - ends.begin() - 1;
    EXPECT_EQ(count, static_cast<std::size_t>(whole)) << size;
    const bool is_boundary = std::find(ends.begin(), ends.end(), size) != ends.end();
    EXPECT_EQ(recording.end(), is_boundary ? RecordingEnd::open : RecordingEnd::cut_off) << size;
    EXPECT_EQ(recording.position(), ends[static_cast<std::size_t>(whole)]);
  }
}

TEST_F(Tapping, EachByteThatWasChangedIsNoticed) {
  const std::string path = folder_ / "whole";
  {
    Recorder tap(path);
    const std::uint32_t number = tap.opened({TapSide::client, "a", "b"});
    tap.agreed(number, {.client_name = "one", .service_name = "two"});
    const std::vector<std::byte> bytes(30, std::byte{0x5A});
    const Piece piece{bytes.data(), bytes.size()};
    tap.message(number, Direction::to_client, {&piece, 1});
    tap.closed(number, ErrorCode::none, "");
  }
  const auto whole = read_recorded(path);
  const std::string bytes = read_file(path);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int change : {0x01, 0x80, 0xFF}) {
      std::string changed = bytes;
      changed[at] = static_cast<char>(changed[at] ^ change);
      write_file(folder_ / "changed", changed);
      if (at < 32) {
        EXPECT_EQ(error_of([&] { Recording(folder_ / "changed"); }).code(),
                  ErrorCode::data_type_error);
        continue;
      }
      Recording recording(folder_ / "changed");
      std::size_t count = 0;
      for (Record record; recording.next(record);) ++count;
      EXPECT_LT(count, 5U);
      EXPECT_THAT(recording.end(), ::testing::AnyOf(RecordingEnd::damaged, RecordingEnd::cut_off))
          << at;
    }
  }
}

TEST_F(Tapping, AFileThatIsNoRecordingIsRefused) {
  EXPECT_EQ(error_of([&] { Recording(folder_ / "nowhere"); }).code(), ErrorCode::io_error);
  EXPECT_EQ(error_of([&] { Recording(folder_ / ""); }).code(), ErrorCode::io_error);
  for (const std::string& text : {std::string(), std::string("RRTAPE\x1a\n", 8),
                                  std::string(1000, '\0'), std::string(1000, '\xFF')}) {
    write_file(folder_ / "other", text);
    const Error error = error_of([&] { Recording(folder_ / "other"); });
    EXPECT_EQ(error.code(), ErrorCode::data_type_error);
    EXPECT_THAT(error.message(), HasSubstr("other"));
  }
  EXPECT_EQ(error_of([&] { Recorder(folder_ / "nowhere/file"); }).code(), ErrorCode::io_error);
}

// A disk that does not take anything, for as long as a test wants: a named pipe.
class SlowDisk {
 public:
  explicit SlowDisk(std::string path) : path_(std::move(path)) {
    if (::mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error("no named pipe");
    reader_ = ::open(path_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  }
  ~SlowDisk() {
    if (thread_.joinable()) thread_.join();
    ::close(reader_);
  }
  // The end that is written to, for whoever closes it.
  [[nodiscard]] int open_writer() const { return ::open(path_.c_str(), O_WRONLY | O_CLOEXEC); }
  // Takes everything from now on, until the writer has closed.
  void take_all(const std::string& copy) {
    thread_ = std::thread([this, copy] {
      std::ofstream stream(copy, std::ios::binary);
      ::fcntl(reader_, F_SETFL, 0);
      char buffer[4096];
      for (ssize_t size = 0; (size = ::read(reader_, buffer, sizeof buffer)) > 0;) {
        stream.write(buffer, size);
      }
    });
  }

 private:
  const std::string path_;
  int reader_ = -1;
  std::thread thread_;
};

TEST_F(Tapping, WhatDoesNotFitTheBufferIsLeftOutAndCounted) {
  std::uint64_t lost = 0;
  std::uint64_t kept = 0;
  constexpr std::uint64_t told = 400;
  {
    SlowDisk disk(folder_ / "disk");
    Recorder tap(disk.open_writer(),
                 {.buffer_size = 4096, .when_full = RecorderOptions::WhenFull::drop});
    const std::vector<std::byte> bytes(1000);
    const Piece piece{bytes.data(), bytes.size()};
    const std::uint32_t number = tap.opened({});
    for (std::uint64_t i = 0; i < told; ++i) {
      const std::uint64_t given = tap.message(number, Direction::to_client, {&piece, 1});
      kept += given != 0 ? 1 : 0;
      if (given != 0) {
        EXPECT_EQ(given, kept);
      }
    }
    lost = tap.lost();
    EXPECT_GT(lost, told / 2);
    EXPECT_GE(kept, 3U);
    disk.take_all(folder_ / "copy");
    tap.close();
  }
  const Recorded recorded = read_recorded(folder_ / "copy");
  EXPECT_EQ(recorded.end, RecordingEnd::complete);
  EXPECT_EQ(recorded.message_count, kept);
  EXPECT_EQ(kept + lost, told);
  EXPECT_EQ(recorded.lost.count, lost);
  EXPECT_EQ(recorded.lost.bytes, lost * 1000);
}

TEST_F(Tapping, OrIsWaitedFor) {
  {
    SlowDisk disk(folder_ / "disk");
    Recorder tap(disk.open_writer(), {.buffer_size = 4096});
    const std::vector<std::byte> large(100'000);
    const std::vector<std::byte> small(1000);
    std::atomic<int> told = 0;
    std::thread teller([&] {
      for (int i = 0; i < 200; ++i) {
        const std::vector<std::byte>& bytes = i == 150 ? large : small;
        const Piece piece{bytes.data(), bytes.size()};
        tap.message(1, Direction::to_service, {&piece, 1});
        ++told;
      }
    });
    ASSERT_TRUE(eventually([&] { return told > 20; }));
    EXPECT_LT(told.load(), 200);
    disk.take_all(folder_ / "copy");
    teller.join();
    tap.flush();
    EXPECT_EQ(tap.lost(), 0U);
    tap.close();
    EXPECT_EQ(tap.message(1, Direction::to_service, {}), 0U);
  }
  EXPECT_EQ(read_recorded(folder_ / "copy").message_count, 200U);
}

TEST_F(Tapping, ADiskThatGoesAwayHoldsUpNobody) {
  auto disk = std::make_unique<SlowDisk>(folder_ / "disk");
  Recorder tap(disk->open_writer(), {.buffer_size = 4096});
  disk.reset();
  const std::vector<std::byte> bytes(1000);
  const Piece piece{bytes.data(), bytes.size()};
  for (int i = 0; i < 100; ++i) tap.message(1, Direction::to_service, {&piece, 1});
  EXPECT_TRUE(eventually([&] { return !tap.failure().empty(); }));
  EXPECT_THAT(tap.failure(), HasSubstr("descriptor"));
  EXPECT_EQ(tap.message(1, Direction::to_service, {&piece, 1}), 0U);
  EXPECT_GT(tap.lost(), 0U);
}

}  // namespace
}  // namespace rr::testing
