// SPDX-License-Identifier: Apache-2.0
#include "rr/audit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/cpp/src/node/testing/guarded_client.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

// Keeps what it is told: `kind user operation member path outcome`.
class Witness {
 public:
  [[nodiscard]] AuditOptions options(bool requests = false) {
    return {.on_event = [this](const AuditEvent& event) { take(event); }, .requests = requests};
  }
  [[nodiscard]] std::vector<AuditEvent> events() {
    const std::lock_guard lock(mutex_);
    return events_;
  }
  [[nodiscard]] std::vector<std::string> lines() {
    std::vector<std::string> result;
    for (const AuditEvent& event : events()) {
      std::string line(audit_kind_name(event.kind));
      for (const std::string& text : {event.user, event.operation, event.member}) {
        if (!text.empty()) line += " " + text;
      }
      result.push_back(line + (event.is_allowed ? "" : " refused"));
    }
    return result;
  }

 private:
  void take(const AuditEvent& event) {
    const std::lock_guard lock(mutex_);
    events_.push_back(event);
  }

  std::mutex mutex_;
  std::vector<AuditEvent> events_;
};

TEST(Audit, TellsWhoComesAndGoesAndWhatIsRefused) {
  Witness witness;
  GuardedService service(GuardedService::with_rights("deny user:guest member value access set\n"
                                                     "allow user:*\n"),
                         {.audit = witness.options()});
  {
    GuardedClient client(service, "");
    client.log_in("alice", "wrong");
    client.log_in("alice");
    client.connect_wire();
    client.operation("RequestObjectLock");
    client.operation("ReleaseObjectLock");
    client.log_in("guest");
    client.ask(EntryType::property_set_req, "guarded", "value", element("value", 1.0));
    client.ask(EntryType::property_get_req, "guarded", "value");
    client.log_out();
    client.ask(EntryType::property_get_req, "guarded", "value");
  }
  EXPECT_TRUE(eventually([&] { return witness.events().size() >= 12; }));
  EXPECT_THAT(
      witness.lines(),
      ElementsAre("connect", "login alice refused", "login alice", "lock alice RequestObjectLock",
                  "unlock alice ReleaseObjectLock", "logout alice", "login guest", "ended guest",
                  "access guest set value refused", "logout guest", "access get value refused",
                  "disconnect"));
}

TEST(Audit, CountsWhatEndsWithALogin) {
  Witness witness;
  GuardedService service(GuardedService::with_users(), {.audit = witness.options()});
  GuardedClient client(service, "alice");
  client.connect_wire();
  client.connect_pipe();
  client.open_generator();
  client.open_generator();
  ASSERT_EQ(client.operation("MonitorEnter", "guarded", element<std::int32_t>("timeout", 0)), 0);
  client.log_out();
  const auto events = witness.events();
  const auto ended = std::find_if(events.begin(), events.end(), [](const AuditEvent& event) {
    return event.kind == AuditKind::ended;
  });
  ASSERT_NE(ended, events.end());
  EXPECT_EQ(ended->reason, "5 wires, pipes, generators, callbacks or locks");
}

TEST(Audit, SaysFromWhereAndWhy) {
  Witness witness;
  GuardedService service(GuardedService::with_users(), {.audit = witness.options()});
  const std::uint16_t port = service.node.listen_tcp(0, "127.0.0.1");
  Node node({.name = "pendant"});
  const std::string url = "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=guarded";
  const auto with = [](const std::string& password) {
    return ConnectOptions{.username = "alice", .credentials = {{"password", password}}};
  };
  EXPECT_EQ(code_of([&] { node.connect<GuardedStub>(url, with("secret")); }),
            ErrorCode::authentication_error);
  const auto events = witness.events();
  const auto found = std::find_if(events.begin(), events.end(), [](const AuditEvent& event) {
    return event.kind == AuditKind::login;
  });
  ASSERT_NE(found, events.end());
  EXPECT_FALSE(found->is_allowed);
  EXPECT_EQ(found->address, "127.0.0.1");
  EXPECT_EQ(found->service, "guarded");
  EXPECT_EQ(found->node, node.id());
  EXPECT_EQ(found->node_name, "pendant");
  EXPECT_EQ(found->certificate, "");
  EXPECT_THAT(found->reason, HasSubstr("Invalid username or password"));
  EXPECT_THAT(AuditLog::line(*found), Not(HasSubstr("secret")));
  // A local socket names its user.
  GuardedClient local(service, "alice");
  const auto later = witness.events();
  EXPECT_EQ(later.back().address, "uid " + std::to_string(::getuid()));
}

TEST(Audit, OfRequestsIsAFlag) {
  Witness witness;
  GuardedService service(GuardedService::with_users(), {.audit = witness.options(true)});
  GuardedClient client(service, "alice");
  client.ask(EntryType::property_get_req, "guarded.child[a]", "value");
  client.ask(EntryType::memory_get_param, "guarded", "store",
             element<std::string>("parameter", "Length"));
  EXPECT_THAT(witness.lines(), ElementsAre("connect", "login alice", "access alice get value",
                                           "access alice read store"));
  EXPECT_EQ(witness.events().at(2).path, "guarded.child[a]");
}

TEST(Audit, CountsRefusalsThatAreTooMany) {
  Witness witness;
  AuditOptions options = witness.options();
  options.refusals = 3;
  GuardedService service(GuardedService::with_users(), {.audit = options});
  GuardedClient client(service, "");
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(client.ask(EntryType::property_get_req, "guarded", "value"), refused);
  }
  EXPECT_EQ(witness.events().size(), 4U);  // connect, and three
}

TEST(Audit, ThatThrowsGoesToTheLog) {
  std::mutex mutex;
  std::string log;
  GuardedService service(
      GuardedService::with_users(),
      {.log =
           [&](LogLevel, std::string_view text) {
             const std::lock_guard lock(mutex);
             log += text;
           },
       .audit = {.on_event = [](const AuditEvent&) { throw std::runtime_error("disk full"); }}});
  GuardedClient client(service, "alice");
  EXPECT_EQ(client.ask(EntryType::property_get_req, "guarded", "value"), 0);
  const std::lock_guard lock(mutex);
  EXPECT_THAT(log, HasSubstr("disk full"));
}

class AuditLogTest : public ::testing::Test {
 protected:
  ~AuditLogTest() override {
    for (const char* end : {"", ".1", ".2", ".3", ".link"}) std::remove((path_ + end).c_str());
  }
  [[nodiscard]] std::string text_of(const std::string& end = "") const {
    std::ifstream file(path_ + end, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  const std::string path_ = ::testing::TempDir() + "robdef_audit_" + std::to_string(::getpid());
};

AuditEvent some_event(std::string user) {
  AuditEvent event;
  event.kind = AuditKind::login;
  event.user = std::move(user);
  event.service = "arm";
  event.client = 7;
  return event;
}

TEST_F(AuditLogTest, WritesALineForEachEventAtOnce) {
  const AuditLog log(path_);
  AuditEvent event = some_event("alice");
  event.time = std::chrono::system_clock::time_point(std::chrono::milliseconds(1500));
  event.is_allowed = false;
  event.reason = "Invalid username or password";
  log(event);
  EXPECT_EQ(text_of(),
            "{\"time\":\"1970-01-01T00:00:01.500000Z\",\"event\":\"login\",\"outcome\":\"refused\","
            "\"service\":\"arm\",\"user\":\"alice\",\"client\":7,"
            "\"reason\":\"Invalid username or password\"}\n");
  const AuditLog copy = log;  // NOLINT(performance-unnecessary-copy-initialization)
  copy(event);
  const std::string text = text_of();
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
}

// A peer chooses its name, but no line.
TEST_F(AuditLogTest, EscapesWhatPeersSay) {
  const std::string line =
      AuditLog::line(some_event("a\"b\\c\nd\x1b[2J\x7f\xff\xc3\xa9\xc2\x9b\xed\xa0\x80"));
  EXPECT_THAT(line, HasSubstr("\"user\":\"a\\\"b\\\\c\\u000ad\\u001b[2J\\u007f\\ufffd\xc3\xa9"
                              "\\u009b\\ufffd\\ufffd\\ufffd\""));
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
  EXPECT_LT(AuditLog::line(some_event(std::string(60'000, 'x'))).size(), 1300U);
}

TEST_F(AuditLogTest, BelongsToItsOwnerAlone) {
  std::ofstream(path_) << "before\n";
  ::chmod(path_.c_str(), 0666);
  const AuditLog log(path_);
  log(some_event("alice"));
  struct stat status {};
  ASSERT_EQ(::stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777U, 0600U);
  EXPECT_THAT(text_of(), ::testing::StartsWith("before\n{"));  // is added to
}

TEST_F(AuditLogTest, FollowsNoLinkAndOpensNothingElse) {
  std::ofstream(path_) << "mine\n";
  ASSERT_EQ(::symlink(path_.c_str(), (path_ + ".link").c_str()), 0);
  EXPECT_EQ(code_of([&] { const AuditLog log(path_ + ".link"); }),
            ErrorCode::invalid_configuration);
  EXPECT_EQ(code_of([&] { const AuditLog log("/dev/null"); }), ErrorCode::invalid_configuration);
  EXPECT_EQ(code_of([&] { const AuditLog log("/no/such/folder/log"); }),
            ErrorCode::invalid_configuration);
  EXPECT_EQ(text_of(), "mine\n");
}

TEST_F(AuditLogTest, StartsANewFileWhenItWouldBecomeTooLarge) {
  const AuditEvent event = some_event("alice");
  const std::size_t line = AuditLog::line(event).size();
  const AuditLog log(path_, {.max_size = 2 * line, .kept_files = 2});
  for (int i = 0; i < 9; ++i) log(event);
  EXPECT_EQ(text_of().size(), line);
  EXPECT_EQ(text_of(".1").size(), 2 * line);
  EXPECT_EQ(text_of(".2").size(), 2 * line);
  EXPECT_EQ(text_of(".3").size(), 0U);
}

}  // namespace
}  // namespace rr::testing
