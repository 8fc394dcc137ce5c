// SPDX-License-Identifier: Apache-2.0
// Lines of the log: their parts, their form, and where they go.
#include "rr/log.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <vector>

#include "rr/setup.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_socket.hpp"

namespace rr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

LogRecord record(LogLevel level, std::string_view text) {
  LogRecord record;
  record.time = std::chrono::system_clock::time_point(std::chrono::milliseconds(1'769'851'800'125));
  record.level = level;
  record.text = text;
  return record;
}

std::string content_of(const std::string& file) {
  std::ifstream input(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(input), {}};
}

/// Keeps what a node logs.
class Kept {
 public:
  std::function<void(const LogRecord&)> taker() {
    return [this](const LogRecord& record) {
      const std::lock_guard lock(mutex_);
      lines_.push_back(log_line(record));
    };
  }
  std::vector<std::string> lines() {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> lines_;
};

/// What standard error gets while this lives.
class CaughtError {
 public:
  explicit CaughtError(std::string file) : file_(std::move(file)), before_(::dup(2)) {
    const int to = ::open(file_.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_APPEND, 0600);
    ::dup2(to, 2);
    ::close(to);
  }
  ~CaughtError() {
    ::dup2(before_, 2);
    ::close(before_);
  }
  [[nodiscard]] std::string text() const { return content_of(file_); }

 private:
  const std::string file_;
  const int before_;
};

TEST(LogLine, HasTheParts) {
  LogRecord line = record(LogLevel::warning, "it is \"hot\"");
  EXPECT_EQ(log_line(line),
            "time=2026-01-31T09:30:00.125Z level=warning msg=\"it is \\\"hot\\\"\"\n");
  line.node_name = "arm.host";
  line.node = *NodeId::parse("11111111-2222-3333-4444-555555555555");
  line.peer = "10.0.0.5";
  line.peer_name = "a viewer";
  line.session = 7;
  EXPECT_EQ(log_line(line),
            "time=2026-01-31T09:30:00.125Z level=warning node=arm.host "
            "node_id=11111111-2222-3333-4444-555555555555 peer=10.0.0.5 peer_name=\"a viewer\" "
            "session=7 msg=\"it is \\\"hot\\\"\"\n");
}

TEST(LogLine, APeerBeginsNoLineAndSteersNoTerminal) {
  LogRecord line = record(LogLevel::info, "\x1b[2J\r\nlevel=error \xff\xc2\x9b");
  line.peer_name = "x\nlevel=error msg=\"forged\" \x1b]0;t\x07\xe2\x80\xae";
  const std::string text = log_line(line);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  for (const char c : text.substr(0, text.size() - 1)) {
    EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) << static_cast<int>(c);
  }
  EXPECT_THAT(text, HasSubstr(" peer_name=\"x\\\\nlevel=error msg=\\\"forged\\\""));
  EXPECT_THAT(text, ::testing::Not(HasSubstr("\xe2\x80\xae")));
  EXPECT_LT(log_line(record(LogLevel::info, std::string(1'000'000, 'x'))).size(), 5000U);
}

TEST(LogRecords, SayWhoseRequestItIs) {
  struct Thrower final : Counter {
    void slow(Reply<void> reply, std::int32_t /*milliseconds*/) override {
      reply();
      throw std::runtime_error("after the answer\nlevel=error");
    }
  };
  Kept kept;
  Pair pair({.name = "log.test", .log_record = kept.taker()}, {.name = "log.client"},
            std::make_shared<Thrower>());
  auto client = pair.connect();
  client->slow(0);
  EXPECT_TRUE(eventually([&] { return !kept.lines().empty(); }));
  const std::string line = kept.lines().front();
  EXPECT_THAT(
      line, HasSubstr(" level=error node=log.test node_id=" + pair.server.id().text() + " peer="));
  EXPECT_THAT(
      line, HasSubstr(" peer_node=" + pair.client.id().text() + " peer_name=log.client session="));
  const std::uint32_t session = pair.service->clients().front().endpoint;
  EXPECT_THAT(line, HasSubstr(" session=" + std::to_string(session) + " msg="));
  EXPECT_THAT(line, HasSubstr("after the answer\\\\nlevel=error"));
}

TEST(LogRecords, OfAClientSayWhichServiceItIs) {
  Kept kept;
  Pair pair({}, {.log_record = kept.taker()});
  auto client = pair.connect();
  const auto listening = client->ticked().connect(
      [](std::int32_t, const std::string&) { throw std::runtime_error("no"); });
  client->fire(1);
  EXPECT_TRUE(eventually([&] { return !kept.lines().empty(); }));
  EXPECT_THAT(kept.lines().front(),
              HasSubstr(" peer_node=" + pair.server.id().text() + " session="));
}

// A handler may use another node: what that logs is not about the handler's client.
TEST(LogRecords, OfAnotherNodeHaveNoPeer) {
  Kept kept;
  struct Asking final : Counter {
    explicit Asking(Node& node) : other(node) {}
    // A password's weak hash makes the other node warn.
    void reset() override {
      other.register_service(
          "counter", std::make_shared<Counter>(),
          {.users = std::make_shared<PasswordUsers>("bob b177f56968fdfe39a41e06e419013440 _\n")});
    }
    Node& other;
  };
  Kept of_other;
  Node other({.log_record = of_other.taker()});
  Pair pair({.log_record = kept.taker()}, {}, std::make_shared<Asking>(other));
  auto client = pair.connect();
  client->reset();
  ASSERT_EQ(of_other.lines().size(), 1U);
  EXPECT_THAT(of_other.lines(), ::testing::Each(::testing::Not(HasSubstr(" peer="))));
}

TEST(LogRecords, SayWhoWasRefused) {
  Kept kept;
  NodeOptions options{.log_record = kept.taker()};
  options.metrics.is_enabled = true;
  Node node(options);
  const RawSocket peer(node.listen_tcp(0, "127.0.0.1"));
  peer.send("GET /metrics HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_THAT(peer.receive_all(), StartsWith("HTTP/1.1 421 "));
  EXPECT_TRUE(eventually([&] { return !kept.lines().empty(); }));
  EXPECT_THAT(kept.lines().front(), HasSubstr(" level=warning"));
  EXPECT_THAT(kept.lines().front(), HasSubstr(" peer=127.0.0.1 "));
  EXPECT_THAT(kept.lines().front(), HasSubstr("HTTP 421"));
}

TEST(LogRecords, WhatALogThrowsIsNobodysBusiness) {
  Node node({.log_record = [](const LogRecord&) { throw std::runtime_error("full"); },
             .metrics = {.is_enabled = true}});
  const RawSocket peer(node.listen_tcp(0, "127.0.0.1"));
  peer.send("GET /metrics HTTP/1.1\r\nHost: evil.example\r\n\r\n");
  EXPECT_THAT(peer.receive_all(), StartsWith("HTTP/1.1 421 "));
}

TEST(LogFile, IsRotatedBySizeAndNumber) {
  const std::string folder = test_folder() + "/rotated";
  std::filesystem::create_directories(folder);
  const std::string path = folder + "/node.log";
  const std::size_t one = log_line(record(LogLevel::info, "line 0")).size();
  const LogFile log(path, {.max_size = 3 * one, .kept_files = 2});
  for (int i = 0; i < 10; ++i) log(record(LogLevel::info, "line " + std::to_string(i)));
  log(record(LogLevel::debug, "is left out"));
  std::vector<std::string> files;
  for (const auto& each : std::filesystem::directory_iterator(folder)) {
    files.push_back(each.path().filename());
    EXPECT_LE(each.file_size(), 3 * one);
  }
  std::sort(files.begin(), files.end());
  EXPECT_THAT(files, ElementsAre("node.log", "node.log.1", "node.log.2"));
  EXPECT_THAT(content_of(path), HasSubstr("line 9"));
  EXPECT_THAT(content_of(path + ".1"), ::testing::AllOf(HasSubstr("line 6"), HasSubstr("line 8")));
  EXPECT_THAT(content_of(path + ".2"), ::testing::AllOf(HasSubstr("line 3"), HasSubstr("line 5")));
  struct stat state {};
  ASSERT_EQ(::stat(path.c_str(), &state), 0);
  EXPECT_EQ(state.st_mode & 0777U, 0600U);
}

TEST(LogFile, IsNoLink) {
  const std::string folder = test_folder() + "/linked";
  std::filesystem::create_directories(folder);
  std::filesystem::create_symlink("/etc/hostname", folder + "/node.log");
  EXPECT_EQ(code_of([&] { LogFile(folder + "/node.log"); }), ErrorCode::invalid_configuration);
  EXPECT_EQ(code_of([&] { LogFile(folder + "/nowhere/node.log"); }),
            ErrorCode::invalid_configuration);
}

TEST(StderrLog, WritesTextOrLogfmt) {
  const CaughtError caught(test_folder() + "/stderr");
  const StderrLog text(LogLevel::warning);
  text(record(LogLevel::info, "is left out"));
  text(record(LogLevel::warning, "as ever"));
  const StderrLog logfmt(LogLevel::debug, LogFormat::logfmt);
  logfmt(record(LogLevel::debug, "x"));
  EXPECT_EQ(caught.text(),
            "robotraconteur: warning: as ever\n"
            "time=2026-01-31T09:30:00.125Z level=debug msg=\"x\"\n");
}

TEST(StderrLog, GivesTheJournalItsPriorities) {
  const CaughtError caught(test_folder() + "/journal");
  struct stat state {};
  ASSERT_EQ(::fstat(2, &state), 0);
  const std::string own = std::to_string(state.st_dev) + ":" + std::to_string(state.st_ino);
  ::setenv("JOURNAL_STREAM", own.c_str(), 1);
  const StderrLog journal(LogLevel::debug);
  for (const LogLevel level :
       {LogLevel::debug, LogLevel::info, LogLevel::warning, LogLevel::error}) {
    journal(record(level, "x"));
  }
  ::setenv("JOURNAL_STREAM", (own + "1").c_str(), 1);  // that of another stream
  const StderrLog plain(LogLevel::debug);
  plain(record(LogLevel::error, "y"));
  ::unsetenv("JOURNAL_STREAM");
  EXPECT_EQ(caught.text(),
            "<7>robotraconteur: debug: x\n<6>robotraconteur: info: x\n"
            "<4>robotraconteur: warning: x\n<3>robotraconteur: error: x\n"
            "robotraconteur: error: y\n");
}

TEST(SetupLog, FlagsChooseFileAndForm) {
  const std::string folder = test_folder() + "/setup";
  std::filesystem::create_directories(folder);
  const auto run = [&](std::initializer_list<std::string> flags) {
    SetupOptions options = SetupOptions::server("log.setup", 0);
    options.local_enable = options.intra_enable = false;
    options.discovery_announce_enable = options.discovery_listening_enable = false;
    options.hardware_enable = true;  // gives a warning
    std::vector<const char*> arguments{"program"};
    for (const std::string& flag : flags) arguments.push_back(flag.c_str());
    const NodeSetup setup(options, static_cast<int>(arguments.size()), arguments.data());
  };
  const std::string file = folder + "/node.log";
  run({"--robotraconteur-log-file=" + file, "--robotraconteur-log-file-size=1000",
       "--robotraconteur-log-file-count=1"});
  EXPECT_THAT(content_of(file), MatchesRegex("time=[^ ]+Z level=warning node=log.setup "
                                             ".*hardware-enable does nothing.*\n"));
  const CaughtError caught(folder + "/stderr");
  run({"--robotraconteur-log-format=logfmt"});
  EXPECT_THAT(caught.text(), HasSubstr(" level=warning node=log.setup "));
  EXPECT_THAT(caught.text(), HasSubstr(" level=info node=log.setup "));  // where it listens
  for (const char* const wrong :
       {"--robotraconteur-log-format=xml", "--robotraconteur-log-file-size=0",
        "--robotraconteur-log-file-size=1k", "--robotraconteur-log-file-count=1001"}) {
    EXPECT_EQ(code_of([&] { run({wrong}); }), ErrorCode::invalid_argument) << wrong;
  }
}

}  // namespace
}  // namespace rr::testing
