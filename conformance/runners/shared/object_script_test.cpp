// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/shared/object_script.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "rr/error.hpp"

namespace rr::conformance {
namespace {

using ::testing::HasSubstr;

// Does what a test gives it when `act_later` has been answered.
class Acting final : public ObjectScript {
 public:
  explicit Acting(std::function<void()> act, Json node = Json::object())
      : ObjectScript(std::move(node)) {
    add_action("act", [act = std::move(act)](std::string_view) {
      act();
      return Json();
    });
  }
  ~Acting() override { finish(); }

 private:
  [[nodiscard]] VarValue read_parameter(const Json& /*json*/) const override { return {}; }
  [[nodiscard]] std::shared_ptr<rr::Skeleton> make_child(const std::string& /*type*/,
                                                         Json /*node*/) const override {
    return nullptr;
  }
};

// What is said when `act` was put off and has been done.
std::string said_of(std::function<void()> act) {
  ::testing::internal::CaptureStderr();
  {
    Acting script(std::move(act));
    EXPECT_TRUE(script.outcome("act_later", Json::array(), "void").is_null());
  }
  return ::testing::internal::GetCapturedStderr();
}

TEST(ObjectScript, DoesWhatIsPutOffBeforeItEnds) {
  std::atomic<int> done = 0;
  EXPECT_EQ(said_of([&] { ++done; }), "");
  EXPECT_EQ(done, 1);
}

TEST(ObjectScript, PutsOffForSomebodyWhoHasGone) {
  EXPECT_EQ(said_of([] { throw Error(ErrorCode::connection_error, "the client has left"); }), "");
}

TEST(ObjectScript, SaysWhatFailsOfWhatIsPutOffAndGoesOn) {
  EXPECT_THAT(said_of([] { throw std::runtime_error("no such script"); }),
              HasSubstr("act_later: no such script"));
  EXPECT_THAT(said_of([] { throw 5; }), HasSubstr("act_later: "));
}

TEST(ObjectScript, DoesWhatAnOutcomeSaysWhateverTheFunctionIsCalled) {
  int done = 0;
  Acting script([&] { ++done; }, Json::parse(R"({"functions": {
    "press": [{"return": 1}, {"does": "act"}],
    "act": [{"does": null, "return": 5}],
    "wish": [{"does": "nothing_known"}]}})"));
  const Json none = Json::array();
  EXPECT_EQ(script.outcome("press", none, "int32"), Json(1));
  EXPECT_EQ(done, 0);
  EXPECT_TRUE(script.outcome("press", none, "void").is_null());
  EXPECT_EQ(done, 1);
  EXPECT_EQ(script.outcome("act", none, "int32"), Json(5));
  EXPECT_EQ(done, 1);
  EXPECT_THROW(script.outcome("wish", none, "void"), std::runtime_error);
}

TEST(ObjectScript, KnowsFunctionsByTheirNamesOtherwise) {
  int done = 0;
  // The recorded value of what the function does says nothing new.
  Acting script([&] { ++done; }, Json::parse(R"({"functions": {"act": [{"return": 5}]}})"));
  EXPECT_TRUE(script.outcome("act", Json::array(), "int32").is_null());
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace rr::conformance
