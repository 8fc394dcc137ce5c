// SPDX-License-Identifier: Apache-2.0
// What the protocol asks for, whatever the definitions are; streams and their limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <future>
#include <sstream>
#include <stdexcept>
#include <streambuf>
#include <utility>

#include "compiler/diagnostics/mutations.hpp"
#include "compiler/lsp/framing.hpp"
#include "compiler/lsp/session.hpp"
#include "compiler/lsp/testing.hpp"

namespace robdef::lsp {
namespace {

using testing::Editor;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::string framed(const std::string& body) {
  return "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

struct Served {
  int status = -1;
  std::vector<Json> sent;
};

Served served(const std::string& input) {
  std::istringstream in(input);
  std::ostringstream out;
  Served result;
  result.status = serve({}, in, out);
  std::istringstream answers(out.str());
  for (Framed one = read_message(answers); one.kind == Framed::Kind::body;
       one = read_message(answers)) {
    result.sent.push_back(Json::parse(one.body));
  }
  return result;
}

std::vector<int> error_codes(const Served& served) {
  std::vector<int> codes;
  for (const Json& one : served.sent) codes.push_back(one.at("error").at("code"));
  return codes;
}

const std::string exit_message = framed(R"({"jsonrpc":"2.0","method":"exit"})");

TEST(Session, EndsWithZeroAfterAShutdownAndOneWithout) {
  const std::string start =
      framed(R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}})");
  const std::string shutdown = framed(R"({"jsonrpc":"2.0","id":2,"method":"shutdown"})");
  EXPECT_EQ(served(start + shutdown + exit_message).status, 0);
  EXPECT_EQ(served(start + exit_message).status, 1);
  EXPECT_EQ(served(start).status, 1);
  EXPECT_EQ(served("").status, 1);
}

TEST(Session, AnswersWhatIsNoMessageWithTheCodesOfJsonRpc) {
  EXPECT_THAT(error_codes(served(framed("{") + exit_message)), ElementsAre(-32700));
  EXPECT_THAT(error_codes(served(framed("[]") + framed("3") + exit_message)),
              ElementsAre(-32600, -32600));
  EXPECT_THAT(error_codes(served(framed(R"({"id":{},"jsonrpc":"2.0","method":"x"})"))),
              ElementsAre(-32600));
  EXPECT_THAT(error_codes(served(framed("\"\xFF\"") + exit_message)), ElementsAre(-32700));
  EXPECT_THAT(error_codes(served(framed(std::string(200'000, '[')) + exit_message)),
              ElementsAre(-32700));
}

TEST(Session, EndsWhereTheNextMessageCannotBeFound) {
  for (const std::string& input :
       {std::string("Content-Length: many\r\n\r\n{}"), std::string("Length: 2\r\n\r\n{}"),
        std::string("Content-Length: 20\r\n\r\n{}"), std::string("Content-Length: -2\r\n\r\n{}"),
        std::string(10'000, 'a'), std::string("Content-Length: 2\r\n")}) {
    const Served result = served(input);
    EXPECT_EQ(result.status, 1) << input;
    EXPECT_THAT(error_codes(result), ElementsAre(-32700)) << input;
  }
}

TEST(Session, LeavesOutAMessageThatIsTooLarge) {
  std::istringstream in("Content-Length: 99999999999999\r\n\r\n{}");
  EXPECT_EQ(read_message(in).kind, Framed::Kind::lost);
  std::istringstream larger("Content-Length: 99999999999999999999999\r\n\r\n{}");
  EXPECT_EQ(read_message(larger).kind, Framed::Kind::lost);
}

/// Gives its bytes one by one, and says when a place is reached.
class Noticed : public std::streambuf {
 public:
  Noticed(std::string text, std::size_t place) : text_(std::move(text)), place_(place) {}
  std::future<void> reached() { return reached_.get_future(); }

 protected:
  int_type underflow() override {
    if (next_ == place_) reached_.set_value();
    if (next_ == text_.size()) return traits_type::eof();
    setg(&text_[next_], &text_[next_], &text_[next_] + 1);
    return traits_type::to_int_type(text_[next_++]);
  }

 private:
  std::string text_;
  const std::size_t place_;
  std::size_t next_ = 0;
  std::promise<void> reached_;
};

/// Takes nothing until something has happened.
class Held : public std::stringbuf {
 public:
  explicit Held(std::future<void> until) : until_(std::move(until)) {}

 protected:
  std::streamsize xsputn(const char* text, std::streamsize size) override {
    if (until_.valid()) until_.get();
    return std::stringbuf::xsputn(text, size);
  }

 private:
  std::future<void> until_;
};

TEST(Session, ARequestThatWaitsCanBeCancelled) {
  const std::string before =
      framed(R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}})") +
      framed(R"({"jsonrpc":"2.0","id":2,"method":"workspace/symbol","params":{"query":""}})") +
      framed(R"({"jsonrpc":"2.0","id":3,"method":"workspace/symbol","params":{"query":""}})") +
      framed(R"({"jsonrpc":"2.0","method":"$/cancelRequest","params":{"id":2}})");
  Noticed input(before + exit_message, before.size());
  // The first answer is held back until the cancellation has been read.
  Held output(input.reached());
  std::istream in(&input);
  std::ostream out(&output);
  serve({}, in, out);
  std::istringstream answers(output.str());
  std::vector<Json> sent;
  for (int i = 0; i < 3; ++i) sent.push_back(Json::parse(read_message(answers).body));
  EXPECT_TRUE(sent[0].contains("result"));
  EXPECT_EQ(sent[1]["error"]["code"], -32800);
  EXPECT_EQ(sent[1]["id"], 2);
  EXPECT_EQ(sent[2]["result"], Json::array());
}

TEST(Session, AHeaderMayHaveOtherFields) {
  std::istringstream in("Content-Type: x\r\ncontent-length:  2 \n\n{}");
  const Framed read = read_message(in);
  EXPECT_EQ(read.kind, Framed::Kind::body);
  EXPECT_EQ(read.body, "{}");
}

TEST(Server, WantsInitializeFirstAndOnce) {
  std::vector<Json> sent;
  Server server({}, [&](const Json& message) { sent.push_back(message); });
  server.take({{"jsonrpc", "2.0"}, {"id", "a"}, {"method", "shutdown"}});
  EXPECT_EQ(sent.back()["error"]["code"], -32002);
  EXPECT_EQ(sent.back()["id"], "a");
  server.take({{"jsonrpc", "2.0"}, {"method", "textDocument/didOpen"}});
  EXPECT_EQ(sent.size(), 1);
  const Json initialize = {
      {"jsonrpc", "2.0"}, {"id", 1}, {"method", "initialize"}, {"params", Json::object()}};
  server.take(initialize);
  EXPECT_EQ(sent.back()["result"]["capabilities"]["positionEncoding"], "utf-16");
  server.take(initialize);
  EXPECT_EQ(sent.back()["error"]["code"], -32600);
}

TEST(Server, TakesUtf8WhenItIsOffered) {
  const Json capabilities = {{"general", {{"positionEncodings", {"utf-16", "utf-8"}}}}};
  Editor editor(capabilities);
  EXPECT_EQ(editor.sent.front()["result"]["capabilities"]["positionEncoding"], "utf-8");
}

TEST(Server, RefusesWhatItCannotAnswer) {
  Editor editor;
  EXPECT_EQ(editor.call("textDocument/unheardOf", {})["error"]["code"], -32601);
  EXPECT_EQ(editor.call("textDocument/hover", {{"textDocument", 3}})["error"]["code"], -32602);
  EXPECT_EQ(editor.call("textDocument/hover",
                        {{"textDocument", {{"uri", "file:///none"}}}})["error"]["code"],
            -32602);
  editor.call("shutdown", nullptr);
  EXPECT_EQ(editor.call("textDocument/hover", {})["error"]["code"], -32600);
  editor.notify("exit", nullptr);
  EXPECT_TRUE(editor.server.is_ended());
  EXPECT_EQ(editor.server.exit_code(), 0);
}

// A fault of the compiler with one document ends neither the server nor what others get.
TEST(Server, GoesOnAfterAFaultWhilePublishing) {
  std::vector<Json> sent;
  bool fails = false;
  Server server({}, [&](const Json& message) {
    const std::string text = message.dump();
    if (fails && text.find("publishDiagnostics") != text.npos &&
        text.find("a.robdef") != text.npos) {
      throw std::runtime_error("a fault");
    }
    sent.push_back(message);
  });
  server.take(
      {{"jsonrpc", "2.0"}, {"id", 1}, {"method", "initialize"}, {"params", Json::object()}});
  for (const char* uri : {"untitled:a.robdef", "untitled:b.robdef"}) {
    server.take({{"jsonrpc", "2.0"},
                 {"method", "textDocument/didOpen"},
                 {"params", {{"textDocument", {{"uri", uri}, {"version", 1}, {"text", ""}}}}}});
  }
  sent.clear();
  fails = true;
  server.publish();
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[0]["method"], "window/logMessage");
  EXPECT_EQ(sent[0]["params"]["message"], "diagnostics of untitled:a.robdef: a fault");
  EXPECT_EQ(sent[1]["params"]["uri"], "untitled:b.robdef");
  EXPECT_FALSE(server.has_to_publish());
}

// What is answered after a change that is refused is about the text as it is then.
TEST(Server, KeepsTheChangesBeforeOneThatIsRefused) {
  Editor editor;
  editor.open("a.robdef", "service a\n");
  EXPECT_THAT(editor.codes("a.robdef"), IsEmpty());
  editor.notify("textDocument/didChange",
                {{"textDocument", {{"uri", editor.uri("a.robdef")}, {"version", 2}}},
                 {"contentChanges",
                  Json::array({{{"range", to_json({{1, 0}, {1, 0}})}, {"text", "struct S\n"}},
                               {{"range", to_json({{1, 0}, {0, 0}})}, {"text", "x"}}})}});
  EXPECT_EQ(editor.sent.back()["method"], "window/logMessage");
  EXPECT_THAT(editor.codes("a.robdef"), ElementsAre("R0119"));
}

TEST(Server, RefusesARequestThatIsCancelled) {
  Editor editor;
  editor.server.refuse_cancelled({{"id", 7}, {"method", "textDocument/hover"}});
  EXPECT_EQ(editor.sent.back()["error"]["code"], -32800);
  EXPECT_EQ(editor.sent.back()["id"], 7);
}

const std::string sample =
    "service example.a\nstdver 0.10\nimport example.b\nusing example.b.Pose as P\n"
    "## one\nstruct S\n  constant int32 N 3\n  field P{list} p [readonly]\nend\n"
    "object O\n  function double f(int32 a, S s) [urgent]\n  memory double[] m [nolock]\nend\n";

// Whatever is written, and wherever the cursor is, each request has an answer.
TEST(Server, SurvivesDamagedDefinitions) {
  Editor editor;
  editor.write("example.b.robdef", "service example.b\nstruct Pose\nfield double x\nend\n");
  for (std::uint64_t seed = 1; seed <= 150; ++seed) {
    const std::string text = mutated(sample, seed);
    const std::string valid =
        Json::parse(Json(text).dump(-1, ' ', false, Json::error_handler_t::replace));
    editor.open("example.a.robdef", valid);
    editor.edit("example.a.robdef", {{2, 0}, {3, static_cast<std::uint32_t>(seed % 20)}}, "x");
    ASSERT_TRUE(editor.diagnostics("example.a.robdef").is_array()) << seed;
    const Place place{static_cast<std::uint32_t>(seed % 14), static_cast<std::uint32_t>(seed % 31)};
    for (const char* method : {"textDocument/completion", "textDocument/hover",
                               "textDocument/definition", "textDocument/documentHighlight"}) {
      editor.at(method, "example.a.robdef", place);
    }
    editor.at("textDocument/references", "example.a.robdef", place,
              {{"context", {{"includeDeclaration", true}}}});
    for (const char* method : {"textDocument/documentSymbol", "textDocument/foldingRange",
                               "textDocument/semanticTokens/full", "textDocument/formatting"}) {
      EXPECT_FALSE(editor.of(method, "example.a.robdef").is_null()) << method << seed;
    }
    const Json renamed = editor.call("textDocument/rename",
                                     {{"textDocument", {{"uri", editor.uri("example.a.robdef")}}},
                                      {"position", to_json(place)},
                                      {"newName", "other"}});
    EXPECT_TRUE(renamed.contains("result") ||
                renamed["error"]["code"] == static_cast<int>(ErrorCode::request_failed))
        << renamed;
  }
}

// Any message, damaged byte by byte.
TEST(Server, SurvivesDamagedMessages) {
  const std::string session =
      framed(R"({"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}})") +
      framed(R"({"jsonrpc":"2.0","method":"textDocument/didOpen","params":{"textDocument":)"
             R"({"uri":"untitled:a","version":1,"text":"service a\nobject O\nend\n"}}})") +
      framed(R"({"jsonrpc":"2.0","id":2,"method":"textDocument/hover","params":{"textDocument":)"
             R"({"uri":"untitled:a"},"position":{"line":1,"character":8}}})") +
      framed(R"({"jsonrpc":"2.0","id":3,"method":"shutdown"})") + exit_message;
  EXPECT_EQ(served(session).status, 0);
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    EXPECT_THAT(served(mutated(session, seed)).status, ::testing::AnyOf(0, 1)) << seed;
  }
}

}  // namespace
}  // namespace robdef::lsp
