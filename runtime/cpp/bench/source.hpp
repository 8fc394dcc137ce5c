// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rr/node.hpp"
#include "rr/pipes.hpp"
#include "rr/type.hpp"
#include "rr/wires.hpp"

/// The service of the benchmarks of streams: a pipe and a wire that only the service sends on.
namespace bench {

using Samples = rr::Array<double>;

extern const rr::Definition definition;
extern const rr::ObjectType source_type;
inline constexpr rr::Member members[] = {rr::pipe<Samples>("samples", rr::readonly),
                                         rr::wire<Samples>("level", rr::readonly)};

class SourceStub : public virtual rr::Stub {
 public:
  [[nodiscard]] const rr::ObjectType& rr_object_type() const override { return source_type; }
  rr::Pipe<Samples> samples() { return {*this, members[0]}; }
  rr::Wire<Samples> level() { return {*this, members[1]}; }
};

inline constexpr const rr::ObjectType* objects[] = {&source_type};
inline constinit const rr::ObjectType source_type{
    "bench.streams.Source", definition, {}, members, []() -> std::shared_ptr<rr::Stub> {
      return std::make_shared<SourceStub>();
    }};
inline constinit const rr::Definition definition{"bench.streams",
                                                 "service bench.streams\n"
                                                 "stdver 0.10\n"
                                                 "object Source\n"
                                                 "  pipe double[] samples [readonly]\n"
                                                 "  wire double[] level [readonly]\n"
                                                 "end\n",
                                                 {0, 10, 0, 0},
                                                 {},
                                                 {},
                                                 {},
                                                 objects};

class Source final : public rr::Skeleton {
 public:
  [[nodiscard]] const rr::ObjectType& rr_object_type() const override { return source_type; }
  void rr_dispatch(std::size_t, rr::Request&) override {}
  std::shared_ptr<rr::Skeleton> rr_child(std::size_t, const rr::ObjectIndex&) override {
    return nullptr;
  }
  [[nodiscard]] rr::PipeServer<Samples> samples() const { return {*this, members[0]}; }
  [[nodiscard]] rr::WireServer<Samples> level() const { return {*this, members[1]}; }
};

}  // namespace bench
