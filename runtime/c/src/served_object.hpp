// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "rr/mutex.hpp"
#include "rr/pipes.hpp"
#include "rr/service.hpp"
#include "rr/skeleton.hpp"
#include "rr/wires.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/request.hpp"
#include "runtime/c/src/tables.hpp"

/// Objects that services offer, whose members are a program's.
namespace rr::capi {

class RawSkeleton final : public Skeleton {
 public:
  using Functions = std::shared_ptr<const Handler<rr_object_handler>>;
  RawSkeleton(std::shared_ptr<const OwnedObjectType> type, Functions handler);

  /// A node offers the object: what is constant stays with it.
  void join(const std::shared_ptr<Keeper>& keeper);
  [[nodiscard]] const std::shared_ptr<const OwnedObjectType>& type() const { return type_; }
  [[nodiscard]] const Member& member(std::uint32_t place, MemberKind kind) const {
    return type_->member(place, kind);
  }
  void set_memory(std::uint32_t place, std::shared_ptr<MemorySource> memory);
  /// Asks for the value of a wire. Throws rr::Error.
  [[nodiscard]] std::shared_ptr<void> peek(std::uint32_t kind, std::uint32_t place) const;

  [[nodiscard]] const ObjectType& rr_object_type() const override { return type_->type(); }
  void rr_attached(ServiceContext& context, const std::string& path) override;
  void rr_released(const std::string& path) override;
  void rr_dispatch(std::size_t place, Request& request) override;
  std::shared_ptr<Skeleton> rr_child(std::size_t place, const ObjectIndex& index) override;
  std::shared_ptr<MemorySource> rr_memory(std::size_t place) override;
  [[nodiscard]] bool rr_has_monitor() const override;
  bool rr_monitor_enter(std::chrono::milliseconds timeout) override;
  void rr_monitor_exit() override;

  using Skeleton::rr_ask_client;
  using Skeleton::rr_fire;
  using Skeleton::rr_start_asking;

 private:
  void ask(std::unique_ptr<rr_request> request) const;

  const std::shared_ptr<const OwnedObjectType> type_;
  const Functions handler_;
  mutable Mutex mutex_;
  std::set<std::shared_ptr<Keeper>> keepers_ RR_GUARDED_BY(mutex_);
  std::vector<std::shared_ptr<MemorySource>> memories_ RR_GUARDED_BY(mutex_);
};

/// A generator whose steps are a program's.
class RawGeneratorSource final : public GeneratorSource {
 public:
  using Functions = std::shared_ptr<const Handler<rr_generator_handler>>;
  explicit RawGeneratorSource(Functions handler) : handler_(std::move(handler)) {}
  bool rr_step(const void* parameter, void* result) override;
  void rr_close() override { end(0); }
  void rr_abort() override { end(1); }

 private:
  void end(std::int32_t aborts) const;

  const Functions handler_;
};

class RawPipeServer : public PipeServerBase {
 public:
  RawPipeServer(const RawSkeleton& object, std::uint32_t place)
      : PipeServerBase(object, object.member(place, MemberKind::pipe)) {}
  using PipeServerBase::ends;
  using PipeServerBase::send_all;
  using PipeServerBase::set_connected;
};

class RawWireServer : public WireServerBase {
 public:
  RawWireServer(const RawSkeleton& object, std::uint32_t place)
      : WireServerBase(object, object.member(place, MemberKind::wire), holding_of<Raw>) {}
  using WireServerBase::ends;
  using WireServerBase::received;
  using WireServerBase::send_all;
  using WireServerBase::set_connected;
  using WireServerBase::set_peek_in;
  using WireServerBase::set_peek_out;
  using WireServerBase::set_received;
};

}  // namespace rr::capi

struct rr_served_object {
  std::shared_ptr<rr::capi::RawSkeleton> skeleton;
};
/// Does not keep the service, which may keep who keeps this.
struct rr_service {
  std::weak_ptr<rr::ServiceContext> context;
  std::string name;
};

namespace rr::capi {

inline RawSkeleton& skeleton_of(const rr_served_object* object) {
  return *need(object, "there is no object").skeleton;
}

}  // namespace rr::capi
