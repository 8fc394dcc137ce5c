// SPDX-License-Identifier: Apache-2.0
// Pipes of objects that are clients' own.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "runtime/cpp/src/node/testing/pair.hpp"
#include "runtime/cpp/src/node/testing/pipe_board.hpp"

namespace rr::testing {
namespace {

using std::chrono_literals::operator""ms;

TEST(SessionObjects, HavePipesOfTheirOwn) {
  class Root : public PipeBoard {
   public:
    std::shared_ptr<Skeleton> rr_child(std::size_t, const ObjectIndex&) override {
      const auto own = std::make_shared<PipeBoard>();
      made.push_back(own);
      return per_client(own);
    }
    std::vector<std::shared_ptr<PipeBoard>> made;
  };
  const auto root = std::make_shared<Root>();
  Pair pair;
  pair.server.register_service("root", root);
  auto first = pair.client.connect<PipeBoardStub>(pair.url("root"));
  auto second = pair.client.connect<PipeBoardStub>(pair.url("root"));
  const auto my_child = first->get_child();
  const auto your_child = second->get_child();
  auto mine = my_child->numbers().connect();
  auto yours = your_child->numbers().connect();
  root->made[0]->numbers().send(1.5);
  root->made[1]->numbers().send(2.5);
  EXPECT_EQ(mine.receive_for(20000ms), 1.5);
  EXPECT_EQ(yours.receive_for(20000ms), 2.5);
  first.close();
  EXPECT_TRUE(eventually([&] { return root->made[0].use_count() == 1; }));
  EXPECT_EQ(root->made[0]->numbers().endpoint_count(), 0U);
  root->made[1]->numbers().send(3.5);
  EXPECT_EQ(yours.receive_for(20000ms), 3.5);
}

}  // namespace
}  // namespace rr::testing
