// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "rr/node.hpp"
#include "test/stress.hpp"

namespace rr::stress {

using test::stress::BenchStub;
using test::stress::PartStub;
using test::stress::Stamp;

/// A client with something of everything, whose service is about to die.
class Mourner {
 public:
  /// Throws rr::Error.
  Mourner(const NodeOptions& options, std::string url);

  /// What a client may do, with its end.
  struct Call {
    std::string name;
    std::function<void()> run;
  };
  /// Requests: each waits for an answer.
  std::vector<Call> requests();
  /// What waits for something to come by itself, `limit` at most, and says nothing but whether.
  std::vector<std::function<bool()>> waits(std::chrono::milliseconds limit);

  Client<BenchStub> connect();
  Client<BenchStub>& client() { return client_; }
  PipeEndpoint<std::optional<Stamp>>& echo() { return echo_; }
  WireConnection<std::optional<Stamp>>& mirror() { return mirror_; }

 private:
  Node node_;
  const std::string url_;
  Client<BenchStub> client_;
  std::shared_ptr<PartStub> part_;
  PipeEndpoint<std::optional<Stamp>> echo_;
  WireConnection<std::optional<Stamp>> mirror_;
  Generator<std::uint64_t> counting_;
  Generator<std::uint64_t> closing_;
  Generator<std::uint64_t> aborting_;
};

/// How one call ended.
struct Ending {
  std::string name;
  ErrorCode code = ErrorCode::none;
  std::string text;
  std::chrono::milliseconds took{0};
};

/// Runs all of them at once, each in a thread, and `meanwhile` when all have begun.
std::vector<Ending> run_at_once(std::vector<Mourner::Call> calls,
                                const std::function<void()>& meanwhile = nullptr);

}  // namespace rr::stress
