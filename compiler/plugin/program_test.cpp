// SPDX-License-Identifier: Apache-2.0
// Programs that read, print and end in all the wrong ways.
#include "compiler/plugin/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "compiler/plugin/plugin.hpp"

namespace robdef::plugin {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class Program : public testing::Test {
 protected:
  Program() {
    std::string pattern = (std::filesystem::temp_directory_path() / "plugin-XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~Program() override { std::filesystem::remove_all(folder_); }

  // Runs a script of the shell.
  Printed run(const std::string& script, const std::string& input = "") {
    const std::filesystem::path file = folder_ / "program";
    std::ofstream(file) << "#!/bin/sh\n" << script << "\n";
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return run_program(file.string(), input, limits_, err_);
  }
  std::string failure(const std::string& script, const std::string& input = "") {
    try {
      (void)run(script, input);
    } catch (const PluginError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
  std::ostringstream err_;
  Limits limits_{.output = std::size_t{16} << 20};
};

TEST_F(Program, ReadsAndPrintsAtTheSameTime) {
  const std::string input(std::size_t{8} << 20, 'x');
  const Printed printed = run("exec cat", input);
  EXPECT_EQ(printed.text, input);
  EXPECT_EQ(printed.read, input.size());
  EXPECT_EQ(run("echo first; cat", input).text.size(), input.size() + 6);
}

TEST_F(Program, MayEndWithoutReading) {
  const std::string input(std::size_t{1} << 20, 'x');
  const Printed printed = run("exec 0<&-; echo done", input);
  EXPECT_EQ(printed.text, "done\n");
  EXPECT_LT(printed.read, input.size());
}

TEST_F(Program, FailuresAreNamed) {
  EXPECT_EQ(failure("exit 7"), "failed with exit status 7");
  EXPECT_THAT(failure("kill -9 $$"), StartsWith("was ended by signal 9 ("));
  EXPECT_EQ(failure("exec cat /dev/zero"), "printed more than 16777216 bytes, and was ended");
  try {
    (void)run_program((folder_ / "nowhere").string(), "", limits_, err_);
    FAIL();
  } catch (const PluginError& error) {
    EXPECT_THAT(error.what(), StartsWith("cannot be started: No such file"));
  }
}

TEST_F(Program, OneThatIsSilentIsEnded) {
  limits_.silence = std::chrono::milliseconds(200);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(failure("exec sleep 60"), "did nothing for 1 s, and was ended");
  EXPECT_EQ(failure("exec >&- 2>&-; exec sleep 60"), "did nothing for 1 s, and was ended");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(30));
}

TEST_F(Program, AProcessThatItLeavesBehindHoldsNobodyUp) {
  limits_.after_end = std::chrono::milliseconds(100);
  const auto begin = std::chrono::steady_clock::now();
  const Printed printed = run("sleep 5 & echo done");
  EXPECT_EQ(printed.text, "done\n");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(4));
}

TEST_F(Program, WhatItSaysIsMadePrintable) {
  (void)run("printf 'a\\033[31mb\\nlast' >&2");
  EXPECT_EQ(err_.str(), "a [31mb\nlast\n");
  err_.str("");
  (void)run("printf 'first\\r\\nlast\\r\\n' >&2");
  EXPECT_EQ(err_.str(), "first\nlast\n");
  err_.str("");
  (void)run("i=0; while [ $i -lt 10050 ]; do echo x; i=$((i+1)); done >&2");
  EXPECT_THAT(err_.str(), HasSubstr("x\nrobdef: further lines are left out\n"));
  EXPECT_LT(err_.str().size(), 20'100U);
}

}  // namespace
}  // namespace robdef::plugin
