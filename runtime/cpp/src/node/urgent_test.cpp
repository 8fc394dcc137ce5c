// SPDX-License-Identifier: Apache-2.0
// What `urgent` members overtake, and what they do not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <boost/asio/use_future.hpp>
#include <future>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "rr/async.hpp"
#include "runtime/cpp/src/node/testing/gate.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/raw_client.hpp"

namespace rr::testing {
namespace {

using boost::asio::use_future;
using ::testing::ElementsAre;

extern const ObjectType rr_Siren;

constexpr std::string_view siren_text =
    "service test.siren\n"
    "stdver 0.10\n"
    "object Siren\n"
    "  event note(double number, uint8[] filling)\n"
    "  event alarm(double number) [urgent]\n"
    "  property double level\n"
    "  property double pressure [urgent]\n"
    "  function void work(string text)\n"
    "  function void stop(string text) [urgent]\n"
    "  objref Siren child\n"
    "end\n";

enum Place : std::size_t {
  note_place,
  alarm_place,
  level_place,
  pressure_place,
  work_place,
  stop_place,
  child_place,
};

constexpr Parameter note_parameters[] = {parameter<double>("number"),
                                         parameter<Array<std::uint8_t>>("filling")};
constexpr Parameter alarm_parameters[] = {parameter<double>("number")};
constexpr Parameter text_parameters[] = {parameter<std::string>("text")};
constexpr Member siren_members[] = {
    event("note", note_parameters),
    event("alarm", alarm_parameters, urgent),
    property<double>("level"),
    property<double>("pressure", urgent),
    function<void>("work", text_parameters),
    function<void>("stop", text_parameters, urgent),
    objref("child", "test.siren.Siren"),
};
constexpr const ObjectType* siren_objects[] = {&rr_Siren};
constinit const Definition siren_definition{"test.siren", siren_text, {0, 10, 0, 0}, {},
                                            {},           {},         siren_objects};

class SirenStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Siren; }
  auto work(const std::string& text) {
    return rr_async_call<void>(siren_members[work_place], {}, use_future, text);
  }
  auto stop(const std::string& text) {
    return rr_async_call<void>(siren_members[stop_place], {}, use_future, text);
  }
};

std::shared_ptr<Stub> make_siren() { return std::make_shared<SirenStub>(); }
constinit const ObjectType rr_Siren{
    "test.siren.Siren", siren_definition, {}, siren_members, &make_siren};

class Siren : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Siren; }
  void rr_dispatch(std::size_t member, Request& request) override {
    if (member == work_place || member == stop_place) {
      std::string text;
      request.read(text);
      if (gate) gate->pass();
      const std::lock_guard lock(mutex_);
      handled_.push_back(text.substr(0, 4));
      if (text == "fail") throw Error(ErrorCode::invalid_argument, "it has failed");
      return;
    }
    const double value = member == level_place ? 1 : 2;
    ++values;
    request.answer(&value);
  }
  std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override {
    return std::make_shared<Siren>();
  }
  void note(double number) const {
    const Array<std::uint8_t> filling(100'000);
    rr_fire_event(siren_members[note_place], number, filling);
  }
  void alarm(double number) const { rr_fire_event(siren_members[alarm_place], number); }
  std::vector<std::string> handled() {
    const std::lock_guard lock(mutex_);
    return handled_;
  }

  Gate* gate = nullptr;
  std::atomic<int> values{0};

 private:
  std::mutex mutex_;
  std::vector<std::string> handled_;
};

constexpr int notes = 60;  // 6 MB, more than a socket takes

class Urgent : public ::testing::Test {
 protected:
  void fire_notes() const {
    for (int i = 0; i < notes; ++i) siren_->note(i);
  }
  // The messages that have waited, notes as "note" and others by their member or path; the notes
  // are complete and in order.
  std::vector<std::string> receive(std::size_t others) {
    std::vector<std::string> order;
    int next = 0;
    while (order.size() < notes + others) {
      const auto message = client_.receive();
      if (!message) break;
      if (message->member == "note") {
        EXPECT_EQ(message->number("number"), next++);
      }
      order.push_back(message->member);
    }
    EXPECT_EQ(next, notes);
    return order;
  }
  static std::ptrdiff_t place_of(const std::vector<std::string>& order, const std::string& what) {
    return std::find(order.begin(), order.end(), what) - order.begin();
  }

  const std::shared_ptr<Siren> siren_ = std::make_shared<Siren>();
  Node server_;
  Service service_ = server_.register_service("siren", siren_);
  RawClient client_{server_, "siren"};
};

TEST_F(Urgent, EventsOvertakeThoseThatWaitAndStayInOrder) {
  fire_notes();
  for (int i = 0; i < 5; ++i) siren_->alarm(i);
  int alarms = 0;
  int seen = 0;
  for (int i = 0; i < notes + 5; ++i) {
    const auto message = client_.receive();
    ASSERT_TRUE(message);
    if (message->member == "alarm") {
      EXPECT_EQ(message->number("number"), alarms++);
      EXPECT_LT(seen, notes / 2);
    } else {
      EXPECT_EQ(message->number("number"), seen++);
    }
  }
  EXPECT_EQ(alarms, 5);
  EXPECT_EQ(seen, notes);
}

TEST_F(Urgent, AnswersOvertakeWhatWaitsAndOthersDoNot) {
  fire_notes();
  client_.send(EntryType::property_get_req, "siren", "level");
  client_.send(EntryType::property_get_req, "siren", "pressure");
  client_.send(EntryType::function_call_req, "siren", "stop", [](Writer& writer) {
    writer.string_element("text", "fail");
    return 1U;
  });
  ASSERT_TRUE(eventually([&] { return siren_->values == 2 && siren_->handled().size() == 1; }));
  siren_->alarm(1);  // behind the answers, in whichever order they were begun
  const auto order = receive(4);
  ASSERT_EQ(order.size(), notes + 4U);
  EXPECT_EQ(order.back(), "level");
  EXPECT_LT(place_of(order, "pressure"), notes / 2);
  EXPECT_LT(place_of(order, "stop"), notes / 2);
  EXPECT_LT(place_of(order, "alarm"), notes / 2);
}

TEST_F(Urgent, EventsDoNotOvertakeTheReleaseOfAPath) {
  EXPECT_EQ(client_.ask(EntryType::property_get_req, "siren.child", "level").error, 0);
  fire_notes();
  service_->release_path("siren.child");
  siren_->alarm(1);
  const auto order = receive(2);
  ASSERT_EQ(order.size(), notes + 2U);
  EXPECT_EQ(order[notes], "");
  EXPECT_EQ(order[notes + 1], "alarm");
}

TEST(UrgentCalls, OvertakeRequestsThatWait) {
  Gate gate;
  const auto siren = std::make_shared<Siren>();
  siren->gate = &gate;
  Node server(NodeOptions{.request_queue_limit = 100'000});
  server.register_service("siren", siren);
  const std::uint16_t port = server.listen_tcp(0, "127.0.0.1");
  Node client;
  auto stub =
      client.connect<SirenStub>("rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=siren");
  std::vector<std::future<void>> calls;
  const std::string text = "work" + std::string(500'000, 'x');
  for (int i = 0; i < 60; ++i) calls.push_back(stub->work(text));  // 30 MB
  calls.push_back(stub->stop("one "));
  calls.push_back(stub->stop("two "));
  ASSERT_TRUE(gate.has_entered());
  gate.open();
  for (auto& call : calls) call.get();
  const auto handled = siren->handled();
  ASSERT_EQ(handled.size(), 62U);
  const auto one = std::find(handled.begin(), handled.end(), "one ");
  EXPECT_LT(one - handled.begin(), 50);
  EXPECT_EQ(*(one + 1), "two ");
}

}  // namespace
}  // namespace rr::testing
