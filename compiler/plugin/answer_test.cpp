// SPDX-License-Identifier: Apache-2.0
#include "compiler/plugin/answer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "compiler/diagnostics/mutations.hpp"
#include "compiler/plugin/plugin.hpp"

namespace robdef::plugin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Key;
using testing::StartsWith;

class PluginAnswer : public testing::Test {
 protected:
  PluginAnswer() { sources_.add("a.robdef", "\xEF\xBB\xBFservice a\r\nenum E\n"); }

  Answer read(const std::string& text) { return read_answer(text, sources_, "nowhere"); }
  std::string refusal(const std::string& text) {
    try {
      (void)read(text);
    } catch (const PluginError& error) {
      return error.what();
    }
    return "";
  }
  std::string refused_path(const std::string& path) {
    return refusal(R"({"files":[{"path":")" + path + R"(","content":""}]})");
  }
  std::string refused_finding(const std::string& finding) {
    return refusal(R"({"findings":[)" + finding + "]}");
  }

  Sources sources_;
};

TEST_F(PluginAnswer, HasFilesAndFindings) {
  const Answer answer = read(R"({"files": [{"path": "b/c.md", "content": "x\n"},
                                           {"path": "a..b", "content": ""}],
    "findings": [{"level": "error", "message": "no\u001b", "at": {"file": "a.robdef", "line": 2,
                  "column": 6, "length": 1}},
                 {"level": "warning", "message": "all", "at": null}]})");
  EXPECT_THAT(answer.files.files(), ElementsAre(Key("a..b"), Key("b/c.md")));
  EXPECT_EQ(answer.files.files().at("b/c.md"), "x\n");
  ASSERT_EQ(answer.findings.size(), 2U);
  EXPECT_EQ(answer.findings[0].severity, Severity::error);
  EXPECT_EQ(answer.findings[0].message, "no ");
  EXPECT_EQ(answer.findings[0].at, (Span{SourceId{0}, 19, 20}));
  EXPECT_EQ(answer.findings[1].severity, Severity::warning);
  EXPECT_FALSE(answer.findings[1].at);
}

TEST_F(PluginAnswer, WhatIsNoAnswerIsRefused) {
  EXPECT_EQ(refusal(" \n"), "it printed no answer");
  EXPECT_THAT(refusal("Hello"), StartsWith("its answer is no JSON, at byte 1; what is for people"));
  EXPECT_THAT(refusal("{} x"), StartsWith("its answer is no JSON, at byte 4"));
  EXPECT_THAT(refusal("{\"files\": [\"\xff\"]}"), StartsWith("its answer is no JSON"));
  EXPECT_EQ(refusal("[]"), "its answer is no object");
  EXPECT_EQ(refusal("{}"), "its answer has neither `files` nor `findings`");
  EXPECT_EQ(refusal(R"({"file": []})"), "its answer has the unknown key `file`");
  EXPECT_EQ(refusal(R"({"files": {}})"), "`files` of its answer is no list");
  EXPECT_EQ(refusal(R"({"files": [1]})"), "file 1 of its answer is no object");
  EXPECT_EQ(refusal(R"({"files": [{"path": "a"}]})"), "file 1 of its answer has no `content`");
  EXPECT_EQ(refusal(R"({"files": [{"path": 1, "content": ""}]})"),
            "`path` of file 1 of its answer is no text");
  EXPECT_EQ(refusal(std::string(100'000, '[')), "its answer is nested too deeply");
  std::string many = R"({"files":[0)";
  for (int i = 0; i < 1'000'001; ++i) many += ",0";
  EXPECT_EQ(refusal(many + "]}"), "its answer has too many values");
}

TEST_F(PluginAnswer, PathsStayBelowTheFolder) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "is empty"},
      {"/etc/x", "is absolute"},
      {"..", "leads out of the output folder"},
      {"a/../../b", "leads out of the output folder"},
      {"a//b", "has an empty part or `.`"},
      {"a/", "has an empty part or `.`"},
      {"./a", "has an empty part or `.`"},
      {"a\\\\b", "has a backslash or a control character"},
      {"a\\nb", "has a backslash or a control character"},
      {"a\\u0000b", "has a backslash or a control character"},
      {"x/.robdef-cpp.manifest", "is a name that robdef keeps for itself"},
      {std::string(1001, 'a'), "is too long"},
  };
  for (const auto& [path, fault] : cases) {
    EXPECT_THAT(refused_path(path), testing::EndsWith(fault)) << path;
  }
  EXPECT_EQ(refusal(R"({"files":[{"path":"a","content":""},{"path":"a","content":""}]})"),
            "it makes `a` twice");
  EXPECT_EQ(refusal(R"({"files":[{"path":"a","content":""},{"path":"a/b","content":""}]})"),
            "it makes `a` a file and a folder");
}

TEST_F(PluginAnswer, TheFolderMayBeSpelledInAnyWay) {
  for (const char* folder : {"nowhere/", "nowhere//", "./nowhere/.", "a/../nowhere/", ".", "./"}) {
    const Answer answer =
        read_answer(R"({"files":[{"path":"b/c.md","content":""}]})", sources_, folder);
    EXPECT_THAT(answer.files.files(), ElementsAre(Key("b/c.md"))) << folder;
  }
}

TEST_F(PluginAnswer, ALinkDoesNotLeadOut) {
  std::string pattern = (std::filesystem::temp_directory_path() / "answer-XXXXXX").string();
  const std::filesystem::path folder = ::mkdtemp(pattern.data());
  std::filesystem::create_directories(folder / "in/real");
  std::filesystem::create_directory_symlink(folder, folder / "in/link");
  std::filesystem::create_directory_symlink(folder / "in/real", folder / "in/near");
  const auto answer = [](const std::string& path) {
    return R"({"files":[{"path":")" + path + R"(","content":""}]})";
  };
  EXPECT_EQ(read_answer(answer("near/x"), sources_, folder / "in").files.files().size(), 1U);
  try {
    (void)read_answer(answer("link/x"), sources_, folder / "in");
    ADD_FAILURE() << "was accepted";
  } catch (const PluginError& error) {
    EXPECT_THAT(error.what(), HasSubstr("leads out of the output folder by a link"));
  }
  std::filesystem::remove_all(folder);
}

TEST_F(PluginAnswer, FindingsNamePlacesThatAreThere) {
  EXPECT_EQ(refused_finding(R"({"level":"note","message":"x"})"),
            "`level` of finding 1 of its answer is neither `error` nor `warning`");
  EXPECT_EQ(refused_finding(R"({"level":"error","message":""})"),
            "`message` of finding 1 of its answer is empty");
  const auto at = [&](const std::string& place) {
    return refused_finding(R"({"level":"error","message":"x","at":)" + place + "}");
  };
  EXPECT_EQ(at(R"({"file":"b.robdef","line":1,"column":1})"),
            "`at` of finding 1 of its answer names `b.robdef`, which is no file of this run");
  EXPECT_EQ(at(R"({"file":"a.robdef","line":1,"column":11})"),
            "`at` of finding 1 of its answer is no place of `a.robdef`: line 1, column 11");
  EXPECT_EQ(at(R"({"file":"a.robdef","line":1,"column":10})"), "") << "the end of the line";
  EXPECT_THAT(at(R"({"file":"a.robdef","line":0,"column":1})"), HasSubstr("is no place"));
  EXPECT_THAT(at(R"({"file":"a.robdef","line":4,"column":1})"), HasSubstr("is no place"));
  EXPECT_THAT(at(R"({"file":"a.robdef","line":-1,"column":1})"), HasSubstr("is no number"));
  EXPECT_THAT(at(R"({"file":"a.robdef","line":1,"column":99999999999})"),
              HasSubstr("is no number"));
  EXPECT_EQ(at(R"({"file":"a.robdef","line":1,"column":1,"length":4294967295})"), "");
}

TEST_F(PluginAnswer, DamagedOnesAreReadOrRefused) {
  const std::string right =
      R"({"files":[{"path":"b/c.md","content":"x\n"},{"path":"d","content":""}],
"findings":[{"level":"error","message":"no","at":{"file":"a.robdef","line":2,"column":6,"length":1}}]})";
  int refused = 0;
  for (std::uint64_t seed = 0; seed < 5000; ++seed) {
    const std::string text = mutated(right, seed);
    try {
      const Answer answer = read_answer(text, sources_, "nowhere");
      for (const auto& [path, content] : answer.files.files()) {
        EXPECT_THAT(path, testing::Not(StartsWith("/")));
        EXPECT_THAT(path, testing::Not(HasSubstr("../"))) << text;
      }
      for (const Finding& finding : answer.findings) {
        if (!finding.at) continue;
        EXPECT_LE(finding.at->end, sources_[SourceId{0}].text().size());
      }
    } catch (const PluginError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace robdef::plugin
