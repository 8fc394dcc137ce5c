// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/graph.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include "gmock/gmock.h"
#include "gtest/gtest.h"

namespace robdef::model {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

Graph graph_of(std::size_t nodes, const std::vector<std::pair<std::size_t, std::size_t>>& edges) {
  Graph graph(nodes);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    graph.add_edge(edges[i].first, edges[i].second, i);
  }
  return graph;
}

std::vector<std::size_t> starts_and_labels(const std::vector<Graph::Edge>& cycle) {
  std::vector<std::size_t> result = {cycle.front().from};
  for (const Graph::Edge& edge : cycle) result.push_back(edge.label);
  return result;
}

TEST(Graph, GroupsComeAfterWhatTheyPointTo) {
  const Graph graph = graph_of(4, {{0, 1}, {1, 2}, {0, 3}});
  EXPECT_THAT(graph.groups(),
              ElementsAre(ElementsAre(2), ElementsAre(1), ElementsAre(3), ElementsAre(0)));
}

TEST(Graph, NodesThatReachEachOtherAreOneGroup) {
  const Graph graph = graph_of(4, {{0, 2}, {2, 3}, {3, 2}, {1, 0}});
  EXPECT_THAT(graph.groups(), ElementsAre(ElementsAre(2, 3), ElementsAre(0), ElementsAre(1)));
  EXPECT_THAT(graph.cyclic(), ElementsAre(false, false, true, true));
}

TEST(Graph, AnEdgeToItselfIsACycle) {
  const Graph graph = graph_of(2, {{0, 1}, {1, 1}});
  EXPECT_THAT(graph.cyclic(), ElementsAre(false, true));
  ASSERT_EQ(graph.cycles().size(), 1u);
  EXPECT_THAT(starts_and_labels(graph.cycles()[0]), ElementsAre(1, 1));
}

TEST(Graph, ACycleIsGivenOnceFromItsSmallestNode) {
  const Graph graph = graph_of(4, {{3, 1}, {1, 2}, {2, 3}, {0, 2}});
  ASSERT_EQ(graph.cycles().size(), 1u);
  EXPECT_THAT(starts_and_labels(graph.cycles()[0]), ElementsAre(1, 1, 2, 0));
}

TEST(Graph, CyclesThatShareANodeAreAllFound) {
  const Graph graph = graph_of(3, {{0, 1}, {1, 0}, {1, 2}, {2, 1}});
  ASSERT_EQ(graph.cycles().size(), 2u);
  EXPECT_THAT(starts_and_labels(graph.cycles()[0]), ElementsAre(0, 0, 1));
  EXPECT_THAT(starts_and_labels(graph.cycles()[1]), ElementsAre(1, 2, 3));
}

TEST(Graph, WithoutCyclesNoneIsFound) {
  EXPECT_THAT(graph_of(3, {{0, 1}, {1, 2}, {0, 2}}).cycles(), IsEmpty());
}

TEST(Graph, AChainLongerThanTheCallStackIsNoTrouble) {
  constexpr std::size_t length = 300'000;
  Graph graph(length);
  for (std::size_t i = 0; i + 1 < length; ++i) graph.add_edge(i, i + 1, 0);
  EXPECT_EQ(graph.groups().front().front(), length - 1);
}

}  // namespace
}  // namespace robdef::model
