// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/fuzz/fuzzed_service.hpp"

#include <algorithm>
#include <experimental/fuzzed.hpp>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "rr/service.hpp"
#include "runtime/cpp/fuzz/fuzzed_streams.hpp"

namespace rr::fuzz {
namespace {

namespace robdef = ::experimental::fuzzed;
using Life = std::shared_ptr<const void>;

// Wraps around, unlike the sum of two int32.
std::int32_t sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

class PropertyBoard final : public robdef::PropertyBoardDefault {
 public:
  explicit PropertyBoard(Life life) : life_(std::move(life)) {}
  std::int32_t get_failing() override { throw std::runtime_error("a failing property"); }
  void set_failing(std::int32_t value) override {
    throw Error(ErrorCode::out_of_range, "not " + std::to_string(value));
  }
  std::int32_t get_pc_value() override {
    return static_cast<std::int32_t>(ServiceContext::current_client() != 0);
  }

 private:
  const Life life_;
};

class FunctionBoard final : public robdef::FunctionBoardSkeleton {
 public:
  explicit FunctionBoard(Life life) : life_(std::move(life)) {}
  void nothing() override {}
  std::int32_t constant_value() override { return 42; }
  double add(double a, double b) override { return a + b; }
  void take_one(const std::string& text) override {
    if (text.empty()) throw Error(ErrorCode::invalid_argument, "no text");
  }
  std::string join(const std::string& a, const std::string& b, const std::string& c) override {
    return a + b + c;
  }
  Array<std::int64_t> five(std::int8_t a, std::uint16_t b, std::int64_t c, const Array<double>& d,
                           const std::string& e) override {
    return {a, b, c, static_cast<std::int64_t>(d.size()), static_cast<std::int64_t>(e.size())};
  }
  std::optional<robdef::Stats> make_stats(std::int32_t count, double mean,
                                          const std::string& label) override {
    if (count < 0) return std::nullopt;
    return robdef::Stats{count, mean, label};
  }
  std::optional<robdef::Leaf> echo_leaf(const std::optional<robdef::Leaf>& value) override {
    return value;
  }
  std::optional<std::vector<std::optional<robdef::Tree>>> echo_trees(
      const std::optional<std::vector<std::optional<robdef::Tree>>>& value) override {
    return value;
  }
  robdef::Vector3 cross(const robdef::Vector3& a, const robdef::Vector3& b) override {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  Array<robdef::Sample> echo_samples(const Array<robdef::Sample>& value) override {
    Array<robdef::Sample> copy = value;
    for (robdef::Sample& sample : copy.mutate()) ++sample.seq;
    return copy;
  }
  MultiArray<double> transpose(const MultiArray<double>& value) override { return value; }
  VarValue echo_any(const VarValue& value) override { return value; }
  std::optional<std::map<std::string, VarValue>> echo_map(
      const std::optional<std::map<std::string, VarValue>>& value) override {
    return value;
  }
  robdef::Mode next_mode(robdef::Mode value) override { return value; }
  bool all_true(const Array<bool>& flags) override {
    return std::all_of(flags.begin(), flags.end(), [](bool flag) { return flag; });
  }

  std::int32_t hold(std::int32_t value) override { return value; }
  void async_hold(std::int32_t value, Answer<std::int32_t> answer) override {
    const std::lock_guard lock(mutex_);
    if (value < 0) {
      static_cast<void>(answer.defer());  // never answered
    } else {
      held_.emplace_back(value, answer.defer());
    }
  }
  std::int32_t let_go(std::int32_t count) override {
    std::vector<Held> held;
    {
      const std::lock_guard lock(mutex_);
      held.swap(held_);
    }
    std::int32_t answered = 0;
    for (auto& [value, reply] : held) {
      if (value % 2 != 0) {
        reply.fail(std::make_exception_ptr(std::invalid_argument("odd")));
      } else {
        reply(value);
      }
      if (++answered == count) break;  // the others are dropped
    }
    return answered;
  }

 private:
  using Held = std::pair<std::int32_t, Reply<std::int32_t>>;
  const Life life_;
  std::mutex mutex_;
  std::vector<Held> held_;
};

class ErrorBoard final : public robdef::ErrorBoardDefault {
 public:
  explicit ErrorBoard(Life life) : life_(std::move(life)) {}
  void raise_service_fault(const std::string& text) override { throw robdef::ServiceFault(text); }
  void raise_probe_fault(const std::string& text) override { throw robdef::ProbeFault(text); }
  void raise_calibration_error(const std::string& text, const std::string& subname,
                               const VarValue& param) override {
    throw Error(ErrorCode::remote_error, "experimental.fuzzed.CalibrationError", text, subname,
                param);
  }
  void raise_unknown_name(const std::string& text) override {
    throw Error(ErrorCode::unknown_error, text, text);
  }
  void raise_code(std::int32_t code, const std::string& text) override {
    throw Error(static_cast<ErrorCode>(code), text);
  }
  void raise_native(const std::string& text) override { throw std::runtime_error(text); }
  double get_failing_value() override { throw Error(ErrorCode::value_not_set, "no value"); }

 private:
  const Life life_;
};

class EventBoard final : public robdef::EventBoardSkeleton {
 public:
  explicit EventBoard(Life life) : life_(std::move(life)) {}
  void fire_tick() override { tick(); }
  void fire_value_changed() override { value_changed(0.5); }
  void fire_many() override { fire_given({1.5, 2.5}, VarValue("any")); }
  void fire_hurry_tick() override { hurry_tick(3); }
  void fire_given(const Array<double>& numbers, const VarValue& value) override {
    many(1, "two", numbers, robdef::Stats{4, 4.5, "four"}, {5, 6, 7}, robdef::Sample{}, value,
         std::nullopt);
  }

 private:
  const Life life_;
};

class Child final : public robdef::ChildDefault {
 public:
  explicit Child(Life life) : life_(std::move(life)) {}
  std::string describe() override { return "a child"; }
  std::int32_t add(std::int32_t a, std::int32_t b) override {
    moved(a);
    return sum(a, b);
  }
  std::shared_ptr<robdef::ChildSkeleton> get_next_child() override {
    return std::make_shared<Child>(life_);
  }

 private:
  const Life life_;
};

class Root final : public robdef::RootDefault {
 public:
  explicit Root(Life life) : life_(std::move(life)) {}
  void rr_attached(ServiceContext& context, const std::string& /*path*/) override {
    context_ = &context;
  }

  std::shared_ptr<robdef::PropertyBoardSkeleton> get_props() override {
    return std::make_shared<PropertyBoard>(life_);
  }
  std::shared_ptr<robdef::FunctionBoardSkeleton> get_funcs() override {
    return std::make_shared<FunctionBoard>(life_);
  }
  std::shared_ptr<robdef::ErrorBoardSkeleton> get_errs() override {
    return std::make_shared<ErrorBoard>(life_);
  }
  std::shared_ptr<robdef::EventBoardSkeleton> get_events() override {
    return std::make_shared<EventBoard>(life_);
  }
  std::shared_ptr<robdef::StreamBoardSkeleton> get_streams() override {
    return make_fuzzed_streams(life_);
  }
  std::shared_ptr<robdef::ChildSkeleton> get_child() override {
    return std::make_shared<Child>(life_);
  }
  std::shared_ptr<robdef::ChildSkeleton> get_by_index(std::int32_t index) override {
    if (index > 7) throw Error(ErrorCode::invalid_argument, "no such child");
    if (index < 0) return nullptr;
    return std::make_shared<Child>(life_);
  }
  std::shared_ptr<robdef::ChildSkeleton> get_by_number(std::int32_t index) override {
    return index == 0 ? nullptr : std::make_shared<Child>(life_);
  }
  std::shared_ptr<robdef::ChildSkeleton> get_by_name(const std::string& index) override {
    if (index == "broken") throw std::runtime_error("broken");
    return std::make_shared<Child>(life_);
  }
  std::shared_ptr<robdef::NamedSkeleton> get_any_named(const std::string& /*index*/) override {
    return std::make_shared<Child>(life_);
  }
  // The same object by another path.
  std::shared_ptr<Skeleton> get_anything() override {
    if (!shared_) shared_ = std::make_shared<EventBoard>(life_);
    return shared_;
  }
  std::shared_ptr<Skeleton> get_anything_by_number(std::int32_t index) override {
    return index % 2 == 0 ? get_anything() : std::make_shared<PropertyBoard>(life_);
  }

  void release_child(const std::string& name) override {
    context_->release_path(context_->name() + "." + name);
  }
  void send_away() override { context_->disconnect(ServiceContext::current_client()); }
  void close_service() override { context_->close(); }

 private:
  const Life life_;
  ServiceContext* context_ = nullptr;
  std::shared_ptr<EventBoard> shared_;
};

}  // namespace

std::shared_ptr<Skeleton> make_fuzzed_root(std::shared_ptr<const void> life) {
  return std::make_shared<Root>(std::move(life));
}

}  // namespace rr::fuzz
