// SPDX-License-Identifier: Apache-2.0
// Nodes of the C interface that share memory; for Linux.
#include <gtest/gtest.h>

#include <string>

#include "runtime/c/test/handles.hpp"
#include "runtime/cpp/src/node/testing/mappings.hpp"
#include "runtime/cpp/src/node/testing/pair.hpp"

namespace rr::testing::c {
namespace {

NodeHandle node_that_shares(bool does) {
  rr_node_options options{};
  options.size = sizeof options;
  options.shared_memory = does ? 1 : 0;
  options.spin_us = 50;
  return make_node(&options);
}

TEST(SharedMemoryOfC, IsUsedWhereBothNodesHaveIt) {
  const std::string url = "rr+local://" + test_folder() + "/c";
  for (const bool is_shared : {true, false}) {
    const NodeHandle server = node_that_shares(is_shared);
    all_members* const offered = all_members_offer(server.get());
    ASSERT_EQ(rr_node_listen(server.get(), view(url), nullptr, nullptr), RR_OK);
    {
      const NodeHandle node = node_that_shares(true);
      const std::string service = url + "?service=counter";
      const rr_str urls[] = {view(service)};
      rr_client* made = nullptr;
      ASSERT_EQ(rr_client_connect(node.get(), urls, 1, nullptr, &made, nullptr), RR_OK);
      const ClientHandle client(made);
      Packed arguments;
      arguments.number("a", 1.5).number("b", 2);
      EXPECT_EQ(call(root_of(client), "add", &arguments).status, RR_OK);
      EXPECT_EQ(mappings().size(), is_shared ? 2U : 0U);
    }
    all_members_release(offered);
  }
}

}  // namespace
}  // namespace rr::testing::c
