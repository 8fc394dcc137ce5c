// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/cpp/src/channel/logging.hpp"

namespace rr::channel {
namespace {

TEST(Logging, NobodyTakesLinesByDefault) {
  const NodeOptions options;
  EXPECT_FALSE(has_log(options));
  log(options, LogLevel::error, "nothing happens");
}

TEST(Logging, LinesArePrintableAndSayWhomTheyAreAbout) {
  NodeOptions options;
  options.name = "board";
  std::vector<std::string> lines;
  options.log = [&](LogLevel level, std::string_view text) {
    EXPECT_EQ(level, LogLevel::warning);
    lines.emplace_back(text);
  };
  options.log_record = [&](const LogRecord& record) {
    EXPECT_EQ(record.level, LogLevel::warning);
    lines.push_back(std::string(record.node_name) + " " + std::string(record.peer) + " " +
                    std::string(record.text));
  };
  EXPECT_TRUE(has_log(options));
  log(options, LogLevel::warning, "a\x1b[31mb", "10.0.0.5");
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0].find('\x1b'), std::string::npos);
  EXPECT_EQ(lines[1], "board 10.0.0.5 " + lines[0]);
}

TEST(Logging, ALineHasABound) {
  NodeOptions options;
  std::size_t size = 0;
  options.log = [&](LogLevel, std::string_view text) { size = text.size(); };
  log(options, LogLevel::error, std::string(1'000'000, 'x'));
  EXPECT_GT(size, 100U);
  EXPECT_LT(size, 10'000U);
}

TEST(Logging, ThrowsNothing) {
  NodeOptions options;
  options.log = [](LogLevel, std::string_view) { throw std::runtime_error("full"); };
  EXPECT_NO_THROW(log(options, LogLevel::error, "text"));
}

}  // namespace
}  // namespace rr::channel
