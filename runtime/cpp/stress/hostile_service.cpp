// SPDX-License-Identifier: Apache-2.0
// The service that hostile_memory_test attacks, in a process of its own: says `port` and `id`, and
// ends with its standard input.
#include <sys/prctl.h>

#include <iostream>
#include <memory>
#include <string>

#include "rr/memories.hpp"
#include "rr/node.hpp"
#include "rr/users.hpp"
#include "runtime/cpp/src/node/testing/board.hpp"
#include "runtime/cpp/src/node/testing/counter.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"

namespace rr::stress {
namespace {

extern const Definition store_definition;
extern const ObjectType store_type;

constexpr std::string_view store_text =
    "service test.store\n"
    "stdver 0.10\n"
    "object Store\n"
    "  memory uint8[] bytes\n"
    "  function void drop(varvalue value)\n"
    "end\n";
constexpr Parameter drop_parameters[] = {parameter<VarValue>("value")};
constexpr Member store_members[] = {memory<Array<std::uint8_t>>("bytes"),
                                    function<void>("drop", drop_parameters)};
constexpr const ObjectType* store_objects[] = {&store_type};
std::shared_ptr<Stub> no_stub() { return nullptr; }

constexpr Definition store_definition{.name = "test.store",
                                      .text = store_text,
                                      .version = {0, 10, 0, 0},
                                      .imports = {},
                                      .records = {},
                                      .exceptions = {},
                                      .objects = store_objects};
constexpr ObjectType store_type{"test.store.Store", store_definition, {}, store_members, no_stub};

class Store final : public Skeleton {
 public:
  [[nodiscard]] const ObjectType& rr_object_type() const override { return store_type; }
  // What a handler itself makes of a value is not what the runtime holds: this one makes nothing.
  void rr_dispatch(std::size_t, Request& request) override {
    VarValue value;
    request.read(value);
  }
  std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override { return nullptr; }
  std::shared_ptr<MemorySource> rr_memory(std::size_t) override { return bytes_; }

 private:
  static constexpr std::size_t size = 11 * 1024 * 1024;
  std::shared_ptr<StoredArrayMemory<std::uint8_t>> bytes_ =
      std::make_shared<StoredArrayMemory<std::uint8_t>>(Array<std::uint8_t>(size));
};

void serve() {
  // What is resident is what was written then, and not the rest of a huge page as well.
  ::prctl(PR_SET_THP_DISABLE, 1, 0, 0, 0);
  Node node;
  node.register_service("counter", std::make_shared<testing::Counter>());
  node.register_service("store", std::make_shared<Store>());
  node.register_service("pipes", std::make_shared<testing::PipeBoard>());
  const auto board = std::make_shared<testing::Board>();
  board->on_run = [&board = *board](const std::string&) {
    return static_cast<double>(board.sum(ServiceContext::current_client(), 1, 2));
  };
  node.register_service("board", board);
  node.register_service(
      "locked", std::make_shared<testing::Counter>(),
      {.users = std::make_shared<PasswordUsers>("alice " + PasswordUsers::hash("right") + " _\n")});
  std::cout << "port " << node.listen_tcp(0, "127.0.0.1") << std::endl;
  std::cout << "id " << node.id().text() << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
  }
  board->on_run = nullptr;
}

}  // namespace
}  // namespace rr::stress

int main() { rr::stress::serve(); }
