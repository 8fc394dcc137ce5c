// SPDX-License-Identifier: Apache-2.0
#include "gateway/call_window.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "gateway/testing/folder.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using testing::Folder;
using State = CallWindow::State;

constexpr std::int64_t minute = 60'000'000'000;

Message answer() { return {"", Bytes(3, std::byte{7}), {{"error", "12"}, {"error-name", ""}}}; }

TEST(GatewayCallWindow, KnowsWhatHasBegunAndItsAnswer) {
  const Folder folder;
  CallWindow window(folder.path(), {}, 0);
  EXPECT_EQ(window.state("a 1"), State::unknown);
  window.begin("a 1", 0);
  EXPECT_EQ(window.state("a 1"), State::running);
  window.end("a 1", answer(), 0);
  EXPECT_EQ(window.state("a 1"), State::answered);
  EXPECT_EQ(window.answer("a 1").properties, answer().properties);
}

TEST(GatewayCallWindow, KnowsItAfterARestart) {
  const Folder folder;
  {
    CallWindow window(folder.path(), {}, 0);
    window.begin("done", 0);
    window.end("done", answer(), 0);
    window.begin("half", 0);
  }
  const CallWindow window(folder.path(), {}, minute);
  ASSERT_EQ(window.state("done"), State::answered);
  EXPECT_EQ(window.answer("done").payload, answer().payload);
  EXPECT_EQ(window.answer("done").properties, answer().properties);
  EXPECT_EQ(window.state("half"), State::interrupted);
}

// A limit of the process on the size of files stands for a disk that is full.
TEST(GatewayCallWindow, WhatCannotBeRememberedDoesNotBegin) {
  const Folder folder;
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    ::signal(SIGXFSZ, SIG_IGN);
    ::alarm(30);
    CallWindow window(folder.path(), {}, 0);
    testing::limit_file_size(40);
    try {
      window.begin("a 1", 0);
    } catch (const Error&) {
      ::_exit(window.state("a 1") == State::unknown ? 0 : 1);
    }
    ::_exit(2);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST(GatewayCallWindow, ForgetsWhatIsOld) {
  const Folder folder;
  CallWindow window(folder.path(), {}, 0);
  window.begin("old", 0);
  window.end("old", answer(), 0);
  window.begin("new", 9 * minute);
  window.forget_old(11 * minute);
  EXPECT_EQ(window.state("old"), State::unknown);
  EXPECT_EQ(window.state("new"), State::running);
}

TEST(GatewayCallWindow, ForgetsTheOldestOfTooMany) {
  const Folder folder;
  CallWindow window(folder.path(), {.count = 10}, 0);
  for (int i = 0; i < 25; ++i) window.begin(std::to_string(i), 0);
  EXPECT_EQ(window.state("14"), State::unknown);
  EXPECT_EQ(window.state("15"), State::running);
}

TEST(GatewayCallWindow, AnswersTakeBoundedMemory) {
  const Folder folder;
  CallWindow window(folder.path(), {.bytes = 10'000}, 0);
  const Message large{"", Bytes(1'000), {}};
  for (int i = 0; i < 25; ++i) {
    window.begin(std::to_string(i), 0);
    window.end(std::to_string(i), large, 0);
  }
  EXPECT_EQ(window.state("0"), State::unknown);
  EXPECT_EQ(window.state("24"), State::answered);
}

}  // namespace
}  // namespace rr::gateway
