// SPDX-License-Identifier: Apache-2.0
// The arm of the tests of C#, served in C++: prints its URL, and ends with its input.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <mutex>
#include <string>
#include <thread>

#include "experimental/arm.hpp"
#include "rr/node.hpp"

namespace {

namespace a = experimental::arm;

class Arm final : public a::ArmDefault {
 public:
  Arm() {
    samples().on_connect([](rr::PipeEndpoint<double> end) {
      end.on_packet([end](const double& packet) mutable { end.send(packet * 2); }).detach();
    });
    force().on_out([wire = force()](a::Vector3 value, const rr::TimeSpec&, std::uint32_t) {
      value.x += 1;
      wire.set_in(value);
    });
  }

  std::string get_note() override {
    const std::lock_guard lock(mutex_);
    return notes_[rr::ServiceContext::current_client()];
  }
  void set_note(const std::string& value) override {
    const std::lock_guard lock(mutex_);
    notes_[rr::ServiceContext::current_client()] = value;
  }
  std::int32_t get_calls() override { return calls_; }
  rr::Array<std::int32_t> get_collected() override {
    const std::lock_guard lock(mutex_);
    return collected_;
  }
  double add(double a, double b) override {
    ++calls_;
    return a + b;
  }
  void fail(const std::string& why) override { throw a::Stuck(why, "by.test", 5.5); }
  std::optional<a::Pose> move(const std::optional<a::Pose>& target) override {
    moved(target->x, target->label);
    return a::Pose{target->x + 1, target->label};
  }
  void wait_long() override { std::this_thread::sleep_for(std::chrono::seconds(2)); }
  rr::VarValue echo(const rr::VarValue& value) override { return value; }
  rr::Array<double> numbers(const rr::Array<double>& values) override { return values; }
  std::shared_ptr<a::JointSkeleton> get_joints(std::int32_t index) override {
    if (index != 3) throw rr::Error(rr::ErrorCode::invalid_argument, "there is no such joint");
    return joint_;
  }
  std::shared_ptr<rr::Skeleton> get_anything() override { return joint_; }
  void broadcast(double packet) override {
    for (rr::PipeEndpoint<double>& end : samples().endpoints()) end.send(packet);
  }
  std::int32_t ask_back(std::int32_t question) override {
    return ask(rr::ServiceContext::current_client(), question) + 1;
  }
  std::shared_ptr<rr::ArrayMemorySource<double>> buffer() override { return buffer_; }
  std::shared_ptr<rr::MultiMemorySource<double>> grid() override { return grid_; }
  std::shared_ptr<rr::ArrayMemorySource<a::Sample>> records() override { return records_; }
  rr::Sequence<std::int32_t> count(std::int32_t limit) override {
    for (std::int32_t i = 0; i < limit; ++i) co_yield i;
  }
  rr::Sequence<void, std::int32_t> collect() override {
    while (true) {
      const std::int32_t value = co_await rr::taken<std::int32_t>;
      if (value == -2) throw a::Stuck("-2 is not collected");
      if (value < 0) co_return;
      const std::lock_guard lock(mutex_);
      std::vector<std::int32_t> all(collected_.begin(), collected_.end());
      all.push_back(value);
      collected_ = all;
    }
  }
  rr::Sequence<std::int32_t, std::int32_t> twice() override {
    while (true) {
      const std::int32_t value = co_await rr::taken<std::int32_t>;
      co_yield 2 * value;
    }
  }

 private:
  std::shared_ptr<a::JointDefault> joint_ = std::make_shared<a::JointDefault>();
  std::shared_ptr<rr::StoredArrayMemory<double>> buffer_ =
      std::make_shared<rr::StoredArrayMemory<double>>(1000);
  std::shared_ptr<rr::StoredMultiMemory<double>> grid_ =
      std::make_shared<rr::StoredMultiMemory<double>>(
          rr::MultiArray<double>{{20, 30}, rr::Array<double>(600)});
  std::shared_ptr<rr::StoredArrayMemory<a::Sample>> records_ =
      std::make_shared<rr::StoredArrayMemory<a::Sample>>(10);
  std::atomic<std::int32_t> calls_{0};
  std::mutex mutex_;
  std::map<std::uint32_t, std::string> notes_;
  rr::Array<std::int32_t> collected_;
};

}  // namespace

int main() {
  rr::Node node;
  const rr::Service service = node.register_service("arm", std::make_shared<Arm>());
  std::printf("rr+tcp://127.0.0.1:%d/?service=arm\n",
              static_cast<int>(node.listen_tcp(0, "127.0.0.1")));
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) {
  }
  return 0;
}
