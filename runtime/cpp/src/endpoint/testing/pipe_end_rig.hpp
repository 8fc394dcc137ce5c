// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "rr/definition.hpp"
#include "rr/error.hpp"
#include "rr/stub.hpp"
#include "runtime/cpp/src/endpoint/pipe_state.hpp"
#include "runtime/cpp/src/endpoint/testing/fake_connection.hpp"

namespace rr::testing {

inline constexpr Member numbers_member = pipe<double>("numbers");

/// The side of a session that ends of pipes belong to: keeps what they send.
class FakeSide final : public endpoint::PipeSide {
 public:
  [[nodiscard]] channel::Connection& connection() const override { return fake; }
  void stream(Writer& writer, const EntryHeader& header, std::string_view metadata) override {
    const std::size_t end = 0;
    writer.entry(header, 1, end);
    writer.message({.metadata = metadata}, 1);
    fake.stream(writer);
  }
  void close(PipeEnd::State& end, bool /*may_wait*/) override {
    ++closed;
    end.finish();
  }

  mutable FakeConnection fake;
  int closed = 0;
};

/// Ends of pipes without a network.
class PipeEndTest : public ::testing::Test {
 protected:
  using End = std::shared_ptr<PipeEnd::State>;

  PipeEndTest() { core_->start(); }
  // Not by the last work that is posted, on a thread of its own.
  ~PipeEndTest() override { core_->stop(); }

  End make(const Member& member = numbers_member, std::int32_t index = 4, bool is_client = true,
           std::string path = "arm", bool is_unreliable = false) {
    return std::make_shared<PipeEnd::State>(core_, side_,
                                            PipeEnd::State::Identity{.path = std::move(path),
                                                                     .member = &member,
                                                                     .holding = member.holding,
                                                                     .index = index,
                                                                     .is_unreliable = is_unreliable,
                                                                     .is_client = is_client});
  }
  static std::shared_ptr<void> packet(double value) { return std::make_shared<double>(value); }
  static double value_of(const std::shared_ptr<const void>& packet) {
    return *static_cast<const double*>(packet.get());
  }
  template <class Run>
  static ErrorCode failure(const Run& run) {
    try {
      run();
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::none;
  }

  std::promise<std::string> log_;  // its first line
  std::once_flag logged_;
  const std::shared_ptr<endpoint::Core> core_ = std::make_shared<endpoint::Core>([this] {
    NodeOptions options;
    options.max_threads = 4;
    options.metrics.is_enabled = true;
    options.log = [this](LogLevel, std::string_view text) {
      std::call_once(logged_, [&] { log_.set_value(std::string(text)); });
    };
    return options;
  }());
  const std::shared_ptr<FakeSide> side_ = std::make_shared<FakeSide>();
};

}  // namespace rr::testing
