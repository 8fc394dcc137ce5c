// SPDX-License-Identifier: Apache-2.0
// A service that sends definitions without end.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/process_state.hpp"
#include "runtime/cpp/src/node/testing/raw_service.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using Answer = RawService::Answer;
using ServiceRequest = RawService::Request;

// Answers each request for a definition with the text that `text` gives for its name; the root's is
// asked for without one.
class DefiningService {
 public:
  using Text = std::function<std::string(const std::string& name)>;
  explicit DefiningService(Text text)
      : text_(std::move(text)), service_("", "x.evil.Root", [this](const ServiceRequest& request) {
          return handle(request);
        }) {}

  RawService* operator->() { return &service_; }
  [[nodiscard]] int asked() const { return asked_; }
  std::chrono::milliseconds delay{0};

 private:
  bool handle(const ServiceRequest& request) {
    if (request.type != EntryType::get_service_desc) return false;
    ++asked_;
    std::this_thread::sleep_for(delay);
    Answer answer = RawService::answer_to(request);
    answer.elements = RawService::value("servicedef", text_(request.service_type));
    service_.send(answer);
    return true;
  }

  const Text text_;
  std::atomic<int> asked_{0};
  RawService service_;
};

std::string root_that_imports(std::string_view name) {
  return "service x.evil\nstdver 0.10\nimport " + std::string(name) +
         "\nobject Root\nproperty string s\nend\n";
}

// `x.c1` imports `x.c2`, and so on without end.
std::string endless_chain(const std::string& name, std::size_t padding) {
  if (name.empty()) return root_that_imports("x.c1");
  const int number = std::stoi(name.substr(3));
  return "service " + name + "\nstdver 0.10\nimport x.c" + std::to_string(number + 1) + "\n#" +
         std::string(padding, '#') + "\nstruct S\nfield double a\nend\n";
}

TEST(DefinitionLimits, EndAChainOfImportsByTheirCount) {
  DefiningService service([](const std::string& name) { return endless_chain(name, 0); });
  Node node;
  const Error error = error_of([&] { node.connect<Stub>(service->url()); });
  EXPECT_EQ(error.code(), ErrorCode::buffer_limit_violation) << error.what();
  EXPECT_NE(error.message().find("definitions"), std::string::npos) << error.message();
  EXPECT_EQ(service.asked(), 257);
}

TEST(DefinitionLimits, EndAChainOfLargeImportsByTheirBytes) {
  DefiningService service([](const std::string& name) { return endless_chain(name, 400'000); });
  Node node;
  const std::size_t before = ProcessState::now().resident;
  const Error error = error_of([&] { node.connect<Stub>(service->url()); });
  EXPECT_EQ(error.code(), ErrorCode::buffer_limit_violation) << error.what();
  EXPECT_NE(error.message().find("bytes"), std::string::npos) << error.message();
  EXPECT_LT(service.asked(), 45);
  if (keeps_freed_memory()) return;
  EXPECT_LT(ProcessState::now().resident, before + (std::size_t{64} << 20U))
      << service->sent() << " bytes were sent";
}

TEST(DefinitionLimits, AreOptions) {
  DefiningService service([](const std::string& name) { return endless_chain(name, 10'000); });
  Node few({.definitions = {.count = 10}});
  EXPECT_EQ(code_of([&] { few.connect<Stub>(service->url()); }), ErrorCode::buffer_limit_violation);
  EXPECT_EQ(service.asked(), 11);
  Node small({.definitions = {.bytes_of_one = 5'000}});
  EXPECT_EQ(code_of([&] { small.connect<Stub>(service->url()); }),
            ErrorCode::buffer_limit_violation);
  EXPECT_EQ(service.asked(), 13);
}

TEST(DefinitionLimits, EndAServiceThatIsSlowWithEach) {
  DefiningService service([](const std::string& name) { return endless_chain(name, 0); });
  service.delay = 50ms;
  Node node({.request_timeout = 200ms, .definitions = {.timeout = 600ms}});
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(code_of([&] { node.connect<Stub>(service->url()); }), ErrorCode::request_timeout);
  EXPECT_LT(service.asked(), 20);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s);
}

TEST(DefinitionLimits, HoldForDefinitionsThatAnObjrefAsksFor) {
  std::unique_ptr<RawService> service;
  int asked = 0;
  service = std::make_unique<RawService>("", "", [&](const ServiceRequest& request) {
    Answer answer = RawService::answer_to(request);
    if (request.type == EntryType::object_type_name) {
      const bool is_root = request.path.find('.') == std::string::npos;
      answer.elements = RawService::value(
          "objecttype", std::string(is_root ? "test.counter.Counter" : "x.c1.Other"));
    } else if (request.type == EntryType::get_service_desc) {
      ++asked;
      answer.elements = RawService::value(
          "servicedef", request.service_type.empty() ? std::string(rr_definition.text)
                                                     : endless_chain(request.service_type, 0));
    } else {
      return false;
    }
    service->send(answer);
    return true;
  });
  Node node({.definitions = {.count = 20}});
  auto counter = node.connect<CounterStub>(service->url());
  EXPECT_EQ(code_of([&] { counter->get_anything(); }), ErrorCode::buffer_limit_violation);
  EXPECT_EQ(asked, 21);
}

// Lists of names that become many times their size, or take the square of their number.
TEST(DefinitionLimits, KeepNamesSmall) {
  const std::string many = [] {
    std::string text = "service x.evil\nstdver 0.10\n";
    for (int i = 0; text.size() < 480'000; ++i) text += "object O" + std::to_string(i) + "\n";
    return text + "object Root\nproperty string s\nend\n";
  }();
  const std::string wide = [] {
    std::string text = "service x.evil\nstdver 0.10\nobject Root\n";
    for (int i = 0; text.size() < 480'000; ++i) text += "implements a.O" + std::to_string(i) + "\n";
    return text + "property string s\nend\n";
  }();
  const std::string long_name = [] {
    std::string text = "service x." + std::string(200'000, 'n') + "\nstdver 0.10\nobject Root\n";
    for (int i = 0; text.size() < 480'000; ++i) text += "implements O" + std::to_string(i) + "\n";
    return text + "property string s\nend\n";
  }();
  const std::string imports = [] {
    std::string text = "service x.evil\nstdver 0.10\n";
    while (text.size() < 480'000) text += "import x.evil\n";
    return text + "object Root\nend\n";
  }();
  for (const std::string& text : {many, wide, long_name, imports}) {
    DefiningService service([&](const std::string&) { return text; });
    Node node;
    const std::size_t before = ProcessState::now().resident;
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_NE(code_of([&] { node.connect<CounterStub>(service->url()); }), ErrorCode::none);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 10s) << text.substr(0, 80);
    if (keeps_freed_memory()) continue;
    EXPECT_LT(ProcessState::now().resident, before + (std::size_t{64} << 20U))
        << text.substr(0, 80);
  }
}

}  // namespace
}  // namespace rr::testing
