// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

namespace robdef::model {

/// A directed graph over the numbers 0 to n-1: who imports, contains or implements whom.
class Graph {
 public:
  struct Edge {
    std::size_t from = 0;
    std::size_t to = 0;
    std::size_t label = 0;  ///< the caller's: which import, field or line makes the edge
  };

  explicit Graph(std::size_t nodes) : edges_(nodes) {}

  void add_edge(std::size_t from, std::size_t to, std::size_t label);
  [[nodiscard]] std::size_t size() const { return edges_.size(); }
  [[nodiscard]] const std::vector<Edge>& edges_of(std::size_t node) const { return edges_[node]; }

  /// Groups of nodes that reach each other, each after all groups that it points to; within a
  /// group in ascending order. A node that is on no cycle is a group of its own.
  [[nodiscard]] std::vector<std::vector<std::size_t>> groups() const;
  /// For each node, whether it is on a cycle.
  [[nodiscard]] std::vector<bool> cyclic() const;
  /// Enough cycles to break all by breaking the first edge of each, every one a shortest cycle that
  /// begins at its smallest node, in ascending order of these. Of a graph so large that looking for
  /// all would take the square of its size, the first ones.
  [[nodiscard]] std::vector<std::vector<Edge>> cycles() const;

 private:
  [[nodiscard]] bool has_loop(std::size_t node) const;
  [[nodiscard]] std::vector<Edge> shortest_cycle(std::size_t start) const;
  void remove(const Edge& edge);

  std::vector<std::vector<Edge>> edges_;
};

}  // namespace robdef::model
