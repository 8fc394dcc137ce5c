// SPDX-License-Identifier: Apache-2.0
// What an answer costs grows with the size of what it is about.
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <string>

#include "compiler/lsp/analysis.hpp"
#include "compiler/lsp/testing.hpp"

namespace robdef::lsp {
namespace {

// Seconds of this process's time.
template <class Work>
double cost(const Work& work) {
  const std::clock_t begin = std::clock();
  work();
  return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

// Four times as much in less than twelve times the time. What is over at once is not compared.
template <class Work>
void expect_linear(const Work& work, int small) {
  constexpr double at_once = 0.15;
  double first = 0;
  double second = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    first = cost([&] { work(small); });
    second = cost([&] { work(4 * small); });
    if (second < std::max(12 * first, at_once)) return;
  }
  ADD_FAILURE() << first << " s, four times as much " << second << " s";
}

std::string long_line(int parameters) {
  std::string text = "service a\nobject O\nfunction void f(";
  for (int one = 0; one < parameters; ++one) {
    text += (one == 0 ? "Wrong w" : ", Wrong w") + std::to_string(one);
  }
  return text + ")\nend\n";
}

TEST(Growth, OfTokensAndDiagnosticsOfOneLine) {
  expect_linear(
      [](int parameters) {
        testing::Editor editor;
        editor.open("a.robdef", long_line(parameters));
        editor.server.publish();
        editor.of("textDocument/semanticTokens/full", "a.robdef");
      },
      5000);
}

TEST(Growth, OfFilesThatAreAskedFor) {
  expect_linear(
      [](int files) {
        Analysis analysis;
        for (int file = 0; file < files; ++file) {
          analysis.sources.add("/definitions/com.example." + std::to_string(file), "");
        }
        int read = 0;
        for (int file = 0; file < 2 * files; ++file) {
          read += analysis.reads("/definitions/com.example." + std::to_string(file));
        }
        EXPECT_EQ(read, files);
      },
      5000);
}

}  // namespace
}  // namespace robdef::lsp
