// SPDX-License-Identifier: Apache-2.0
// Both ends of streams over a link that drops, doubles, delays and forgets, by seed and with a
// clock of the test.
#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <filesystem>
#include <memory>
#include <random>
#include <string>

#include "gateway/properties.hpp"
#include "gateway/stream_reader.hpp"
#include "gateway/stream_writer.hpp"
#include "gateway/testing/folder.hpp"

namespace rr::gateway {
namespace {

using std::chrono::milliseconds;
using testing::Folder;

constexpr std::int64_t today = 1'795'779'856'000'000'000;  // nanoseconds since 1970

Bytes bytes(std::uint64_t number) {
  Bytes result(sizeof number);
  std::memcpy(result.data(), &number, sizeof number);
  return result;
}

std::uint64_t number_in(const Message& message) {
  std::uint64_t number = 0;
  std::memcpy(&number, message.payload.data(), sizeof number);
  return number;
}

/// A writer, a reader called `hub`, and the link between them.
class Link {
 public:
  explicit Link(std::uint32_t seed = 1, LogLimits limits = {},
                StreamReader::Options options = {.records = 50,
                                                 .ask_count = 32,
                                                 .patience = milliseconds(200)})
      : random_(seed), limits_(limits), options_(options) {
    restart_writer();
    restart_reader();
  }

  void restart_writer() {
    writer_.reset();
    writer_ = std::make_unique<StreamWriter>("rr/a/b/c/pipe", folder_.path(), limits_,
                                             std::vector<std::string>{"hub"});
  }
  void restart_reader() {
    StreamReader::Sink sink;
    sink.record = [this](const Message& message) { got.push_back(number_in(message)); };
    sink.gap = [this](const StreamGap& gap) { gaps.push_back(gap); };
    reader_ = std::make_unique<StreamReader>(sink, options_);
  }
  void forget_all() { link_.clear(); }
  void forget_first(std::ptrdiff_t count) { link_.erase(link_.begin(), link_.begin() + count); }
  [[nodiscard]] std::size_t waiting() const { return link_.size(); }
  void remove_log() {
    writer_.reset();
    std::filesystem::remove_all(folder_.path());
    restart_writer();
  }

  void append(std::uint64_t number) {
    writer_->append(RecordKind::data, "uint64", bytes(number), today, now_);
  }

  /// 10 ms of both ends.
  void step() {
    now_ += milliseconds(10);
    if (++steps_ % 100 == 0) writer_->tick(now_, 0);
    writer_->flush(now_);
    for (int i = 0; i < 20 && is_up; ++i) {
      auto message = writer_->next();
      if (!message) break;
      const bool fits = message->payload.size() <= largest;
      writer_->done(fits ? Published::taken : Published::refused);
      if (fits) send(*std::move(message));
    }
    for (int i = 0; i < capacity && !link_.empty(); ++i) {
      reader_->receive(std::move(link_.front()), now_);
      link_.pop_front();
      ++carried;
    }
    answer_reader();
  }

  /// Until the reader has everything and the writer knows it, for a minute at most.
  bool settle() {
    for (int i = 0; i < 6'000; ++i) {
      step();
      if (link_.empty() && reader_->epoch() == writer_->epoch() &&
          reader_->position() == writer_->last() && !reader_->unconfirmed()) {
        return true;
      }
    }
    return false;
  }

  StreamWriter& writer() { return *writer_; }
  StreamReader& reader() { return *reader_; }

  std::vector<std::uint64_t> got;
  std::vector<StreamGap> gaps;
  double dropped = 0;
  double twice = 0;
  double late = 0;
  std::size_t largest = 8;
  bool is_up = true;
  int capacity = 20;  // messages in a step
  int carried = 0;    // messages in all

 private:
  bool happens(double share) {
    return std::uniform_real_distribution<double>(0, 1)(random_) < share;
  }
  void send(Message message) {
    if (happens(dropped)) return;
    if (happens(twice)) link_.push_back(message);
    if (happens(late) && !link_.empty()) {
      link_.insert(link_.begin() + static_cast<std::ptrdiff_t>(random_() % link_.size()),
                   std::move(message));
    } else {
      link_.push_back(std::move(message));
    }
  }
  void answer_reader() {
    if (const auto ask = reader_->ask(now_); ask && is_up && !happens(dropped)) {
      writer_->ask("hub", ask->from, ask->count, "rr/$reply/hub/1");
    }
    if (const auto number = reader_->unconfirmed(); number && steps_ % 10 == 0 && is_up) {
      if (!happens(dropped)) writer_->confirm("hub", reader_->epoch(), *number);
      reader_->confirmed(*number);
    }
  }

  Folder folder_;
  std::mt19937 random_;
  LogLimits limits_;
  StreamReader::Options options_;
  std::unique_ptr<StreamWriter> writer_;
  std::unique_ptr<StreamReader> reader_;
  std::deque<Message> link_;
  StreamReader::Clock::time_point now_{std::chrono::hours(1)};
  int steps_ = 0;
};

std::vector<std::uint64_t> up_to(std::uint64_t last) {
  std::vector<std::uint64_t> all;
  for (std::uint64_t i = 1; i <= last; ++i) all.push_back(i);
  return all;
}

TEST(GatewayStreams, ArriveOnceAndInOrder) {
  Link link;
  for (std::uint64_t i = 1; i <= 100; ++i) link.append(i);
  ASSERT_TRUE(link.settle());
  EXPECT_EQ(link.got, up_to(100));
  EXPECT_TRUE(link.gaps.empty());
}

TEST(GatewayStreams, ArriveOnceAndInOrderOverABadLink) {
  for (std::uint32_t seed = 1; seed <= 20; ++seed) {
    Link link(seed, {.file_bytes = 1'000});
    link.dropped = 0.3;
    link.twice = 0.2;
    link.late = 0.2;
    for (std::uint64_t i = 1; i <= 1'000; ++i) {
      link.append(i);
      if (i % 3 == 0) link.step();
      if (i % 100 == 0) link.forget_all();
    }
    ASSERT_TRUE(link.settle()) << seed;
    EXPECT_EQ(link.got, up_to(1'000)) << seed;
    EXPECT_TRUE(link.gaps.empty()) << seed;
  }
}

TEST(GatewayStreams, SurviveRestartsOfTheWriter) {
  Link link(3);
  link.dropped = 0.2;
  for (std::uint64_t i = 1; i <= 500; ++i) {
    link.append(i);
    if (i % 2 == 0) link.step();
    if (i % 70 == 0) link.restart_writer();
  }
  ASSERT_TRUE(link.settle());
  EXPECT_EQ(link.got, up_to(500));
  EXPECT_TRUE(link.gaps.empty());
}

TEST(GatewayStreams, ARestartedReaderGoesOnBehindWhatItHasConfirmed) {
  Link link;
  for (std::uint64_t i = 1; i <= 100; ++i) link.append(i);
  ASSERT_TRUE(link.settle());
  link.restart_reader();
  for (std::uint64_t i = 101; i <= 120; ++i) link.append(i);
  ASSERT_TRUE(link.settle());
  EXPECT_EQ(link.got, up_to(120));
}

TEST(GatewayStreams, WhatWasLoggedWhileTheLinkWasDownComesLater) {
  Link link;
  ASSERT_TRUE(link.settle());
  link.is_up = false;
  for (std::uint64_t i = 1; i <= 5'000; ++i) {
    link.append(i);
    if (i % 50 == 0) link.step();
  }
  EXPECT_TRUE(link.got.empty());
  link.is_up = true;
  link.reader().reconnected();
  ASSERT_TRUE(link.settle());
  EXPECT_EQ(link.got, up_to(5'000));
}

// A broker has 1,500 messages for a reader that takes 200 a second, and 100 a second follow: an
// answer needs 7 s. A reader that asks again all the time meanwhile gets ever more to take.
TEST(GatewayStreams, AReaderThatIsBehindDoesNotAskEverMore) {
  Link link(1, {}, {});
  ASSERT_TRUE(link.settle());
  link.capacity = 2;
  for (std::uint64_t i = 1; i <= 2'000; ++i) link.append(i);
  while (link.waiting() < 1'500) link.step();
  link.forget_first(300);
  link.carried = 0;
  for (std::uint64_t i = 2'001; i <= 4'000; ++i) {
    link.append(i);
    link.step();
  }
  ASSERT_TRUE(link.settle());
  EXPECT_EQ(link.got, up_to(4'000));
  EXPECT_TRUE(link.gaps.empty());
  // Each once, most once more since what is missing is in front of them, and some in vain.
  EXPECT_LE(link.carried, 10'000);
}

// An hour of the test's clock, with a packet each 100 ms; the writer's own work goes on meanwhile.
TEST(GatewayStreams, WhatWasLoggedInAnHourWithoutTheLinkComesLater) {
  Link link;
  ASSERT_TRUE(link.settle());
  link.is_up = false;
  constexpr std::uint64_t last = 36'000;
  for (std::uint64_t i = 1; i <= last; ++i) {
    link.append(i);
    for (int step = 0; step < 10; ++step) link.step();
  }
  EXPECT_TRUE(link.got.empty());
  link.is_up = true;
  link.reader().reconnected();
  ASSERT_TRUE(link.settle());
  EXPECT_EQ(link.got, up_to(last));
  EXPECT_TRUE(link.gaps.empty());
}

TEST(GatewayStreams, ConfirmedRecordsLeaveTheDisk) {
  Link link(1, {.file_bytes = 1'000});
  for (std::uint64_t i = 1; i <= 2'000; ++i) {
    link.append(i);
    link.step();
  }
  ASSERT_TRUE(link.settle());
  for (int i = 0; i < 30; ++i) link.step();
  EXPECT_LE(link.writer().status().bytes, 2'100U);
}

// Else a reader would miss what it has confirmed.
TEST(GatewayStreams, NothingIsDiscardedBeforeItIsWrittenDownThatReadersHaveIt) {
  const Folder folder;
  const Folder copy;
  const auto now = StreamWriter::Clock::now();
  StreamWriter writer("topic", folder.path(), {.file_bytes = 100}, {"hub"});
  for (std::uint64_t i = 1; i <= 20; ++i) writer.append(RecordKind::data, "", bytes(i), today, now);
  writer.confirm("hub", writer.epoch(), 5);
  writer.flush(now);
  const std::uint64_t before = writer.status().bytes;
  writer.confirm("hub", writer.epoch(), 20);
  writer.flush(now + milliseconds(10));
  EXPECT_EQ(writer.status().bytes, before);
  // As a process that is killed leaves it.
  std::filesystem::copy(folder.path(), copy.path(), std::filesystem::copy_options::recursive);
  StreamWriter again("topic", copy.path(), {.file_bytes = 100}, {"hub"});
  EXPECT_EQ(again.status().confirmed.at("hub"), 5U);
  again.ask("hub", 0, 10, "reply");
  std::optional<std::string> first;
  while (auto message = again.next()) {
    again.done(Published::taken);
    if (message->topic == "reply" && !first) first = message->find("next");
  }
  EXPECT_EQ(first, "6");
  writer.flush(now + milliseconds(300));
  EXPECT_LT(writer.status().bytes, before);
  EXPECT_EQ(writer.status().last, 20U);
}

TEST(GatewayStreams, WhatTheLimitsDropIsReportedAsAGap) {
  Link link(1, {.bytes = 10'000, .file_bytes = 1'000});
  for (std::uint64_t i = 1; i <= 10; ++i) link.append(i);
  ASSERT_TRUE(link.settle());
  link.is_up = false;
  for (std::uint64_t i = 11; i <= 1'000; ++i) link.append(i);
  link.is_up = true;
  link.reader().reconnected();
  ASSERT_TRUE(link.settle());
  ASSERT_EQ(link.gaps.size(), 1U);
  EXPECT_EQ(link.gaps[0].first, 11U);
  const std::uint64_t lost = link.gaps[0].last - 10;
  EXPECT_EQ(link.got.size(), 1'000 - lost);
  EXPECT_EQ(link.got[9], 10U);
  EXPECT_EQ(link.got[10], link.gaps[0].last + 1);
  EXPECT_EQ(link.got.back(), 1'000U);
}

TEST(GatewayStreams, ALostEndIsReportedWithoutAnotherRecord) {
  Link link(1, {.age = std::chrono::seconds(1)});
  for (std::uint64_t i = 1; i <= 10; ++i) link.append(i);
  ASSERT_TRUE(link.settle());
  for (std::uint64_t i = 11; i <= 20; ++i) link.append(i);
  link.writer().tick(StreamWriter::Clock::now(), today + 10'000'000'000);
  ASSERT_TRUE(link.settle());
  ASSERT_EQ(link.gaps.size(), 1U);
  EXPECT_EQ(link.gaps[0].first, 11U);
  EXPECT_EQ(link.gaps[0].last, 20U);
  EXPECT_EQ(link.got, up_to(10));
}

TEST(GatewayStreams, ANewLogIsAGap) {
  Link link;
  for (std::uint64_t i = 1; i <= 10; ++i) link.append(i);
  ASSERT_TRUE(link.settle());
  link.remove_log();
  for (std::uint64_t i = 11; i <= 20; ++i) link.append(i);
  ASSERT_TRUE(link.settle());
  ASSERT_EQ(link.gaps.size(), 1U);
  EXPECT_EQ(link.gaps[0].first, 0U);
  EXPECT_EQ(link.got, up_to(20));
}

TEST(GatewayStreams, WhatTheBrokerCannotCarryIsAGap) {
  Link link;
  link.append(1);
  ASSERT_TRUE(link.settle());
  link.largest = 7;
  link.append(2);
  ASSERT_TRUE(link.settle());
  link.largest = 8;
  link.append(3);
  ASSERT_TRUE(link.settle());
  EXPECT_EQ(link.got, (std::vector<std::uint64_t>{1, 3}));
  EXPECT_EQ(link.gaps.size(), 1U);
}

TEST(GatewayStreams, AReaderThatWasNotDeclaredBeginsWithWhatComes) {
  const Folder folder;
  StreamWriter writer("topic", folder.path(), {}, {});
  const auto now = StreamWriter::Clock::now();
  writer.append(RecordKind::data, "", bytes(1), 0, now);
  writer.ask("other", 0, 10, "reply");
  std::vector<std::string> numbers;
  while (auto message = writer.next()) {
    writer.done(Published::taken);
    if (message->topic == "reply") numbers.emplace_back(*message->find("confirmed"));
  }
  EXPECT_EQ(numbers, std::vector<std::string>{"1"});
}

TEST(GatewayStreams, MalformedMessagesAreIgnored) {
  int records = 0;
  StreamReader reader(
      {.record = [&](const Message&) { ++records; }, .gap = [](const StreamGap&) {}}, {});
  const auto now = StreamReader::Clock::now();
  using Properties = std::vector<std::pair<std::string, std::string>>;
  const Properties head{
      {"stream", "7"}, {"kind", "head"}, {"number", "3"}, {"confirmed", "3"}, {"topic", "t"}};
  reader.receive({"t", {}, head}, now);
  EXPECT_EQ(reader.position(), 3U);
  for (const Properties& bad :
       {Properties{}, Properties{{"stream", "7"}, {"kind", "data"}, {"number", "4"}},
        Properties{{"stream", "7"}, {"kind", "data"}, {"number", "4"}, {"follows", "4"}},
        Properties{{"stream", "7"}, {"kind", "data"}, {"number", "-1"}, {"follows", "0"}},
        Properties{{"stream", "x"}, {"kind", "data"}, {"number", "4"}, {"follows", "3"}},
        Properties{{"stream", "7"}, {"kind", "head"}, {"number", "4"}, {"confirmed", "9"}}}) {
    reader.receive({"t", {}, bad}, now);
  }
  EXPECT_EQ(records, 0);
  EXPECT_EQ(reader.position(), 3U);
  reader.receive({"t", {}, {{"stream", "7"}, {"kind", "data"}, {"number", "4"}, {"follows", "3"}}},
                 now);
  EXPECT_EQ(records, 1);
}

}  // namespace
}  // namespace rr::gateway
