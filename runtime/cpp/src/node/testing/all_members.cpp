// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/node/testing/all_members.hpp"

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""s;

constexpr std::string_view store_text =
    "service test.store\n"
    "stdver 0.10\n"
    "object Store\n"
    "  memory double[] numbers\n"
    "end\n";
constexpr Member store_members[] = {memory<Array<double>>("numbers")};
constexpr const ObjectType* store_objects[] = {&rr_Store};

class Store final : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return rr_Store; }
  void rr_dispatch(std::size_t, Request&) override {}
  std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override { return nullptr; }
  std::shared_ptr<MemorySource> rr_memory(std::size_t) override { return numbers_; }

 private:
  std::shared_ptr<StoredArrayMemory<double>> numbers_ =
      std::make_shared<StoredArrayMemory<double>>(Array<double>(100));
};

std::shared_ptr<Stub> make_store() { return std::make_shared<StoreStub>(); }

std::string url(std::uint16_t port, const std::string& service) {
  return "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=" + service;
}

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

}  // namespace

constexpr Definition rr_store_definition{.name = "test.store",
                                         .text = store_text,
                                         .version = {0, 10, 0, 0},
                                         .imports = {},
                                         .records = {},
                                         .exceptions = {},
                                         .objects = store_objects};
constexpr ObjectType rr_Store{
    "test.store.Store", rr_store_definition, {}, store_members, make_store};

ArrayMemory<double> StoreStub::numbers() { return {*this, store_members[0]}; }

namespace {

void use_counter(Node& client, std::uint16_t port) {
  std::atomic<int> ticks = 0;
  auto counter = client.connect<CounterStub>(url(port, "counter"));
  Subscription ticked =
      counter->ticked().connect([&](std::int32_t, const std::string&) { ++ticks; });
  counter->set_value(2.5);
  require(counter->get_value() == 2.5, "property");
  require(counter->add(1, 2) == 3, "function");
  require(error_of([&] { counter->raise(1, "as planned"); }).code() != ErrorCode::none, "error");
  require(!counter->get_by_name("one two")->get_name().empty(), "objref");
  require(counter->blob(200'000).size() == 200'000, "large array");
  counter->fire(3);
  require(eventually([&] { return ticks == 3; }), "event");
  counter->set_value(0);
}

void use_board(Node& client, std::uint16_t port) {
  std::atomic<int> notes = 0;
  auto board = client.connect<BoardStub>(url(port, "board"));
  Subscription noted = board->note_down().connect([&](const std::string&) { ++notes; });
  board->sum().set([](std::int32_t a, std::int32_t b) { return a + b; });
  require(board->run("sum") == 42, "callback");
  std::vector<std::int32_t> numbers;
  for (const std::int32_t number : board->count_to(3)) numbers.push_back(number);
  require(numbers.size() == 3, "generator");
  require(eventually([&] { return notes == 1; }), "event");
}

void use_pipes(Node& client, std::uint16_t port) {
  auto pipes = client.connect<PipeBoardStub>(url(port, "pipes"));
  auto end = pipes->numbers().connect();
  end.ask_for_acknowledgements();
  end.send(1.5);
  require(eventually([&] { return end.unacknowledged() == 0; }), "acknowledgement");
  pipes->sync();
  for (int i = 0; i < 20; ++i) require(end.receive_for(10s) == i, "packet");
  end.close();
}

void use_wired(Node& client, std::uint16_t port) {
  auto wired = client.connect<WiredStub>(url(port, "wired"));
  auto level = wired->level().connect();
  wired->set_level(4.5);
  require(level.wait_in(10s) && level.in() == 4.5, "wire");
  level.set_out(-1.5);
  require(wired->level().peek_in().value == 4.5, "peek");
  wired->level().poke_out(2);
  level.close();
}

void use_store(Node& client, std::uint16_t port) {
  auto store = client.connect<StoreStub>(url(port, "store"));
  std::vector<double> numbers = {1, 2, 3};
  store->numbers().write(0, numbers);
  std::vector<double> read(3);
  store->numbers().read(0, read);
  require(read == numbers, "memory");
}

}  // namespace

AllMembers::AllMembers(Node& server) {
  const auto board = std::make_shared<Board>();
  board->on_run = [object = board.get()](const std::string&) {
    object->note_down("asked");
    return object->sum(ServiceContext::current_client(), 20, 22);
  };
  const auto pipes = std::make_shared<PipeBoard>();
  pipes->on_sync = [object = pipes.get()] {
    for (int i = 0; i < 20; ++i) object->numbers().send(i);
  };
  server.register_service("counter", std::make_shared<Counter>());
  server.register_service("board", board);
  server.register_service("pipes", pipes);
  server.register_service("wired", std::make_shared<Wired>());
  server.register_service("store", std::make_shared<Store>());
  port_ = server.listen_tcp(0, "127.0.0.1");
}

void AllMembers::use(Node& client, std::uint16_t port) {
  use_counter(client, port);
  use_board(client, port);
  use_pipes(client, port);
  use_wired(client, port);
  use_store(client, port);
}

}  // namespace rr::testing
