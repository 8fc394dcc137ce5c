// SPDX-License-Identifier: Apache-2.0
// Local sockets and their files (04, section 7).
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/replay/stream.hpp"

namespace rr::testing {
namespace {

namespace fs = std::filesystem;

std::string content(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::string value_of(const std::string& info, const std::string& key) {
  const std::size_t at = info.find(key + ": ");
  if (at == std::string::npos) return {};
  const std::size_t begin = at + key.size() + 2;
  return info.substr(begin, info.find('\n', begin) - begin);
}

class LocalSocket : public ::testing::Test {
 protected:
  LocalSocket() {
    static int count = 0;
    run = test_folder() + "/local" + std::to_string(count++);
  }
  NodeOptions options(const std::string& name = {}) const {
    return {.name = name, .local = {.user_run_dir = run, .system_run_dir = run + "/system"}};
  }
  fs::path folder() const { return fs::path(run) / "transport/local"; }
  std::string run;
};

TEST_F(LocalSocket, ItsFilesSayWhenServicesComeAndGo) {
  Node node(options("watched.node"));
  node.listen("rr+local://");
  const fs::path by_name = folder() / "by-nodename/watched.node.info";
  const auto nonce = [&] { return value_of(content(by_name), "ServiceStateNonce"); };
  const std::string before = nonce();
  Service service = node.register_service("counter", std::make_shared<Counter>());
  const std::string with_service = nonce();
  EXPECT_EQ(with_service.size(), 16U);
  EXPECT_NE(with_service, before);
  service->set_attributes({{"color", VarValue(std::string("red"))}});
  const std::string with_attribute = nonce();
  EXPECT_NE(with_attribute, with_service);
  service->close();
  EXPECT_NE(nonce(), with_attribute);
  EXPECT_EQ(content(folder() / "by-nodeid" / (node.id().text() + ".info")), content(by_name));
}

TEST_F(LocalSocket, ANodeLeavesFilesThatOthersFindItBy) {
  Node node(options("local.node"));
  node.listen("rr+local://");
  const fs::path by_id = folder() / "by-nodeid" / (node.id().text() + ".info");
  const fs::path by_name = folder() / "by-nodename/local.node.info";
  const std::string info = content(by_id);
  EXPECT_EQ(info, content(by_name));
  EXPECT_EQ(value_of(info, "nodeid"), node.id().text_with_braces());
  EXPECT_EQ(value_of(info, "nodename"), "local.node");
  EXPECT_EQ(value_of(info, "pid"), std::to_string(getpid()));
  EXPECT_EQ(value_of(info, "ServiceStateNonce").size(), 16U);
  EXPECT_LT(info.find("ServiceStateNonce"), info.find("nodeid"));
  EXPECT_EQ(content(folder() / "by-nodename/local.node.pid"), std::to_string(getpid()));
  const fs::path socket = value_of(info, "socket");
  EXPECT_EQ(socket.parent_path(), fs::path(run) / "socket");
  struct stat found {};
  ASSERT_EQ(stat(socket.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0770U);
  ASSERT_EQ(stat(by_id.c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 0777U, 0640U);
  // As somebody finds it who tests with the older kind of lock, from another process.
  const pid_t child = fork();
  if (child == 0) {
    struct flock lock {};
    lock.l_type = F_WRLCK;
    lock.l_whence = SEEK_SET;
    const int file = open(by_id.c_str(), O_RDWR | O_CLOEXEC);
    _exit(fcntl(file, F_SETLK, &lock) == 0 ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 1);
  node.shutdown();
  EXPECT_FALSE(fs::exists(socket));
  EXPECT_EQ(content(by_id), "");
}

TEST_F(LocalSocket, ItsUrlHasAPathAsThatOfOtherImplementations) {
  Node server(options("local.server"));
  server.register_service("counter", std::make_shared<Counter>());
  server.listen("rr+local:///");
  const std::string expected = "rr+local:///?nodeid=" + server.id().text() + "&service=counter";
  EXPECT_EQ(server.urls("counter"), std::vector<std::string>{expected});
  EXPECT_EQ(server.candidate_urls("counter"), std::vector<std::string>{expected});
}

TEST_F(LocalSocket, ANodeIsFoundByIdByNameAndByPath) {
  Node server(options("local.server"));
  server.register_service("counter", std::make_shared<Counter>());
  server.listen("rr+local://");
  Node client(options());
  const std::string path = value_of(content(folder() / "by-nodename/local.server.info"), "socket");
  const std::string id = server.id().text();
  for (const std::string& url :
       {"rr+local:///?nodeid=" + id + "&service=counter",
        std::string("rr+local:///?nodename=local.server&service=counter"),
        "rr+local://localhost/?nodeid=" + id + "&nodename=local.server&service=counter",
        "rr+local://" + path + "?service=counter"}) {
    EXPECT_EQ(client.connect<CounterStub>(url)->add(1, 2), 3) << url;
  }
  EXPECT_EQ(error_of([&] {
              client.connect<CounterStub>("rr+local:///?nodename=nobody&service=counter");
            }).message(),
            "no node `nobody` listens on this machine");
  EXPECT_EQ(error_of([&] { client.connect<CounterStub>("rr+local:///?service=counter"); }).code(),
            ErrorCode::invalid_argument);
}

TEST_F(LocalSocket, ANameIsUsedByOneNodeAtATime) {
  Node first(options("local.one"));
  first.listen("rr+local://");
  Node second(options("local.one"));
  const Error error = error_of([&] { second.listen("rr+local://"); });
  EXPECT_EQ(error.code(), ErrorCode::invalid_operation);
  EXPECT_THAT(error.message(), ::testing::HasSubstr("the node name `local.one` is in use"));
  first.shutdown();
  EXPECT_NO_THROW(second.listen("rr+local://"));
}

TEST_F(LocalSocket, WhatADeadNodeLeftBehindIsCleanedUp) {
  Node first(options());
  first.listen("rr+local://");
  const fs::path socket = fs::path(run) / "socket/abcdefghijklmnop.sock";
  { const replay::Listener killed(socket); }  // leaves its socket behind
  const fs::path other = fs::path(run) / "socket/not-a-socket.sock";
  std::ofstream(other) << "kept";
  std::ofstream(folder() / "by-nodeid/11111111-2222-3333-4444-555555555556.info")
      << "nodeid: {11111111-2222-3333-4444-555555555556}\nsocket: " << other.string() << "\n";
  std::ofstream(folder() / "by-nodeid/11111111-2222-3333-4444-555555555555.info")
      << "nodeid: {11111111-2222-3333-4444-555555555555}\nsocket: " << socket.string() << "\n";
  Node second(options());
  second.listen("rr+local://");
  EXPECT_FALSE(fs::exists(socket));
  EXPECT_TRUE(fs::exists(other));
  const std::string info = content(folder() / "by-nodeid" / (first.id().text() + ".info"));
  EXPECT_TRUE(fs::exists(value_of(info, "socket")));
}

TEST_F(LocalSocket, APublicNodeNeedsTheFolderOfItsUser) {
  Node node(options("local.public"));
  EXPECT_EQ(error_of([&] { node.listen("rr+local:///?public=true"); }).code(),
            ErrorCode::system_resource_error);
  const std::string user = [] {
    Node probe;
    return std::string(getenv("USER") == nullptr ? "" : getenv("USER"));
  }();
  const fs::path base = fs::path(run) / "system/transport/local" / (user.empty() ? "root" : user);
  fs::create_directories(base);
  node.register_service("counter", std::make_shared<Counter>());
  node.listen("rr+local:///?public=true");
  struct stat found {};
  ASSERT_EQ(stat((base / "by-nodeid").c_str(), &found), 0);
  EXPECT_EQ(found.st_mode & 07777U, 02750U);
  Node client(options());
  EXPECT_EQ(client
                .connect<CounterStub>("rr+local://" + base.filename().string() +
                                      "@localhost/?nodename=local.public&service=counter")
                ->add(1, 2),
            3);
}

TEST_F(LocalSocket, AnExplicitPathIsTakenOverFromADeadNodeOnly) {
  fs::create_directories(run);
  const std::string url = "rr+local://" + run + "/own.sock";
  Node first(options());
  first.listen(url);
  Node second(options());
  EXPECT_EQ(error_of([&] { second.listen(url); }).code(), ErrorCode::connection_error);
  first.shutdown();
  EXPECT_NO_THROW(second.listen(url));
  second.register_service("counter", std::make_shared<Counter>());
  EXPECT_EQ(Node(options()).connect<CounterStub>(second.urls("counter").at(0))->add(1, 2), 3);
  EXPECT_EQ(
      error_of([&] { second.listen("rr+local://" + run + "/" + std::string(120, 'x')); }).code(),
      ErrorCode::invalid_argument);
}

}  // namespace
}  // namespace rr::testing
