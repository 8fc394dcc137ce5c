// SPDX-License-Identifier: Apache-2.0
#include "compiler/diagnostics/golden_corpus.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace robdef {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class GoldenCorpusTest : public ::testing::Test {
 protected:
  GoldenCorpusTest()
      : folder_(fs::path(::testing::TempDir()) /
                ("golden_" + std::to_string(::getpid()) + "_" +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::create_directories(folder_ / "accept");
    fs::create_directories(folder_ / "reject");
  }
  ~GoldenCorpusTest() override {
    ::unsetenv("ROBDEF_UPDATE");
    fs::remove_all(folder_);
  }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  fs::path folder_;
};

TEST_F(GoldenCorpusTest, ListsItsInputsByName) {
  write("accept/b.robdef", "");
  write("accept/a.robdef", "");
  write("accept/a.stderr", "");
  EXPECT_THAT(GoldenCorpus(folder_ / "accept").inputs(),
              ElementsAre(folder_ / "accept/a.robdef", folder_ / "accept/b.robdef"));
}

TEST_F(GoldenCorpusTest, ComparesWithTheFileBesideTheInput) {
  const fs::path input = write("accept/a.robdef", "");
  write("accept/a.stderr", "one\ntwo\n");
  const GoldenCorpus corpus(folder_ / "accept");
  EXPECT_EQ(corpus.difference(input, ".stderr", "one\ntwo\n"), "");
  EXPECT_THAT(corpus.difference(input, ".stderr", "one\nthree\n"),
              HasSubstr("line 2\n  expected: two\n  actual:   three"));
  EXPECT_THAT(corpus.difference(input, ".stderr", "one\ntwo"), HasSubstr("differs"));
}

TEST_F(GoldenCorpusTest, AMissingOutputMeansNothing) {
  const fs::path input = write("accept/a.robdef", "");
  const GoldenCorpus corpus(folder_ / "accept");
  EXPECT_EQ(corpus.difference(input, ".stderr", ""), "");
  EXPECT_THAT(corpus.difference(input, ".stderr", "more\n"),
              HasSubstr("expected: (end)\n  actual:   more"));
}

TEST_F(GoldenCorpusTest, RewritesWhatThePatternFits) {
  const fs::path a = write("accept/case_a.robdef", "");
  const fs::path b = write("accept/other.robdef", "");
  ::setenv("ROBDEF_UPDATE", "case_?.*", 1);
  const GoldenCorpus corpus(folder_ / "accept");
  EXPECT_EQ(corpus.difference(a, ".cpp/x.hpp", "text\n"), "");
  EXPECT_EQ(GoldenCorpus::read(folder_ / "accept/case_a.cpp/x.hpp"), "text\n");
  EXPECT_NE(corpus.difference(b, ".cpp/x.hpp", "text\n"), "");
  EXPECT_EQ(corpus.difference(a, ".cpp/x.hpp", ""), "");
  EXPECT_FALSE(fs::exists(folder_ / "accept/case_a.cpp/x.hpp"));
}

TEST_F(GoldenCorpusTest, ReadsWhatAnExampleExpects) {
  write("accept/base.robdef", "# expect: accept; rule: -; with: -; note: helper\n");
  write("reject/peer.robdef", "no expectation\n");
  write("reject/V03_x.robdef",
        "\xEF\xBB\xBF# expect: reject; rule: V03; with: base,peer; stage: verify; line: 0\r\n");
  const auto examples = read_examples(folder_ / "reject");
  ASSERT_EQ(examples.size(), 1U);
  EXPECT_FALSE(examples[0].is_accepted);
  EXPECT_EQ(examples[0].rule, "V03");
  EXPECT_EQ(examples[0].stage, "verify");
  EXPECT_THAT(examples[0].companions,
              ElementsAre(folder_ / "accept/base.robdef", folder_ / "reject/peer.robdef"));
  EXPECT_TRUE(read_examples(folder_ / "accept")[0].is_accepted);
}

TEST_F(GoldenCorpusTest, ACompanionThatIsNotThereIsAnError) {
  write("accept/a.robdef", "# expect: accept; rule: -; with: gone\n");
  EXPECT_THROW(read_examples(folder_ / "accept"), std::runtime_error);
}

}  // namespace
}  // namespace robdef
