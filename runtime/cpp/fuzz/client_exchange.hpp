// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "rr/node.hpp"
#include "runtime/cpp/fuzz/attempts.hpp"
#include "runtime/cpp/fuzz/hostile_channel.hpp"

namespace rr::fuzz {

/// What a program does with a service: connects to it, uses some of it, and leaves it.
using ClientProgram = void(Node& node, std::string_view url, Attempts& attempts);

/// Clients under fire. Aborts the process when one breaks a promise: everything asked ends in time
/// with a value or an rr::Error, sessions and connections are gone after it, threads and memory do
/// not grow, and an honest service is used as if nothing had been.
class ClientExchange {
 public:
  explicit ClientExchange(std::span<ClientProgram* const> programs);

  /// The first byte says which program is run and whether the client offers format 4; the service
  /// follows the others.
  void run(std::span<const std::byte> input);

 private:
  // A client that offers format 4, or does not.
  struct Side {
    Side(bool offers_v4, std::span<ClientProgram* const> programs);
    void run(ClientProgram* program, std::span<const std::byte> input, Attempts& attempts);

    std::vector<std::vector<int>> outcomes;  // of each program with an honest service
    const RecordedService recorded;
    const std::shared_ptr<HostileChannel> channel;
    Node node;
  };

  void check_all();

  const std::span<ClientProgram* const> programs_;
  Side v2_;
  Side v4_;
  std::uint64_t runs_ = 0;
  std::size_t memory_ = 0;  // allocated after the first check
};

}  // namespace rr::fuzz
