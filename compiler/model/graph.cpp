// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/graph.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

namespace robdef::model {
namespace {

constexpr std::size_t unvisited = std::numeric_limits<std::size_t>::max();

// Tarjan's search with a stack of its own, because a chain of definitions can be longer than the
// call stack is deep.
class GroupSearch {
 public:
  explicit GroupSearch(const Graph& graph)
      : graph_(graph),
        order_(graph.size(), unvisited),
        low_(graph.size(), 0),
        is_open_(graph.size(), false) {}

  std::vector<std::vector<std::size_t>> run() {
    for (std::size_t node = 0; node < graph_.size(); ++node) {
      if (order_[node] == unvisited) visit_all_from(node);
    }
    return std::move(groups_);
  }

 private:
  struct Step {
    std::size_t node;
    std::size_t next_edge;
  };

  void enter(std::size_t node) {
    order_[node] = low_[node] = next_order_++;
    is_open_[node] = true;
    open_.push_back(node);
    path_.push_back({node, 0});
  }

  void visit_all_from(std::size_t start) {
    enter(start);
    while (!path_.empty()) {
      Step& step = path_.back();
      const auto& edges = graph_.edges_of(step.node);
      if (step.next_edge == edges.size()) {
        leave();
        continue;
      }
      const std::size_t from = step.node;
      const std::size_t to = edges[step.next_edge++].to;
      if (order_[to] == unvisited) {
        enter(to);
      } else if (is_open_[to]) {
        low_[from] = std::min(low_[from], order_[to]);
      }
    }
  }

  void leave() {
    const std::size_t node = path_.back().node;
    path_.pop_back();
    if (!path_.empty()) {
      const std::size_t parent = path_.back().node;
      low_[parent] = std::min(low_[parent], low_[node]);
    }
    if (low_[node] != order_[node]) return;
    std::vector<std::size_t>& group = groups_.emplace_back();
    do {
      group.push_back(open_.back());
      is_open_[open_.back()] = false;
      open_.pop_back();
    } while (group.back() != node);
    std::sort(group.begin(), group.end());
  }

  const Graph& graph_;
  std::vector<std::size_t> order_;
  std::vector<std::size_t> low_;
  std::vector<bool> is_open_;
  std::vector<std::size_t> open_;
  std::vector<Step> path_;
  std::size_t next_order_ = 0;
  std::vector<std::vector<std::size_t>> groups_;
};

}  // namespace

void Graph::add_edge(std::size_t from, std::size_t to, std::size_t label) {
  edges_[from].push_back({from, to, label});
}

std::vector<std::vector<std::size_t>> Graph::groups() const { return GroupSearch(*this).run(); }

bool Graph::has_loop(std::size_t node) const {
  return std::any_of(edges_[node].begin(), edges_[node].end(),
                     [node](const Edge& edge) { return edge.to == node; });
}

std::vector<bool> Graph::cyclic() const {
  std::vector<bool> result(size(), false);
  for (const auto& group : groups()) {
    for (const std::size_t node : group) result[node] = group.size() > 1 || has_loop(node);
  }
  return result;
}

std::vector<Graph::Edge> Graph::shortest_cycle(std::size_t start) const {
  std::vector<std::optional<Edge>> arrived_by(size());
  std::vector<std::size_t> queue = {start};
  for (std::size_t next = 0; next < queue.size() && !arrived_by[start]; ++next) {
    for (const Edge& edge : edges_[queue[next]]) {
      if (arrived_by[edge.to]) continue;
      arrived_by[edge.to] = edge;
      queue.push_back(edge.to);
    }
  }
  std::vector<Edge> cycle;
  for (std::size_t node = start; cycle.empty() || node != start; node = cycle.back().from) {
    cycle.push_back(*arrived_by[node]);
  }
  std::reverse(cycle.begin(), cycle.end());
  return cycle;
}

void Graph::remove(const Edge& edge) {
  auto& edges = edges_[edge.from];
  edges.erase(std::find_if(edges.begin(), edges.end(), [&edge](const Edge& other) {
    return other.to == edge.to && other.label == edge.label;
  }));
}

std::vector<std::vector<Graph::Edge>> Graph::cycles() const {
  // Each cycle costs a look at the whole graph: of a large one not all are told.
  constexpr std::size_t most_work = 4'000'000;
  std::size_t cost = size() + 1;
  for (const std::vector<Edge>& edges : edges_) cost += edges.size();
  const std::size_t most = std::max<std::size_t>(1, most_work / cost);

  std::vector<std::vector<Edge>> found;
  const std::vector<bool> is_any = cyclic();
  if (std::find(is_any.begin(), is_any.end(), true) == is_any.end()) return found;
  Graph rest = *this;
  while (found.size() < most) {
    const std::vector<bool> is_cyclic = rest.cyclic();
    const auto start = std::find(is_cyclic.begin(), is_cyclic.end(), true);
    if (start == is_cyclic.end()) return found;
    found.push_back(rest.shortest_cycle(static_cast<std::size_t>(start - is_cyclic.begin())));
    rest.remove(found.back().front());
  }
  return found;
}

}  // namespace robdef::model
