// SPDX-License-Identifier: Apache-2.0
// A service that writes for the terminal of who uses it, or sends definitions without end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/driver/program.hpp"
#include "rr/error.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/node/testing/raw_service.hpp"

namespace robdef::testing {
namespace {

using rr::EntryType;
using rr::testing::RawService;
using ::testing::HasSubstr;

// Sets the title of the window, clears it, and turns the direction of writing.
constexpr std::string_view steering = "\x1b]0;OWNED\x07\x1b[2J\u009b31m\u202e";

// Nothing that a terminal would act upon; line breaks and tabs are for the reader.
void expect_harmless(const std::string& text) {
  for (const char c : text) {
    EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t')
        << static_cast<int>(c) << " in " << text;
  }
  for (const std::string_view part : {"\x7f", "\u009b", "\u202e"}) {
    EXPECT_EQ(text.find(part), std::string::npos) << text;
  }
}

class HostileService : public ::testing::Test {
 protected:
  HostileService()
      : service_(
            "service x.evil\nstdver 0.10\nexception Bad\nobject Root\nproperty string s\n"
            "function void boom()\nfunction void strange()\nend\n",
            "x.evil.Root", [this](const RawService::Request& request) { return answer(request); }) {
  }

  Ended run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, service_.url());
    return run_robdef(folder_, arguments, "", "");
  }

 private:
  bool answer(const RawService::Request& request) {
    RawService::Answer answer = RawService::answer_to(request);
    if (request.type == EntryType::property_get_req) {
      answer.elements = RawService::value("value", "text " + std::string(steering));
    } else if (request.type == EntryType::function_call_req) {
      answer.error = static_cast<std::uint16_t>(rr::ErrorCode::remote_error);
      answer.elements = RawService::error_elements(
          "x.evil.Bad" + std::string(steering),
          "message " + std::string(steering) + "\n" + std::string(1'000'000, 'x'));
    } else {
      return false;
    }
    return service_.send(answer);
  }

  RawService service_;
  TemporaryFolder folder_;
};

TEST_F(HostileService, DescribesItselfInTextThatIsOnlyText) {
  const Ended whole = run({"describe"});
  EXPECT_EQ(whole.status, 0) << whole.err;
  expect_harmless(whole.out);
  EXPECT_THAT(whole.out, HasSubstr("property string s\n"));
  const Ended member = run({"describe", "s"});
  EXPECT_EQ(member.status, 0) << member.err;
  expect_harmless(member.out);
  EXPECT_THAT(member.out, HasSubstr("property string s\n"));
  const Ended json = run({"describe", "--format=json"});
  EXPECT_EQ(json.status, 0) << json.err;
  expect_harmless(json.out);
  EXPECT_THAT(json.out, HasSubstr("x.evil"));
}

TEST_F(HostileService, GivesValuesAsJsonThatIsOnlyText) {
  const Ended value = run({"get", "s"});
  EXPECT_EQ(value.status, 0) << value.err;
  expect_harmless(value.out);
  EXPECT_EQ(value.out, "\"text \\u001b]0;OWNED\\u0007\\u001b[2J\\u009b31m\\u202e\"\n");
}

TEST_F(HostileService, FailsWithMessagesThatAreOnlyTextAndNoFloodOfIt) {
  const Ended call = run({"call", "boom"});
  EXPECT_EQ(call.status, 1);
  expect_harmless(call.err);
  EXPECT_LT(call.err.size(), 2200U);
  EXPECT_THAT(call.err, HasSubstr("message \\x1b]0;OWNED"));
}

TEST(HostileDefinitions, AreRefusedInTextThatIsOnlyText) {
  const std::string text =
      "## " + std::string(steering) + "\nservice x.evil\nstdver 0.10\nobject Root\nend\n";
  RawService service(text, "x.evil.Root", [](const RawService::Request&) { return false; });
  const TemporaryFolder folder;
  const Ended ended = run_robdef(folder, {"describe", service.url()}, "", "");
  EXPECT_EQ(ended.status, 1);
  expect_harmless(ended.out);
  expect_harmless(ended.err);
  EXPECT_THAT(ended.err, HasSubstr("R0101"));
}

TEST(EndlessDefinitions, EndWithAnErrorOfTheCommand) {
  std::atomic<RawService*> service = nullptr;
  RawService raw("", "x.evil.Root", [&](const RawService::Request& request) {
    if (request.type != EntryType::get_service_desc) return false;
    const std::string& name = request.service_type;
    const int number = name.empty() ? 0 : std::stoi(name.substr(3));
    RawService::Answer answer = RawService::answer_to(request);
    answer.elements = RawService::value(
        "servicedef", "service " + (name.empty() ? "x.evil" : name) + "\nstdver 0.10\nimport x.c" +
                          std::to_string(number + 1) + "\nobject Root\nend\n");
    return service.load()->send(answer);
  });
  service = &raw;
  const TemporaryFolder folder;
  const Ended ended = run_robdef(folder, {"describe", raw.url()}, "", "");
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, HasSubstr("more definitions than this client takes, 256"));
}

// A service need not have what it says that it has.
TEST(EndlessMemories, AreReadInPartsOnly) {
  std::atomic<RawService*> service = nullptr;
  std::atomic<std::uint64_t> length = 0;
  const auto answer_to = [&](const RawService::Request& request) {
    if (request.type != EntryType::memory_get_param) return false;
    RawService::Answer answer = RawService::answer_to(request);
    answer.elements = RawService::value("return", length.load());
    return service.load()->send(answer);
  };
  RawService raw(
      "service x.evil\nstdver 0.10\npod Page\nfield uint8[4096] bytes\nend\n"
      "object Root\nmemory uint8[] bytes\nmemory Page[] pages\nend\n",
      "x.evil.Root", answer_to);
  service = &raw;
  const TemporaryFolder folder;
  const auto refusal = [&](const char* member, std::uint64_t count) {
    length = count;
    const Ended ended = run_robdef(folder, {"get", raw.url(), member, "--timeout=1"}, "", "");
    EXPECT_EQ(ended.status, 1);
    EXPECT_EQ(ended.out, "");
    return ended.err;
  };
  EXPECT_THAT(refusal("bytes", 0xFFFFFFFF),
              HasSubstr("member bytes: 4294967295 items are more than 64 MiB; say with `--count` "
                        "how many to read"));
  EXPECT_THAT(refusal("pages", 16'385),
              HasSubstr("member pages: 16385 items are more than 64 MiB"));
  EXPECT_THAT(refusal("bytes", 0xFFFFFFFFFFFFFFFF), HasSubstr("items are more than 64 MiB"));
}

}  // namespace
}  // namespace robdef::testing
