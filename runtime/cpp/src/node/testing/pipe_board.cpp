// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/pipe_board.hpp"

namespace rr::testing {
namespace {

constexpr std::string_view definition_text =
    "service test.pipes\n"
    "stdver 0.10\n"
    "import test.counter\n"
    "object PipeBoard\n"
    "  pipe double numbers\n"
    "  pipe test.counter.Reading readings\n"
    "  pipe uint8[] blobs\n"
    "  pipe int32 out [readonly]\n"
    "  pipe string in [writeonly]\n"
    "  pipe int32 lossy [unreliable]\n"
    "  function void sync()\n"
    "  objref PipeBoard child\n"
    "end\n";

constexpr const Definition* imports[] = {&rr_definition};
constexpr const ObjectType* objects[] = {&rr_PipeBoard};

}  // namespace

constinit const Member board_members[] = {
    pipe<double>("numbers"),
    pipe<std::optional<Reading>>("readings"),
    pipe<Array<std::uint8_t>>("blobs"),
    pipe<std::int32_t>("out", readonly),
    pipe<std::string>("in", writeonly),
    pipe<std::int32_t>("lossy", unreliable),
    function<void>("sync"),
    objref("child", "test.pipes.PipeBoard"),
};

constinit const ObjectType rr_PipeBoard{
    "test.pipes.PipeBoard",
    rr_pipe_board_definition,
    {},
    board_members,
    []() -> std::shared_ptr<Stub> { return std::make_shared<PipeBoardStub>(); }};
constinit const Definition rr_pipe_board_definition{
    "test.pipes", definition_text, {0, 10, 0, 0}, imports, {}, {}, objects};

const ObjectType& PipeBoardStub::rr_object_type() const { return rr_PipeBoard; }
const ObjectType& PipeBoard::rr_object_type() const { return rr_PipeBoard; }

void PipeBoard::rr_dispatch(std::size_t member, Request& request) {
  if (member != sync_place) return;
  request.read();
  if (on_sync) on_sync();
}

std::shared_ptr<Skeleton> PipeBoard::rr_child(std::size_t /*member*/,
                                              const ObjectIndex& /*index*/) {
  return child;
}

}  // namespace rr::testing
