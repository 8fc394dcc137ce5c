// SPDX-License-Identifier: Apache-2.0
// The service that the tests in Octave use: values are kept, members of each kind do something that
// can be seen. `matlab_test_service [--port N] [--seconds N]`, on the loopback address.
#include "rr/service.hpp"

#include <unistd.h>

#include <mutex>
#include <thread>

#include "experimental/bench.hpp"
#include "rr/memories.hpp"
#include "rr/node.hpp"
#include "rr/users.hpp"
#include "runtime/matlab/test/serving.hpp"

namespace {

namespace bench = experimental::bench;

class Tool final : public bench::ToolDefault {
 public:
  explicit Tool(std::string name) : name_(std::move(name)) {}
  std::string say(const std::string& text) override {
    dropped(static_cast<std::int32_t>(text.size()));
    return name_ + ": " + text;
  }
  double question(double value) override {
    return ask(rr::ServiceContext::current_client(), value);
  }

 private:
  const std::string name_;
};

class Bench final : public bench::BenchDefault {
 public:
  Bench() {
    rr_memory_line = std::make_shared<rr::StoredArrayMemory<double>>(
        rr::Array<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
    rr::MultiArray<std::uint8_t> grid{{3, 4, 2}, rr::Array<std::uint8_t>(24)};
    for (std::size_t i = 0; i < 24; ++i) grid.items.mutate()[i] = static_cast<std::uint8_t>(i);
    rr_memory_grid = std::make_shared<rr::StoredMultiMemory<std::uint8_t>>(grid);
    rr_memory_path =
        std::make_shared<rr::StoredArrayMemory<bench::Vector3>>(rr::Array<bench::Vector3>(5));
    rr_memory_records = std::make_shared<rr::StoredArrayMemory<bench::Sample>>(
        rr::Array<bench::Sample>{bench::Sample{.sequence = 1}, bench::Sample{.sequence = 2}});
    // Of sizes that arrays in Octave do not keep.
    rr_memory_strip = std::make_shared<rr::StoredMultiMemory<std::uint8_t>>(
        rr::MultiArray<std::uint8_t>{{4}, {1, 2, 3, 4}});
    rr_memory_slab = std::make_shared<rr::StoredMultiMemory<double>>(
        rr::MultiArray<double>{{2, 3, 1}, {1, 2, 3, 4, 5, 6}});
    rr_memory_shelf = std::make_shared<rr::StoredMultiMemory<bench::Vector3>>(
        rr::MultiArray<bench::Vector3>{{2, 1}, rr::Array<bench::Vector3>(2)});
    numbers().on_connect([](rr::PipeEndpoint<double> end) {
      // Sends back the double of what comes.
      end.on_packet([end](double packet) mutable { end.send(2 * packet); }).detach();
    });
  }

  std::int32_t get_fixed() override { return 17; }
  std::int32_t add(std::int32_t a, std::int32_t b) override { return a + b; }
  void stop() override {}
  rr::MultiArray<std::uint8_t> same(const rr::MultiArray<std::uint8_t>& picture) override {
    return picture;
  }
  void lose_tool(const std::string& where) override {
    throw bench::ToolLost("the tool is lost", "where", rr::VarStringMap{{"place", where}});
  }
  void fail(const std::string& name) override {
    throw rr::Error(rr::ErrorCode::remote_error, name, "as asked for");
  }
  double nap(double seconds) override {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    return seconds;
  }
  rr::Array<std::uint8_t> image(std::uint32_t size) override {
    const std::lock_guard lock(mutex_);
    if (image_.size() != size) {
      image_ = rr::Array<std::uint8_t>(size);
      auto bytes = image_.mutate();
      for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
    }
    return image_;
  }
  void fire(std::int32_t count) override {
    for (std::int32_t i = 1; i <= count; ++i) fired(i, "number " + std::to_string(i));
    reported(bench::Report{.count = count, .text = "all", .numbers = {}, .mode = {}, .next = {}});
  }
  void show_level(double value) override {
    level().set_in(value);
    reports().set_in(
        bench::Report{.count = 1, .text = "level", .numbers = {value}, .mode = {}, .next = {}});
  }
  double level_out() override {
    const auto value = level().out();
    return value ? value->value : -1;
  }
  void send_numbers(const rr::Array<double>& packets) override {
    for (const double packet : packets) numbers().send(packet);
  }
  double consult(double question) override {
    return advise(rr::ServiceContext::current_client(), question);
  }
  void crash() override { _exit(3); }
  rr::Sequence<double> count(double limit) override {
    for (double value = 0; value < limit; ++value) co_yield value;
  }
  rr::Sequence<double, double> running_sum(double start) override {
    while (true) {
      start += co_await rr::taken<double>;
      co_yield start;
    }
  }
  std::shared_ptr<bench::ToolSkeleton> get_tool() override { return tool_; }
  std::shared_ptr<bench::ToolSkeleton> get_tools(std::int32_t index) override {
    if (index < 0) throw rr::Error(rr::ErrorCode::out_of_range, "there is no such tool");
    return std::make_shared<Tool>("tool " + std::to_string(index));
  }
  std::shared_ptr<bench::ToolSkeleton> get_named_tools(const std::string& index) override {
    return std::make_shared<Tool>(index);
  }
  std::shared_ptr<rr::Skeleton> get_any_tool() override { return tool_; }

  bool rr_has_monitor() const override { return true; }
  bool rr_monitor_enter(std::chrono::milliseconds timeout) override {
    return monitor_.try_lock_for(timeout);
  }
  void rr_monitor_exit() override { monitor_.unlock(); }

 private:
  std::shared_ptr<Tool> tool_ = std::make_shared<Tool>("the tool");
  std::mutex mutex_;
  rr::Array<std::uint8_t> image_;
  std::timed_mutex monitor_;
};

struct Served {
  explicit Served(int wanted) {
    const auto users = std::make_shared<rr::PasswordUsers>(
        "alice " + rr::PasswordUsers::hash("open sesame") + " objectlock\nbob " +
        rr::PasswordUsers::hash("me too") + " objectlock\n");
    node.register_service("bench", std::make_shared<Bench>(), {.attributes = {{"place", "roof"}}});
    node.register_service("guarded", std::make_shared<Bench>(), {.users = users});
    port = node.listen_tcp(static_cast<std::uint16_t>(wanted), "127.0.0.1");
  }
  rr::Node node{{.name = "matlab.test"}};
  std::uint16_t port = 0;
};

}  // namespace

int main(int argc, char** argv) {
  return rr::matlab::testing::serve(argc, argv,
                                    [](int port) { return std::make_unique<Served>(port); });
}
