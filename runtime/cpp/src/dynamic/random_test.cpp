// SPDX-License-Identifier: Apache-2.0
// Definitions and values by chance go from a service without generated code to a client without,
// and back, and are the same. ROBDEF_RANDOM_SEED is the first seed, another than the usual one;
// each definition has the next one, and its text is printed when it fails.
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "rr/error.hpp"
#include "rr/node.hpp"
#include "runtime/cpp/src/dynamic/testing/random_definition.hpp"

namespace rr::dynamic {
namespace {

using testing::random_board;
using testing::RandomDefinition;

std::uint64_t first_seed() {
  const char* const given = std::getenv("ROBDEF_RANDOM_SEED");
  return given != nullptr ? std::strtoull(given, nullptr, 10) : 20'260'101;
}

class Rounds : public ::testing::TestWithParam<int> {
 protected:
  Rounds() : node(options()), port(server.listen_tcp(0, "127.0.0.1")) {}

  static NodeOptions options() {
    NodeOptions options;
    options.client_offer.message_v4 = GetParam() == 4;
    return options;
  }

  void play(std::uint64_t seed) {
    const RandomDefinition definition(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + "\n" + definition.text());
    try {
      const ServedObject board = random_board(definition, seed);
      const Service service = register_service(server, "board", board);
      {
        const Client client =
            connect(node, "rr+tcp://127.0.0.1:" + std::to_string(port) + "/?service=board");
        use(*client, board, definition.types().size());
      }
      service->close();
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }

  static void use(const Object& board, const ServedObject& served, std::size_t types) {
    for (std::size_t i = 0; i < types; ++i) {
      const std::string number = std::to_string(i);
      const Value given = served.stored("p" + number);
      const Value got = board.get("p" + number);
      EXPECT_EQ(got, given) << "p" << number << ": " << given.to_json() << "\n" << got.to_json();
      EXPECT_EQ(board.call("echo" + number, {got}), given) << "echo" << number;
      board.set("q" + number, got);
    }
    board.wire("level").poke_out(board.wire("level").peek_in().value);
    for (const char* const name : {"items", "grid"}) {
      const Memory memory = board.memory(name);
      const Memory::Numbers dims = memory.dims();
      const Memory::Numbers begin(dims.size(), 0);
      const Value content = memory.read(begin, dims);
      EXPECT_EQ(content, served.stored_memory(name)) << name;
      memory.write(begin, content);
    }
    EXPECT_EQ(board.call("difference").text(), "");
  }

  Node server;
  Node node;
  const std::uint16_t port;
};

TEST_P(Rounds, GiveTheSameValues) {
  constexpr int count = 200;
  const std::uint64_t first = first_seed();
  std::cout << "seeds " << first << " to " << first + count - 1 << "\n";
  for (int i = 0; i < count && !HasFailure(); ++i) play(first + static_cast<std::uint64_t>(i));
}

INSTANTIATE_TEST_SUITE_P(Versions, Rounds, ::testing::Values(2, 4));

TEST(RandomDefinitions, AreTheSameForTheSameSeed) {
  EXPECT_EQ(RandomDefinition(7).text(), RandomDefinition(7).text());
  EXPECT_NE(RandomDefinition(7).text().substr(20), RandomDefinition(8).text().substr(20));
  const RandomDefinition definition(7);
  EXPECT_EQ(random_board(definition, 1).stored("p0"), random_board(definition, 1).stored("p0"));
}

}  // namespace
}  // namespace rr::dynamic
