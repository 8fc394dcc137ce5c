// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/board.hpp"

#include <cstddef>

namespace rr::testing {
namespace {

constexpr std::string_view definition_text =
    "service test.board\n"
    "stdver 0.10\n"
    "exception Jam\n"
    "struct Note\n"
    "  field string text\n"
    "  field double[] numbers\n"
    "end\n"
    "object Board\n"
    "  callback void ping()\n"
    "  callback int32 sum(int32 a, int32 b)\n"
    "  callback Note describe(string text, double[] numbers)\n"
    "  callback double fail(string text)\n"
    "  function double run(string what)\n"
    "  function int32{generator} count_to(int32 limit)\n"
    "  function string{generator} names(string label)\n"
    "  function Note{generator} notes()\n"
    "  function void collect(string label, double{generator} value)\n"
    "  function double{generator} running_sum(double start, double{generator} value)\n"
    "  event note_down(string text)\n"
    "  objref Board child\n"
    "end\n";

constexpr Field note_fields[] = {
    field<std::string>("text", offsetof(Note, text)),
    field<Array<double>>("numbers", offsetof(Note, numbers)),
};

constexpr Parameter sum_parameters[] = {parameter<std::int32_t>("a"), parameter<std::int32_t>("b")};
constexpr Parameter describe_parameters[] = {parameter<std::string>("text"),
                                             parameter<Array<double>>("numbers")};
constexpr Parameter text_parameters[] = {parameter<std::string>("text")};
constexpr Parameter run_parameters[] = {parameter<std::string>("what")};
constexpr Parameter limit_parameters[] = {parameter<std::int32_t>("limit")};
constexpr Parameter label_parameters[] = {parameter<std::string>("label")};
constexpr Parameter start_parameters[] = {parameter<double>("start")};

constexpr Member members[] = {
    callback<void>("ping"),
    callback<std::int32_t>("sum", sum_parameters),
    callback<std::optional<Note>>("describe", describe_parameters),
    callback<double>("fail", text_parameters),
    function<double>("run", run_parameters),
    generator<std::int32_t, void>("count_to", limit_parameters),
    generator<std::string, void>("names", label_parameters),
    generator<std::optional<Note>, void>("notes"),
    generator<void, double>("collect", label_parameters),
    generator<double, double>("running_sum", start_parameters),
    event("note_down", text_parameters),
    objref("child", "test.board.Board"),
};
constexpr Member stray_member = callback<void>("stray");

constexpr ExceptionType exceptions[] = {
    {"test.board.Jam", [](const Error& error) { throw Jam(error); }}};
constexpr const RecordType* records[] = {&rr_Note};
constexpr const ObjectType* objects[] = {&rr_Board};

}  // namespace

constinit const RecordType rr_Note{RecordKind::struct_, "test.board.Note", note_fields,
                                   record_operations<Note>};
constinit const ObjectType rr_Board{
    "test.board.Board", rr_board_definition, {}, members, [] {
      return std::static_pointer_cast<Stub>(std::make_shared<BoardStub>());
    }};
constinit const Definition rr_board_definition{"test.board", definition_text, {0, 10, 0, 0}, {},
                                               records,      exceptions,      objects};

void BoardSkeleton::rr_dispatch(std::size_t place, Request& request) {
  std::string text;
  switch (place) {
    case run_place: {
      request.read(text);
      const double result = run(text);
      return request.answer(&result);
    }
    case count_to_place: {
      std::int32_t limit = 0;
      request.read(limit);
      return request.answer(count_to(limit));
    }
    case names_place:
      request.read(text);
      return request.answer(names(std::move(text)));
    case notes_place:
      return request.answer(notes());
    case collect_place:
      request.read(text);
      return request.answer(collect(std::move(text)));
    case running_sum_place: {
      double start = 0;
      request.read(start);
      return request.answer(running_sum(start));
    }
    default:
      return;
  }
}

std::shared_ptr<Skeleton> BoardSkeleton::rr_child(std::size_t /*place*/,
                                                  const ObjectIndex& /*index*/) {
  return get_child();
}

void BoardSkeleton::stray(std::uint32_t client) const {
  rr_call_back<void>(stray_member, {}, client);
}

namespace {

Sequence<std::int32_t> count(std::function<void(std::int32_t)> on_step, std::int32_t limit,
                             std::shared_ptr<void> /*held*/) {
  for (std::int32_t value = 1; value <= limit; ++value) {
    if (on_step) on_step(value);
    co_yield value;
  }
}

}  // namespace

Sequence<std::int32_t> Board::count_to(std::int32_t limit) {
  if (limit == -1) throw Error(ErrorCode::permission_denied, "no generator for you");
  return on_count_to ? on_count_to(limit) : count(on_step, limit, held);
}

Sequence<std::string> Board::names(std::string label) {
  co_yield "north " + label;
  co_yield "south " + label;
  throw Jam("stuck at " + label, "deep", Array<double>{0.5, -0.25});
}

Sequence<std::optional<Note>> Board::notes() {
  const Note first{"first", {1, 2}};  // g++ 12 takes no list of items in the co_yield itself
  co_yield first;
  co_yield std::nullopt;
  const Note last{"last", Array<double>(100'000)};
  co_yield last;
}

Sequence<void, double> Board::collect(std::string label) {
  for (int count = 0; count < 2; ++count) {
    const double value = co_await taken<double>;
    if (on_collect) on_collect(label, value);
  }
  co_await taken<double>;
}

Sequence<double, double> Board::running_sum(double start) {
  while (start < 100) {
    start += co_await taken<double>;
    co_yield start;
  }
  co_await taken<double>;
  co_await taken<double>;
}

}  // namespace rr::testing
