// SPDX-License-Identifier: Apache-2.0
// Serves definitions and values by chance: the services board0, board1, ...
#include <cstdlib>
#include <memory>
#include <string>

#include "rr/node.hpp"
#include "runtime/cpp/src/dynamic/testing/random_definition.hpp"
#include "runtime/matlab/test/serving.hpp"

namespace {

namespace testing = rr::dynamic::testing;

constexpr int count = 200;

struct Boards {
  explicit Boards(int wanted) {
    const char* const given = std::getenv("ROBDEF_RANDOM_SEED");
    const std::uint64_t seed = given != nullptr ? std::strtoull(given, nullptr, 10) : 20'260'201;
    for (int i = 0; i < count; ++i) {
      const std::uint64_t own = seed + static_cast<std::uint64_t>(i);
      rr::dynamic::register_service(node, "board" + std::to_string(i),
                                    testing::random_board(testing::RandomDefinition(own), own));
    }
    port = node.listen_tcp(static_cast<std::uint16_t>(wanted), "127.0.0.1");
  }
  rr::Node node{{.name = "matlab.random"}};
  std::uint16_t port = 0;
};

}  // namespace

int main(int argc, char** argv) {
  return rr::matlab::testing::serve(argc, argv,
                                    [](int port) { return std::make_unique<Boards>(port); });
}
