// SPDX-License-Identifier: Apache-2.0
// The commands about recordings, as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <rr/recording.hpp>
#include <rr/tap.hpp>

#include "compiler/driver/program.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace robdef {
namespace {

using rr::testing::CounterStub;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string golden = ROBDEF_DRIVER_GOLDEN;

std::string url(std::uint16_t port) {
  return "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=counter";
}

class Recordings : public testing::Test {
 protected:
  Ended run(const std::vector<std::string>& arguments) { return run_robdef(folder_, arguments); }
  std::string record(const std::function<void(CounterStub&)>& what) {
    std::string path = folder_ / "tape";
    rr::testing::Pair pair({}, {.tap = std::make_shared<rr::Recorder>(path)});
    auto counter = pair.connect();
    what(*counter);
    return path;
  }

  TemporaryFolder folder_;
};

TEST_F(Recordings, AreInspectedLineByLine) {
  const Ended ended = run({"inspect", golden + "/counter.rrtape"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, read_text(golden + "/counter.txt"));
}

TEST_F(Recordings, OrAsJson) {
  const Ended ended = run({"inspect", "--json", golden + "/counter.rrtape"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, read_text(golden + "/counter.json_lines"));
}

TEST_F(Recordings, OrSummedUp) {
  const Ended ended = run({"inspect", "--summary", golden + "/counter.rrtape"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.out, read_text(golden + "/counter.summary"));
  const Ended json = run({"inspect", "--summary", "--json", golden + "/counter.rrtape"});
  EXPECT_THAT(json.out, AllOf(StartsWith("{"), HasSubstr("\"p99_ms\"")));
}

TEST_F(Recordings, CanBeFiltered) {
  const std::string tape = golden + "/counter.rrtape";
  const std::string all = run({"inspect", tape}).out;
  const auto count = [](const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
  };
  const std::string sets = run({"inspect", "--entries=PropertySetReq,1114", tape}).out;
  EXPECT_GE(count(sets), 2);
  EXPECT_LT(count(sets), count(all));
  EXPECT_THAT(sets, Not(HasSubstr("FunctionCall")));
  EXPECT_EQ(run({"inspect", "--connection", "1", tape}).out.find("definition"), std::string::npos);
  EXPECT_EQ(run({"inspect", "--connection", "77", tape}).out, "");
  const std::string child = run({"inspect", "--path", "counter.child", tape}).out;
  EXPECT_THAT(child, HasSubstr("counter.child"));
  EXPECT_THAT(child, Not(HasSubstr("counter.value")));
  EXPECT_EQ(run({"inspect", "--path", "coun", tape}).out, "");
  const Ended wrong = run({"inspect", "--entries=Nothing", tape});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("`Nothing` is no type of an entry"));
}

TEST_F(Recordings, ThatAreCutOffArePrintedUpToThere) {
  const std::string bytes = read_text(golden + "/counter.rrtape");
  folder_.write("cut", bytes.substr(0, bytes.size() - 30));
  const Ended ended = run({"inspect", "cut"});
  EXPECT_EQ(ended.status, 1);
  const std::string all = read_text(golden + "/counter.txt");
  EXPECT_EQ(ended.out, all.substr(0, all.rfind('\n', all.size() - 2) + 1));
  EXPECT_THAT(ended.err, ContainsRegex("^robdef: cut: cut off in the record at byte [0-9]+\n$"));
  folder_.write("other", "no recording at all, but long enough to hold a header");
  const Ended other = run({"inspect", "other", "nowhere"});
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.err, AllOf(HasSubstr("other is no recording"), HasSubstr("nowhere")));
}

TEST_F(Recordings, AreMadeOfConnectionsThatPassThrough) {
  rr::testing::Pair pair;
  Running recording(folder_, {"record", "--connect", "127.0.0.1:" + std::to_string(pair.port),
                              "--listen", "0", "-o", "tape"});
  {
    auto counter = pair.client.connect<CounterStub>(url(recording.port()));
    EXPECT_EQ(counter->add(1, 2), 3);
  }
  EXPECT_EQ(recording.end(), 0);
  EXPECT_THAT(recording.out(), ContainsRegex("\ntape: [0-9]+ messages\n"));
  const Ended ended = run({"inspect", "tape"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.out, AllOf(HasSubstr("FunctionCallReq counter.add"),
                               HasSubstr("return: double 3"), HasSubstr("closed")));
}

TEST_F(Recordings, ArePlayedToAServiceAndToAClient) {
  record([](CounterStub& counter) {
    counter.set_value(2);
    counter.add(1, 2);
  });
  rr::testing::Pair pair;
  const std::string address = "127.0.0.1:" + std::to_string(pair.port);
  const Ended same = run({"replay", "tape", "--connect", address, "--fast"});
  EXPECT_EQ(same.status, 0) << same.out << same.err;
  EXPECT_THAT(same.out,
              ContainsRegex("^messages sent: [0-9]+, entries compared: [0-9]+, differences: 0\n$"));
  EXPECT_EQ(pair.object->get_value(), 2);

  Running playing(folder_, {"replay", "tape", "--listen", "0"});
  {
    auto counter = pair.client.connect<CounterStub>(url(playing.port()));
    counter->set_value(2);
    EXPECT_EQ(counter->add(10, 20), 3);  // the recorded answer
  }
  EXPECT_EQ(playing.end(0), 1);
  EXPECT_THAT(playing.out(), AllOf(HasSubstr("FunctionCallReq counter.add"),
                                   HasSubstr("`a`: double 1 recorded, double 10 came"),
                                   HasSubstr("differences: 1\n")));
}

TEST_F(Recordings, WrongUseIsExplained) {
  EXPECT_THAT(run({"record", "-o", "x", "--listen", "0"}).err, HasSubstr("`--connect` is missing"));
  EXPECT_THAT(run({"record", "--connect", "a:1", "--listen", "x"}).err, HasSubstr("is no port"));
  EXPECT_THAT(run({"replay", "x"}).err, HasSubstr("give either `--connect` or `--listen`"));
  for (const char* const wrong : {"-1", "x", "1x", "", "nan", "inf", "1e999"}) {
    EXPECT_EQ(run({"replay", "x", "--listen", "0", "--tolerance", wrong}).status, 2) << wrong;
  }
  EXPECT_EQ(run({"replay", "x", "--listen", "0", "--ignore", ""}).status, 2);
  EXPECT_EQ(run({"replay", "x", "--listen", "0", "--connect", "a:1"}).status, 2);
  EXPECT_EQ(run({"inspect"}).status, 2);
  const Ended nowhere = run({"record", "--connect", "nothing", "--listen", "0", "-o", "x"});
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_THAT(nowhere.err, HasSubstr("`nothing` is not HOST:PORT"));
}

TEST_F(Recordings, ThePageOfANodeIsOpenedWhereItServesOne) {
  const std::string file = folder_ / "page.html";
  std::ofstream(file) << "<html></html>";
  rr::Node serving({.web_socket = {.inspector_page = file}});
  const std::string host = "127.0.0.1:" + std::to_string(serving.listen_tcp(0, "127.0.0.1"));
  const std::string part = "/#url=rr%2Bws://" + host + "/%3Fservice%3Dcounter\n";
  const Ended ended = run({"inspect", "--page", "rr+tcp://" + host + "/?service=counter"});
  EXPECT_EQ(ended.out, "http://" + host + part);
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(run({"inspect", "--page", "tcp://" + host + "/some.node/counter"}).out,
            "http://" + host + "/#url=rr%2Bws://" + host +
                "/%3Fnodename%3Dsome.node%26service%3Dcounter\n");
}

TEST_F(Recordings, ThePageIsTheInstalledFileOtherwise) {
  rr::Node plain;
  const std::string host = "127.0.0.1:" + std::to_string(plain.listen_tcp(0, "127.0.0.1"));
  const Ended ended = run({"inspect", "--page", "rr+tcp://" + host + "/?service=counter"});
  // The build folder may have it installed, or not.
  if (ended.status == 0) {
    EXPECT_THAT(ended.out, AllOf(StartsWith("file:///"), HasSubstr("inspector.html#url=rr%2Bws")));
    EXPECT_THAT(ended.err, HasSubstr("allow-local-pages"));
  } else {
    EXPECT_THAT(ended.err, HasSubstr("not installed at"));
  }
  EXPECT_THAT(run({"inspect", "--page", "rr+tcp://127.0.0.1:1/?service=a"}).err,
              HasSubstr("nothing answers at 127.0.0.1:1"));
  EXPECT_THAT(run({"inspect", "--page", "rr+local:///?service=a"}).err,
              HasSubstr("a page cannot use rr+local"));
  EXPECT_EQ(run({"inspect", "--page", "a", "b"}).status, 2);
}

}  // namespace
}  // namespace robdef
