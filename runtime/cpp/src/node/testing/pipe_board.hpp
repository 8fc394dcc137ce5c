// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "rr/pipes.hpp"
#include "rr/skeleton.hpp"
#include "rr/stub.hpp"
#include "rr/type.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"

/// An object with pipes of each kind, as the compiler would generate it.
namespace rr::testing {

extern const Definition rr_pipe_board_definition;
extern const ObjectType rr_PipeBoard;
extern const Member board_members[];

enum PipeBoardPlace : std::size_t {
  numbers_place,
  readings_place,
  blobs_place,
  out_place,
  in_place,
  lossy_place,
  sync_place,
  child_board_place,
};

class PipeBoardStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override;
  Pipe<double> numbers() { return {*this, board_members[numbers_place]}; }
  Pipe<std::optional<Reading>> readings() { return {*this, board_members[readings_place]}; }
  Pipe<Array<std::uint8_t>> blobs() { return {*this, board_members[blobs_place]}; }
  Pipe<std::int32_t> out() { return {*this, board_members[out_place]}; }
  Pipe<std::string> in() { return {*this, board_members[in_place]}; }
  Pipe<std::int32_t> lossy() { return {*this, board_members[lossy_place]}; }
  /// Returns when all that was sent before has been handled.
  void sync() { rr_call<void>(board_members[sync_place], {}); }
  std::shared_ptr<PipeBoardStub> get_child() {
    return rr_find_as<PipeBoardStub>(board_members[child_board_place], {});
  }
};

class PipeBoard : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override;
  void rr_dispatch(std::size_t member, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t member, const ObjectIndex& index) override;

  PipeServer<double> numbers() const { return {*this, board_members[numbers_place]}; }
  PipeServer<std::optional<Reading>> readings() const {
    return {*this, board_members[readings_place]};
  }
  PipeServer<Array<std::uint8_t>> blobs() const { return {*this, board_members[blobs_place]}; }
  PipeServer<std::int32_t> out() const { return {*this, board_members[out_place]}; }
  PipeServer<std::string> in() const { return {*this, board_members[in_place]}; }
  PipeServer<std::int32_t> lossy() const { return {*this, board_members[lossy_place]}; }

  std::function<void()> on_sync;
  std::shared_ptr<PipeBoard> child;
};

}  // namespace rr::testing
