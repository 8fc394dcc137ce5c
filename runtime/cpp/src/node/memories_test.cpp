// SPDX-License-Identifier: Apache-2.0
#include "rr/memories.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <boost/asio/use_future.hpp>
#include <complex>
#include <cstddef>
#include <numeric>
#include <thread>

#include "rr/async.hpp"
#include "rr/call.hpp"
#include "rr/complex.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {

/// A pod of 111 bytes at most in format 2.
struct Sample {
  std::uint32_t seq = 0;
  double stamp = 0;
  std::array<float, 3> accel{};
  bool operator==(const Sample&) const = default;
};
struct Vector3 {
  double x = 0;
  double y = 0;
  double z = 0;
  bool operator==(const Vector3&) const = default;
};
extern const RecordType rr_Sample;
extern const RecordType rr_Vector3;

}  // namespace rr::testing

template <>
inline constexpr const rr::Type& rr::type_of<rr::testing::Sample> = rr::testing::rr_Sample;
template <>
inline constexpr const rr::Type& rr::type_of<rr::testing::Vector3> = rr::testing::rr_Vector3;

namespace rr::testing {

namespace {

constexpr std::string_view text =
    "service test.memories\n"
    "stdver 0.10\n"
    "pod Sample\n"
    "  field uint32 seq\n"
    "  field double stamp\n"
    "  field single[3] accel\n"
    "end\n"
    "namedarray Vector3\n"
    "  field double x\n"
    "  field double y\n"
    "  field double z\n"
    "end\n"
    "object Board\n"
    "  memory double[] numbers\n"
    "  memory bool[] flags\n"
    "  memory cdouble[] waves\n"
    "  memory Sample[] samples\n"
    "  memory Vector3[] points\n"
    "  memory int16[*] grid\n"
    "  memory Sample[*] sample_grid\n"
    "  memory double[] fixed [readonly]\n"
    "  memory double[] hidden [writeonly]\n"
    "  memory double[] missing\n"
    "end\n";

constexpr Field sample_fields[] = {
    field<std::uint32_t>("seq", offsetof(Sample, seq)),
    field<double>("stamp", offsetof(Sample, stamp)),
    field<std::array<float, 3>>("accel", offsetof(Sample, accel)),
};

enum Place : std::size_t {
  number_memory_place,
  flags_place,
  waves_place,
  samples_place,
  points_place,
  grid_place,
  sample_grid_place,
  fixed_place,
  hidden_place,
  missing_place,
};
constexpr Member members[] = {
    memory<Array<double>>("numbers"),
    memory<Array<bool>>("flags"),
    memory<Array<std::complex<double>>>("waves"),
    memory<Array<Sample>>("samples"),
    memory<Array<Vector3>>("points"),
    memory<MultiArray<std::int16_t>>("grid"),
    memory<MultiArray<Sample>>("sample_grid"),
    memory<Array<double>>("fixed", readonly),
    memory<Array<double>>("hidden", writeonly),
    memory<Array<double>>("missing"),
};
constexpr const RecordType* records[] = {&rr_Sample, &rr_Vector3};

std::shared_ptr<Stub> make_board();
extern const ObjectType rr_Board;
constexpr const ObjectType* objects[] = {&rr_Board};
constexpr Definition definition{.name = "test.memories",
                                .text = text,
                                .version = {0, 10, 0, 0},
                                .imports = {},
                                .records = records,
                                .exceptions = {},
                                .objects = objects};
constexpr ObjectType rr_Board{"test.memories.Board", definition, {}, members, make_board};

class BoardStub : public virtual Stub {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Board; }

  ArrayMemory<double> numbers() { return {*this, members[number_memory_place]}; }
  ArrayMemory<bool> flags() { return {*this, members[flags_place]}; }
  ArrayMemory<std::complex<double>> waves() { return {*this, members[waves_place]}; }
  ArrayMemory<Sample> samples() { return {*this, members[samples_place]}; }
  ArrayMemory<Vector3> points() { return {*this, members[points_place]}; }
  MultiMemory<std::int16_t> grid() { return {*this, members[grid_place]}; }
  MultiMemory<Sample> sample_grid() { return {*this, members[sample_grid_place]}; }
  ArrayMemory<double> fixed() { return {*this, members[fixed_place]}; }
  ArrayMemory<double> hidden() { return {*this, members[hidden_place]}; }
  ArrayMemory<double> missing() { return {*this, members[missing_place]}; }
};

std::shared_ptr<Stub> make_board() { return std::make_shared<BoardStub>(); }

// Notes what it is asked for.
class Numbers final : public StoredArrayMemory<double> {
 public:
  using StoredArrayMemory::StoredArrayMemory;
  void read(std::uint64_t position, std::span<double> items) override {
    if (delay.count() != 0) std::this_thread::sleep_for(delay);
    ++reads;
    largest = std::max(largest.load(), items.size());
    StoredArrayMemory::read(position, items);
  }
  void write(std::uint64_t position, std::span<const double> items) override {
    ++writes;
    StoredArrayMemory::write(position, items);
  }

  std::chrono::milliseconds delay{0};
  std::atomic<int> reads{0};
  std::atomic<int> writes{0};
  std::atomic<std::size_t> largest{0};
};

Array<double> counted(std::size_t size) {
  Array<double> items(size);
  std::iota(items.mutate().begin(), items.mutate().end(), 0);
  return items;
}

MultiArray<std::int16_t> counted_grid(std::vector<std::uint32_t> dims) {
  std::size_t size = 1;
  for (const std::uint32_t dim : dims) size *= dim;
  MultiArray<std::int16_t> grid{std::move(dims), Array<std::int16_t>(size)};
  std::iota(grid.items.mutate().begin(), grid.items.mutate().end(), std::int16_t{0});
  return grid;
}

Array<Sample> counted_samples(std::uint32_t size) {
  Array<Sample> items(size);
  for (std::uint32_t i = 0; i < size; ++i) items.mutate()[i] = {i, i / 2.0, {0, 1, 2}};
  return items;
}

class Board final : public Skeleton {
 public:
  explicit Board(std::size_t length) : numbers(std::make_shared<Numbers>(counted(length))) {}

  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Board; }
  void rr_dispatch(std::size_t, Request&) override {}
  std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override { return nullptr; }
  std::shared_ptr<MemorySource> rr_memory(std::size_t member) override {
    switch (member) {
      case number_memory_place:
      case fixed_place:
      case hidden_place:
        return numbers;
      case flags_place:
        return flags;
      case waves_place:
        return waves;
      case samples_place:
        return samples;
      case points_place:
        return points;
      case grid_place:
        return grid;
      case sample_grid_place:
        return sample_grid;
      default:
        return nullptr;
    }
  }

  const std::shared_ptr<Numbers> numbers;
  const std::shared_ptr<StoredArrayMemory<bool>> flags =
      std::make_shared<StoredArrayMemory<bool>>(8);
  const std::shared_ptr<StoredArrayMemory<std::complex<double>>> waves =
      std::make_shared<StoredArrayMemory<std::complex<double>>>(8);
  const std::shared_ptr<StoredArrayMemory<Sample>> samples =
      std::make_shared<StoredArrayMemory<Sample>>(counted_samples(8));
  const std::shared_ptr<StoredArrayMemory<Vector3>> points =
      std::make_shared<StoredArrayMemory<Vector3>>(8);
  const std::shared_ptr<StoredMultiMemory<std::int16_t>> grid =
      std::make_shared<StoredMultiMemory<std::int16_t>>(counted_grid({3, 4, 5}));
  const std::shared_ptr<StoredMultiMemory<Sample>> sample_grid =
      std::make_shared<StoredMultiMemory<Sample>>(MultiArray<Sample>{{4, 3}, counted_samples(12)});
};

// A node that offers a board, and another that uses it.
struct Boards {
  explicit Boards(std::uint32_t server_limit = 102'400, std::uint32_t client_limit = 102'400,
                  std::size_t length = 8, bool message_v4 = true)
      : board(std::make_shared<Board>(length)),
        server({.memory_transfer_limit = server_limit}),
        client(
            {.client_offer = {.message_v4 = message_v4}, .memory_transfer_limit = client_limit}) {
    server.register_service("board", board);
    const std::uint16_t port = server.listen_tcp(0, "127.0.0.1");
    stub =
        client.connect<BoardStub>("rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=board");
  }

  std::shared_ptr<Board> board;
  Node server;
  Node client;
  Client<BoardStub> stub;
};

using boost::asio::use_future;
using ::testing::ElementsAre;
using Dims = std::vector<std::uint64_t>;

TEST(Memories, PartsAreReadAndWritten) {
  for (const bool message_v4 : {true, false}) {
    Boards boards(102'400, 102'400, 8, message_v4);
    EXPECT_EQ(boards.stub->numbers().length(), 8U);
    EXPECT_THAT(boards.stub->numbers().read(2, 3), ElementsAre(2, 3, 4));
    boards.stub->numbers().write(3, std::array{0.5, 1.5});
    EXPECT_THAT(boards.board->numbers->items(), ElementsAre(0, 1, 2, 0.5, 1.5, 5, 6, 7));
    std::array<double, 8> all{};
    boards.stub->numbers().read(0, all);
    EXPECT_THAT(all, ElementsAre(0, 1, 2, 0.5, 1.5, 5, 6, 7));
    EXPECT_EQ(boards.stub->numbers().read(8, 0).size(), 0U);
    EXPECT_EQ(boards.board->numbers->reads, 3);  // one of them for no items
  }
}

TEST(Memories, HoldItemsOfEveryKind) {
  for (const bool message_v4 : {true, false}) {
    Boards boards(102'400, 102'400, 8, message_v4);
    boards.stub->flags().write(1, std::array{true, false, true});
    EXPECT_THAT(boards.stub->flags().read(0, 4), ElementsAre(false, true, false, true));
    boards.stub->waves().write(7, std::array{std::complex<double>(1, -2)});
    EXPECT_EQ(boards.stub->waves().read(6, 2)[1], std::complex<double>(1, -2));
    const Sample sample{7, 0.25, {1, 2, 3}};
    boards.stub->samples().write(2, std::array{sample});
    EXPECT_EQ(boards.stub->samples().read(1, 2)[0], (Sample{1, 0.5, {0, 1, 2}}));
    EXPECT_EQ(boards.stub->samples().read(1, 2)[1], sample);
    boards.stub->points().write(0, std::array{Vector3{1, 2, 3}, Vector3{4, 5, 6}});
    EXPECT_EQ(boards.stub->points().read(1, 2)[0], (Vector3{4, 5, 6}));
    boards.stub->sample_grid().write(Dims{3, 2}, MultiArray<Sample>{{1, 1}, {sample}});
    EXPECT_EQ(boards.stub->sample_grid().read(Dims{2, 2}, Dims{2, 1}).items[1], sample);
  }
}

TEST(Memories, PartsOfSeveralDimensionsAreReadAndWritten) {
  for (const bool message_v4 : {true, false}) {
    Boards boards(102'400, 102'400, 8, message_v4);
    EXPECT_THAT(boards.stub->grid().dims(), ElementsAre(3, 4, 5));
    EXPECT_EQ(boards.stub->grid().dim_count(), 3U);
    const auto part = boards.stub->grid().read(Dims{1, 2, 3}, Dims{2, 1, 2});
    EXPECT_THAT(part.dims, ElementsAre(2, 1, 2));
    EXPECT_THAT(part.items, ElementsAre(43, 44, 55, 56));  // x + 3 y + 12 z
    boards.stub->grid().write(Dims{0, 3, 0}, MultiArray<std::int16_t>{{2, 1, 2}, {-1, -2, -3, -4}});
    const auto all = boards.board->grid->array();
    EXPECT_EQ(all.items[9], -1);
    EXPECT_EQ(all.items[10], -2);
    EXPECT_EQ(all.items[21], -3);
    EXPECT_EQ(all.items[22], -4);
    EXPECT_EQ(all.items[11], 11);
    EXPECT_EQ(all.items[23], 23);
    // Dimensions that are left out are one item wide.
    const auto one = boards.stub->grid().read(Dims{1}, Dims{2});
    EXPECT_THAT(one.dims, ElementsAre(2));
    EXPECT_THAT(one.items, ElementsAre(1, 2));
  }
}

TEST(Memories, WhatDoesNotLieInsideIsRefused) {
  Boards boards;
  auto numbers = boards.stub->numbers();
  EXPECT_EQ(code_of([&] { (void)numbers.read(7, 2); }), ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { (void)numbers.read(9, 0); }), ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { (void)numbers.read(~std::uint64_t{0}, 2); }), ErrorCode::out_of_range);
  EXPECT_EQ(code_of([&] { numbers.write(8, std::array{1.0}); }), ErrorCode::out_of_range);
  auto grid = boards.stub->grid();
  EXPECT_EQ(code_of([&] {
              (void)grid.read(Dims{3, 0, 0}, Dims{1, 1, 1});
            }),
            ErrorCode::invalid_argument);
  EXPECT_EQ(code_of([&] {
              (void)grid.read(Dims{0, 0, 0, 0}, Dims{1, 1, 1, 1});
            }),
            ErrorCode::invalid_argument);
  EXPECT_EQ(code_of([&] {
              grid.write(Dims{2, 0, 0}, MultiArray<std::int16_t>{{2, 1, 1}, {1, 2}});
            }),
            ErrorCode::invalid_argument);
  EXPECT_EQ(boards.board->numbers->items(), counted(8));
}

TEST(Memories, TheAccessIsCheckedBeforeAnythingIsSent) {
  Boards boards;
  EXPECT_THAT(boards.stub->fixed().read(1, 2), ElementsAre(1, 2));
  EXPECT_EQ(code_of([&] { boards.stub->fixed().write(0, std::array{1.0}); }),
            ErrorCode::read_only_member);
  boards.stub->hidden().write(0, std::array{5.0});
  EXPECT_EQ(code_of([&] { (void)boards.stub->hidden().read(0, 1); }), ErrorCode::write_only_member);
  EXPECT_EQ(boards.board->numbers->items()[0], 5);
  EXPECT_EQ(code_of([&] { (void)boards.stub->missing().length(); }), ErrorCode::invalid_operation);
  std::array<std::int16_t, 3> items{};
  EXPECT_EQ(code_of([&] {
              boards.stub->grid().read(Dims{0, 0}, Dims{2, 2}, items);
            }),
            ErrorCode::invalid_argument);
}

TEST(Memories, TransfersAreCutToTheSmallerLimit) {
  constexpr std::size_t length = 1000;
  for (const auto& [server, client] : {std::pair(128U, 102'400U), std::pair(102'400U, 128U)}) {
    Boards boards(server, client, length);
    EXPECT_EQ(boards.stub->numbers().read(0, length), counted(length));
    EXPECT_EQ(boards.board->numbers->reads, 63);
    EXPECT_EQ(boards.board->numbers->largest, 16U);
    Array<double> other(length);
    other.mutate()[998] = 3;
    boards.stub->numbers().write(0, other);
    EXPECT_EQ(boards.board->numbers->writes, 63);
    EXPECT_EQ(boards.board->numbers->items(), other);
  }
}

TEST(Memories, ALimitSmallerThanAnItemSendsOneAtATime) {
  Boards boards(1, 102'400);
  EXPECT_EQ(boards.stub->samples().read(0, 8), counted_samples(8));
  EXPECT_EQ(boards.stub->numbers().read(2, 5).size(), 5U);
  EXPECT_EQ(boards.board->numbers->reads, 5);
}

TEST(Memories, SeveralDimensionsAreCutAlongTheFirstThatDoesNotFit) {
  const auto whole = counted_grid({3, 4, 5});
  for (const std::uint32_t limit : {2U, 4U, 6U, 8U, 12U, 14U, 24U, 50U, 118U, 120U}) {
    Boards boards(limit, 102'400);
    EXPECT_EQ(boards.stub->grid().read(Dims{0, 0, 0}, Dims{3, 4, 5}), whole) << limit;
    const auto part = boards.stub->grid().read(Dims{1, 1, 1}, Dims{2, 3, 4});
    for (std::size_t i = 0; i < part.items.size(); ++i) {
      EXPECT_EQ(part.items[i], 16 + i % 2 + 3 * (i / 2 % 3) + 12 * (i / 6)) << limit;
    }
    MultiArray<std::int16_t> other{{3, 4, 5}, Array<std::int16_t>(60)};
    for (std::size_t i = 0; i < 60; ++i) other.items.mutate()[i] = static_cast<std::int16_t>(-i);
    boards.stub->grid().write(Dims{0, 0, 0}, other);
    EXPECT_EQ(boards.board->grid->array(), other) << limit;
  }
}

TEST(Memories, APartThatNoMessageHoldsIsRefusedBeforeItIsMade) {
  class Endless final : public ArrayMemorySource<double> {
   public:
    [[nodiscard]] std::uint64_t length() const override { return ~std::uint64_t{0}; }
    void read(std::uint64_t, std::span<double>) override { ADD_FAILURE(); }
    void write(std::uint64_t, std::span<const double>) override { ADD_FAILURE(); }
  };
  class Endlessly final : public Skeleton {
   public:
    [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Board; }
    void rr_dispatch(std::size_t, Request&) override {}
    std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override { return {}; }
    std::shared_ptr<MemorySource> rr_memory(std::size_t) override {
      return std::make_shared<Endless>();
    }
  };
  constexpr std::uint32_t no_limit = ~std::uint32_t{0};
  Node server({.memory_transfer_limit = no_limit});
  server.register_service("board", std::make_shared<Endlessly>());
  const std::uint16_t port = server.listen_tcp(0, "127.0.0.1");
  Node node({.memory_transfer_limit = no_limit});
  const auto stub =
      node.connect<BoardStub>("rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=board");
  EXPECT_EQ(stub->numbers().length(), ~std::uint64_t{0});
  EXPECT_EQ(code_of([&] { (void)stub->numbers().read(0, 2'000'000); }), ErrorCode::protocol_error);
  EXPECT_EQ(stub->numbers().length(), ~std::uint64_t{0});  // the session goes on
}

TEST(Memories, AreReadAndWrittenWithoutWaiting) {
  Boards boards(64, 102'400, 100);
  auto read = boards.stub->numbers().async_read(10, 50, use_future);
  auto grid = boards.stub->grid().async_read({0, 0, 0}, {3, 4, 5}, use_future);
  const Array<double> items = read.get();
  ASSERT_EQ(items.size(), 50U);
  EXPECT_EQ(items[49], 59);
  EXPECT_EQ(grid.get(), counted_grid({3, 4, 5}));
  {
    // What is written may go away at once, owned or not.
    std::vector<double> values(20, 1.5);
    auto borrowed = boards.stub->numbers().async_write(0, Array<double>::view(values), use_future);
    values.assign(20, -1);
    auto owned = boards.stub->numbers().async_write(20, counted(20), use_future);
    borrowed.get();
    owned.get();
  }
  boards.stub->grid()
      .async_write({1, 1, 1}, MultiArray<std::int16_t>{{1, 1, 1}, {-7}}, use_future)
      .get();
  EXPECT_EQ(boards.board->numbers->items()[19], 1.5);
  EXPECT_EQ(boards.board->numbers->items()[39], 19);
  EXPECT_EQ(boards.board->grid->array().items[16], -7);
  EXPECT_EQ(code_of([&] { boards.stub->numbers().async_read(99, 2, use_future).get(); }),
            ErrorCode::out_of_range);
}

TEST(Memories, ACancelledTransferEndsBetweenItsRequestsToo) {
  Boards boards(8, 102'400, 1000);
  boards.board->numbers->delay = std::chrono::milliseconds(2);
  std::stop_source stop;
  auto read = boards.stub->numbers().async_read(0, 1000, stopped_by(stop.get_token()), use_future);
  EXPECT_TRUE(eventually([&] { return boards.board->numbers->reads > 3; }));
  stop.request_stop();
  EXPECT_EQ(code_of([&] { read.get(); }), ErrorCode::operation_cancelled);
}

TEST(Memories, ATransferFailsWhenItsSessionEnds) {
  Boards boards(8, 102'400, 1000);
  boards.board->numbers->delay = std::chrono::milliseconds(2);
  auto read = boards.stub->numbers().async_read(0, 1000, use_future);
  EXPECT_TRUE(eventually([&] { return boards.board->numbers->reads > 3; }));
  boards.server.shutdown();
  EXPECT_NE(code_of([&] { read.get(); }), ErrorCode::none);
  EXPECT_NE(code_of([&] { (void)boards.stub->numbers().length(); }), ErrorCode::none);
}

TEST(Memories, ManyThreadsShareOne) {
  Boards boards(64, 102'400, 64);
  std::vector<std::jthread> threads;
  for (std::size_t thread = 0; thread < 8; ++thread) {
    threads.emplace_back([&, thread] {
      for (int round = 0; round < 20; ++round) {
        std::array<double, 8> items{};
        items.fill(static_cast<double>(thread * 100) + round);
        boards.stub->numbers().write(thread * 8, items);
        std::array<double, 8> back{};
        boards.stub->numbers().read(thread * 8, back);
        EXPECT_EQ(back, items);
      }
    });
  }
}

}  // namespace

constinit const RecordType rr_Sample{RecordKind::pod, "test.memories.Sample", sample_fields,
                                     record_operations<Sample>};
constinit const RecordType rr_Vector3{"test.memories.Vector3", ElementType::double_, 3,
                                      record_operations<Vector3>};

}  // namespace rr::testing
