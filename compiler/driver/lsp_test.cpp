// SPDX-License-Identifier: Apache-2.0
// robdef lsp through pipes, as an editor starts it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "compiler/driver/program.hpp"

namespace robdef {
namespace {

using testing::HasSubstr;

std::string framed(const std::string& body) {
  return "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

std::string request(int id, const std::string& method, const std::string& params) {
  return framed(R"({"jsonrpc":"2.0","id":)" + std::to_string(id) + R"(,"method":")" + method +
                R"(","params":)" + params + "}");
}

std::string notification(const std::string& method, const std::string& params) {
  return framed(R"({"jsonrpc":"2.0","method":")" + method + R"(","params":)" + params + "}");
}

const std::string initialize = request(1, "initialize", R"({"capabilities":{}})");
const std::string ending = request(9, "shutdown", "null") + notification("exit", "null");

TEST(LspCommand, ServesASession) {
  const TemporaryFolder folder;
  folder.write("far/example.far.robdef", "service example.far\nstruct S\nfield double a\nend\n");
  const std::string uri = "file://" + (folder / "example.a.robdef");
  const std::string text = R"(service example.a\nimport example.far\nobject O\n)"
                           R"(property example.far.S s\nproperty doubel d\nend\n)";
  const Ended ended = run_robdef(
      folder, {"lsp", "--stdio", "-I", folder / "far"}, "",
      initialize +
          notification("textDocument/didOpen", R"({"textDocument":{"uri":")" + uri +
                                                   R"(","version":3,"text":")" + text + R"("}})") +
          request(
              2, "textDocument/definition",
              R"({"textDocument":{"uri":")" + uri + R"("},"position":{"line":3,"character":22}})") +
          ending);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_THAT(ended.out, HasSubstr(R"("name":"robdef")"));
  EXPECT_THAT(ended.out, HasSubstr("far/example.far.robdef"));
  EXPECT_THAT(ended.out, HasSubstr(R"({"id":9,"jsonrpc":"2.0","result":null})"));
}

TEST(LspCommand, PublishesWhenNothingWaits) {
  const TemporaryFolder folder;
  const Ended ended = run_robdef(
      folder, {"lsp"}, "",
      initialize + notification("textDocument/didOpen",
                                R"({"textDocument":{"uri":"untitled:a","version":3,)"
                                R"("text":"service a\nobject O\nproperty doubel d\nend\n"}})"));
  // The stream ends instead of a shutdown.
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, HasSubstr(R"("code":"R0203")"));
  EXPECT_THAT(ended.out, HasSubstr(R"("version":3)"));
}

TEST(LspCommand, TakesNoFiles) {
  const TemporaryFolder folder;
  const Ended ended = run_robdef(folder, {"lsp", "a.robdef"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.err, HasSubstr("`robdef lsp` takes no files"));
}

}  // namespace
}  // namespace robdef
