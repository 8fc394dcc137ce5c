// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include "rr/call.hpp"
#include "runtime/c/src/tables.hpp"
#include "runtime/cpp/src/client/memory_transfer.hpp"
#include "runtime/cpp/src/client/session.hpp"

namespace rr::capi {

/// One transfer of pods or namedarrays in pieces that the program takes or gives as elements.
class PieceTransfer final : public Completion, public std::enable_shared_from_this<PieceTransfer> {
 public:
  using Direction = client::MemoryTransfer::Direction;
  using Numbers = client::MemoryTransfer::Numbers;

  /// Throws rr::Error (invalid_argument) without the function that the direction needs.
  PieceTransfer(const RawStub& stub, const Member& member, Direction direction, Numbers position,
                Numbers count, std::size_t size, const rr_memory_pieces* given);

  /// In the thread of the caller. Throws rr::Error.
  void run();
  /// Goes on by itself, one request at a time; the functions are called on threads of the node.
  void start(std::unique_ptr<Completion> completion);

  void* result() override { return nullptr; }
  void succeed() override;
  void fail(std::exception_ptr error) override { completion_->fail(std::move(error)); }

 private:
  void go_on();
  Outgoing request();
  void hand_over();

  const std::shared_ptr<const ClientTables> tables_;  // of the member
  const std::shared_ptr<Session> session_;
  const std::chrono::milliseconds timeout_;
  const CallTerms terms_;
  const Direction direction_;
  const rr_memory_pieces functions_;
  std::unique_ptr<Completion> completion_;
  client::MemoryTransfer transfer_;
  std::uint32_t limit_ = 0;
  bool is_asking_ = true;
  Raw data_;  // of the piece
  std::vector<Parameter> parameters_;
  std::vector<const void*> values_;
};

}  // namespace rr::capi
