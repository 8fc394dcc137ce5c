// SPDX-License-Identifier: Apache-2.0
// describe, get, set and call, as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <utility>

#include "cli/live/testing/bench_service.hpp"
#include "compiler/driver/program.hpp"
#include "rr/node.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/server.hpp"

namespace robdef::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Members : public ::testing::Test {
 protected:
  Ended run(std::vector<std::string> arguments, const std::string& input = "") {
    arguments.insert(arguments.begin() + 1, server_.url());
    return run_robdef(folder_, arguments, "", input);
  }
  std::string out(const std::vector<std::string>& arguments, const std::string& input = "") {
    const Ended ended = run(arguments, input);
    EXPECT_EQ(ended.status, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    return ended.out;
  }
  // What a refused command says.
  std::string err(const std::vector<std::string>& arguments) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 1);
    EXPECT_EQ(ended.out, "");
    return ended.err;
  }

  const std::shared_ptr<Bench> bench_ = std::make_shared<Bench>();
  rr::testing::Server server_{"bench", bench_};
  TemporaryFolder folder_;
};

TEST_F(Members, PropertiesOfAllTypesAreSetAndRead) {
  const std::vector<std::pair<std::string, std::string>> values = {
      {"enabled", "true"},
      {"gain", "-2.5e-300"},
      {"small", "0.25"},
      {"byte", "255"},
      {"big", "-9223372036854775808"},
      {"bigger", "18446744073709551615"},
      {"impedance", "[1.5,-2]"},
      {"label", "\"it's \\\"quoted\\\" \xc3\xa9\""},
      {"samples", "[1,2.5,\"NaN\",\"-Infinity\"]"},
      {"grid", "[[1,2,3],[4,5,6]]"},
      {"pose", R"({"x":0.1,"steps":9007199254740993,"notes":["a","b"]})"},
      {"sample", R"({"sequence":7,"acceleration":[1,2,3]})"},
      {"many", R"([{"sequence":1,"acceleration":[0,0,0]}])"},
      {"vector", R"({"x":1,"y":2})"},
      {"mode", "\"fast\""},
      {"by_number", R"({"-3":1.5,"4":2})"},
      {"by_name", R"({"k":{"x":1,"steps":2,"notes":null}})"},
      {"names", "[\"one\",\"two\"]"},
      {"anything", R"({"type":"int64[]","value":[1,2]})"},
  };
  std::vector<std::string> all = {"get"};
  std::string expected;
  for (const auto& [name, json] : values) {
    EXPECT_EQ(out({"set", name, json}), "");
    all.push_back(name);
    expected += json + "\n";
  }
  EXPECT_EQ(out(all), expected);
  EXPECT_EQ(bench_->get_bigger(), 18446744073709551615U);
  EXPECT_EQ(out({"set", "pose", "null"}), "");
  EXPECT_EQ(out({"get", "pose"}), "null\n");
}

TEST_F(Members, NumbersThatAnEnumDoesNotHavePassAndNamesDoNot) {
  EXPECT_EQ(out({"set", "mode", "12345"}), "");
  EXPECT_EQ(bench_->get_mode(), static_cast<decltype(bench_->get_mode())>(12345));
  EXPECT_EQ(out({"get", "mode"}), "12345\n");
  EXPECT_THAT(err({"set", "mode", "\"faster\""}),
              AllOf(HasSubstr("DataTypeMismatch"), HasSubstr("fast")));
}

TEST_F(Members, ReadonlyAndWriteonlyOnesAreTold) {
  EXPECT_EQ(out({"get", "fixed"}), "42.125\n");
  EXPECT_EQ(out({"set", "hidden", "-3"}), "");
  EXPECT_EQ(bench_->get_hidden(), -3);
  EXPECT_THAT(err({"set", "fixed", "1"}), HasSubstr("ReadOnlyMember"));
  EXPECT_THAT(err({"get", "hidden"}), HasSubstr("WriteOnlyMember"));
}

TEST_F(Members, ErrorsNameTheMemberAndTheType) {
  EXPECT_THAT(err({"set", "gain", "\"fast\""}),
              HasSubstr("member gain: expected double, got string"));
  EXPECT_THAT(err({"set", "pose", R"({"x":"a","steps":1,"notes":null})"}),
              HasSubstr("member pose, field x: expected double, got string"));
  EXPECT_THAT(err({"set", "byte", "256"}), HasSubstr("member byte"));
  EXPECT_THAT(err({"set", "label", "text"}),
              HasSubstr("member label: expected string as JSON, got `text`; a string has quotes"));
  EXPECT_THAT(err({"get", "nothing"}), HasSubstr("has no member `nothing`"));
  EXPECT_THAT(err({"get", "gird"}), HasSubstr("has no member `gird`; did you mean `grid`?"));
  EXPECT_THAT(err({"get", "ticked"}),
              HasSubstr("member ticked: expected property, wire or memory, got event"));
  EXPECT_THAT(err({"set", "add", "1"}),
              HasSubstr("member add: expected property, wire or memory, got function"));
  EXPECT_THAT(err({"call", "gain"}), HasSubstr("member gain: expected function, got property"));
  EXPECT_THAT(err({"call", "add", "1"}), HasSubstr("member add: expected 2 arguments"));
  EXPECT_THAT(err({"call", "add", "1", "true"}),
              HasSubstr("member add, parameter b: expected double, got bool"));
  EXPECT_THAT(err({"call", "fail", "\"no power\""}),
              HasSubstr("RobotRaconteur.OperationFailed: no power"));
}

TEST_F(Members, AWireThatAnswersNoPeekIsConnectedTo) {
  EXPECT_THAT(err({"get", "level", "--timeout", "0.05"}),
              AllOf(HasSubstr("ValueNotSet"), HasSubstr("no value was sent within 50 ms either")));
  bench_->level().on_connect([](rr::ServedWire<double> end) { end.set_in(2.5); });
  EXPECT_EQ(out({"get", "level"}), "2.5\n");
  EXPECT_TRUE(rr::testing::eventually([&] { return bench_->level().connections().empty(); }));
}

TEST_F(Members, FunctionsAndGeneratorsAreCalled) {
  EXPECT_EQ(out({"call", "add", "40", "-2.5"}), "37.5\n");
  EXPECT_EQ(out({"call", "count", "3"}), "0\n1\n2\n");
  EXPECT_EQ(out({"call", "count", "1000", "--count", "2"}), "0\n1\n");
  EXPECT_EQ(out({"call", "running_sum", "10", "1", "2", "-5"}), "11\n13\n8\n");
  EXPECT_EQ(out({"call", "running_sum", "10", "-"}, "1\n2\n"), "11\n13\n");
  EXPECT_EQ(out({"call", "collect", "1", "2"}), "");
  EXPECT_EQ(bench_->collected.load(), 3);
}

TEST_F(Members, WiresArePeekedAndPoked) {
  EXPECT_THAT(err({"get", "level"}), HasSubstr("ValueNotSet"));
  bench_->level().set_in(1.25);
  EXPECT_EQ(out({"get", "level"}), "1.25\n");
  EXPECT_EQ(out({"set", "level", "-7"}), "");
  EXPECT_EQ(bench_->level().out().value().value, -7);
}

TEST_F(Members, MemoriesAreReadAndWrittenInParts) {
  EXPECT_EQ(out({"get", "buffer"}), "[1,2,3,4]\n");
  EXPECT_EQ(out({"get", "buffer", "--at", "1", "--count", "2"}), "[2,3]\n");
  EXPECT_EQ(out({"set", "buffer", "[9,\"Infinity\"]", "--at=2"}), "");
  EXPECT_EQ(out({"get", "buffer", "--at", "2"}), "[9,\"Infinity\"]\n");
  // The items of an array lie with the first index fastest.
  const std::string all = out({"get", "plane"});
  EXPECT_EQ(out({"set", "plane", "[[70],[80]]", "--at", "0,1"}), "");
  EXPECT_EQ(out({"get", "plane", "--at", "0,1", "--count", "2,1"}), "[[70],[80]]\n");
  EXPECT_NE(out({"get", "plane"}), all);
  EXPECT_EQ(err({"get", "buffer", "--at", "1", "--count", "9"}).substr(0, 8), "robdef: ");
  EXPECT_EQ(run({"get", "buffer", "--at", "1,x"}).status, 2);
}

TEST_F(Members, PathsGoThroughObjrefs) {
  EXPECT_EQ(out({"set", "lamps[1].brightness", "0.5"}), "");
  EXPECT_EQ(out({"get", "lamp.brightness", "named[left one%5d.].brightness", "other.brightness"}),
            "0.5\n0.5\n0.5\n");
  EXPECT_THAT(err({"get", "lamps[x].brightness"}),
              HasSubstr("member lamps: expected an index of type int32, got `x`"));
  EXPECT_THAT(err({"get", "lamps.brightness"}),
              HasSubstr("member lamps: expected an index of type int32, got none"));
  EXPECT_THAT(err({"get", "gain.brightness"}), HasSubstr("member gain: expected objref"));
  EXPECT_THAT(err({"get", "lamps[7].brightness"}), HasSubstr("ObjectNotFound"));
  EXPECT_THAT(err({"get", "lamp..x"}), HasSubstr("`lamp..x` is no path"));
  EXPECT_THAT(err({"get", "lamps[1]"}), HasSubstr("name one of its members: lamps[1].NAME"));
}

TEST_F(Members, DescriptionsAreForPeopleAndForPrograms) {
  const std::string text = out({"describe"});
  EXPECT_THAT(text, AllOf(StartsWith("service bench, object test.bench.Bench\n"),
                          HasSubstr("function double add(double a, double b)\n      Adds two"),
                          HasSubstr("struct Pose"), HasSubstr("objref Lamp")));
  const std::string json = out({"describe", "--format=json"});
  EXPECT_THAT(json, AllOf(HasSubstr("\"test.bench.Lamp\""), HasSubstr("\"How bright it is.\""),
                          HasSubstr("\"index\": \"int32\""), HasSubstr("\"is_generator\": true"),
                          HasSubstr("\"kind\": \"namedarray\""), HasSubstr("\"fast\": 5")));
  EXPECT_EQ(out({"describe", "lamps[0].brightness"}),
            "property double brightness\n    How bright it is.\n");
  EXPECT_THAT(out({"describe", "lamps"}), AllOf(HasSubstr("object test.bench.Lamp\n"),
                                                HasSubstr("  event switched(bool on)\n")));
  EXPECT_THAT(out({"describe", "other"}), HasSubstr("object test.bench.Lamp\n"));
  EXPECT_THAT(out({"describe", "pose", "--format=json"}),
              AllOf(HasSubstr("\"type\": \"test.bench.Pose\""), Not(HasSubstr("Sample"))));
  EXPECT_THAT(err({"describe", "lamp.nothing"}), HasSubstr("has no member `nothing`"));
}

TEST_F(Members, CompletionAsksTheService) {
  const auto completed = [&](const std::string& command, const std::string& word) {
    return run_robdef(folder_, {"complete", command, server_.url(), word}).out;
  };
  EXPECT_EQ(completed("get", "b"), "big\nbigger\nbuffer\nby_name\nby_number\nbyte\n");
  EXPECT_EQ(completed("set", "fi"), "");
  EXPECT_EQ(completed("call", "a"), "add\n");
  EXPECT_EQ(completed("watch", "l"), "lamp.\nlamps[\nlevel\n");
  EXPECT_EQ(completed("get", "lamps[0].b"), "lamps[0].brightness\n");
  EXPECT_EQ(completed("watch", "other."), "other.switched\n");
}

TEST_F(Members, WrongUseIsStatusTwo) {
  EXPECT_THAT(run_robdef(folder_, {"get", "file", "x"}).err,
              HasSubstr("`file` is no URL; an example: rr+tcp://"));
  EXPECT_EQ(run({"get"}).status, 2);
  EXPECT_EQ(run({"set", "gain"}).status, 2);
  EXPECT_EQ(run({"call", "x", "--timeout", "soon"}).status, 2);
  EXPECT_THAT(run({"get", "gain", "--password-file", "x"}).err, HasSubstr("needs `--user`"));
  server_.stop();
  EXPECT_THAT(err({"get", "gain", "--timeout", "1"}), HasSubstr("ConnectionError"));
}

TEST(Users, LogInWithAPasswordFromAFileOrTheEnvironment) {
  const auto users =
      std::make_shared<rr::PasswordUsers>("alice " + rr::PasswordUsers::hash("wonder 1") + " _\n");
  rr::testing::Server server("bench", std::make_shared<Bench>(), {},
                             {.users = users, .require_user = true});
  const TemporaryFolder folder;
  folder.write("password", "wonder 1\n");
  folder.write("wrong", "other\n");
  const std::vector<std::string> get = {"get", server.url(), "fixed", "--user", "alice"};
  const auto with_file = [&](const std::string& file) {
    std::vector<std::string> arguments = get;
    arguments.insert(arguments.end(), {"--password-file", file});
    return run_robdef(folder, arguments);
  };
  EXPECT_EQ(with_file("password").out, "42.125\n");
  EXPECT_THAT(with_file("wrong").err, HasSubstr("AuthenticationError"));
  EXPECT_THAT(with_file("nowhere").err, HasSubstr("`nowhere`"));
  ::setenv("ROBDEF_PASSWORD", "wonder 1", 1);
  EXPECT_EQ(run_robdef(folder, get).out, "42.125\n");
  ::unsetenv("ROBDEF_PASSWORD");
  EXPECT_EQ(run_robdef(folder, {"get", server.url(), "fixed"}).status, 1);
}

}  // namespace
}  // namespace robdef::testing
