// SPDX-License-Identifier: Apache-2.0
#include "gateway/program_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>
#include <string>

#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using Task = ProgramOptions::Task;

TEST(GatewayOptions, AFileIsExported) {
  const auto options = read_options({"robot.toml"});
  EXPECT_EQ(options.task, Task::export_file);
  EXPECT_EQ(options.export_files, std::vector<std::string>{"robot.toml"});
}

TEST(GatewayOptions, ServicesAreServed) {
  const auto options = read_options({"--serve", "hall/r1/arm", "--serve", "hall/r2/arm=arm2",
                                     "--broker", "mqtts://hub", "--reader", "desk", "--authority",
                                     "ca.pem", "--certificate", "desk.pem", "--key", "desk.key"});
  ASSERT_EQ(options.task, Task::serve);
  ASSERT_EQ(options.server.services.size(), 2U);
  EXPECT_EQ(options.server.services[0].address, (ServiceAddress{"hall", "r1", "arm"}));
  EXPECT_EQ(options.server.services[0].name, "arm");
  EXPECT_EQ(options.server.services[1].name, "arm2");
  EXPECT_EQ(options.server.reader, "desk");
  EXPECT_EQ(options.broker.url, "mqtts://hub");
  EXPECT_EQ(options.broker.authority, "ca.pem");
  EXPECT_EQ(options.broker.certificate, "desk.pem");
  EXPECT_EQ(options.broker.key, "desk.key");
}

TEST(GatewayOptions, ServicesHaveUsers) {
  const auto options = read_options({"--users", "arm2=people", "--serve", "hall/r1/arm", "--serve",
                                     "hall/r2/arm=arm2", "--rights", "arm2=rules=2", "--broker",
                                     "mqtts://hub", "--reader", "desk"});
  ASSERT_EQ(options.server.services.size(), 2U);
  EXPECT_EQ(options.server.services[0].users_file, "");
  EXPECT_EQ(options.server.services[0].rights_file, "");
  EXPECT_EQ(options.server.services[1].users_file, "people");
  EXPECT_EQ(options.server.services[1].rights_file, "rules=2");
}

TEST(GatewayOptions, FilesAreForServedServicesOnly) {
  const auto refusal = [](std::vector<std::string> more) {
    std::vector<std::string> words = {"--serve", "hall/r1/arm", "--broker", "x", "--reader", "y"};
    words.insert(words.end(), more.begin(), more.end());
    try {
      read_options(words);
    } catch (const Error& error) {
      return error.message();
    }
    return std::string("taken");
  };
  EXPECT_EQ(refusal({"--users", "leg=people"}),
            "no service is served as `leg`; see robdef-gateway --help");
  EXPECT_EQ(refusal({"--rights", "arm"}),
            "`--rights arm` is not of the form name=file; see robdef-gateway --help");
  EXPECT_EQ(refusal({"--users", "arm="}),
            "`--users arm=` is not of the form name=file; see robdef-gateway --help");
  EXPECT_EQ(refusal({"--users", "=people"}),
            "`--users =people` is not of the form name=file; see robdef-gateway --help");
  EXPECT_EQ(refusal({"--users", "arm=one", "--users", "arm=two"}),
            "`--users arm=two` is there twice; see robdef-gateway --help");
}

TEST(GatewayOptions, AccessListsAreMadeOfFiles) {
  const auto options = read_options({"--acl", "mosquitto", "one", "two"});
  EXPECT_EQ(options.task, Task::access_list);
  EXPECT_EQ(options.list_form, "mosquitto");
  EXPECT_EQ(options.export_files, (std::vector<std::string>{"one", "two"}));
}

TEST(GatewayOptions, AccessListsOfNatsNameUsers) {
  const auto options = read_options(
      {"--acl", "nats", "--user", "desk", "--user", "guest", "--watcher", "boss", "one", "two"});
  EXPECT_EQ(options.task, Task::access_list);
  EXPECT_EQ(options.list_form, "nats");
  EXPECT_EQ(options.list_users, (std::vector<std::string>{"desk", "guest"}));
  EXPECT_EQ(options.list_watchers, std::vector<std::string>{"boss"});
  EXPECT_EQ(options.export_files, (std::vector<std::string>{"one", "two"}));
}

TEST(GatewayOptions, FleetsAreShown) {
  const auto options = read_options({"--fleet", "--broker", "mqtt://hub", "--json"});
  EXPECT_EQ(options.task, Task::fleet);
  EXPECT_TRUE(options.is_json);
  EXPECT_EQ(options.broker.url, "mqtt://hub");
}

TEST(GatewayOptions, WhatIsMissingOrUnknownIsRefused) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"--serve"},
        {"--serve", "hall/r1", "--broker", "x", "--reader", "y"},
        {"--serve", "hall/r1/arm", "--reader", "y"},
        {"--serve", "hall/r1/arm", "--broker", "x"},
        {"--what"},
        {"one", "two"},
        {"--fleet"},
        {"--json", "one"},
        {"--users", "arm=people", "one"},
        {"--acl"},
        {"--acl", "mosquitto"},
        {"--acl", "emqx", "one"},
        {"--acl", "mosquitto", "--watcher", "guest", "one"},
        {"one", "--serve", "a/b/c", "--broker", "x", "--reader", "y"}}) {
    EXPECT_THROW(static_cast<void>(read_options(words)), Error) << words[0];
  }
}

TEST(GatewayOptions, HelpWins) {
  EXPECT_EQ(read_options({}).task, Task::help);
  EXPECT_EQ(read_options({"--help", "--nonsense"}).task, Task::help);
}

TEST(GatewayOptions, AreAllInTheManual) {
  std::ostringstream manual;
  manual << std::ifstream(ROBDEF_GATEWAY_MANUAL).rdbuf();
  const std::string text = std::regex_replace(manual.str(), std::regex(R"(\\-)"), "-");
  const std::string help = program_help;
  const std::regex option("--[a-z][a-z-]*[a-z]");
  int count = 0;
  for (std::sregex_iterator at(help.begin(), help.end(), option), end; at != end; ++at, ++count) {
    EXPECT_THAT(text, ::testing::HasSubstr(at->str()));
  }
  EXPECT_GE(count, 12);
}

}  // namespace
}  // namespace rr::gateway
