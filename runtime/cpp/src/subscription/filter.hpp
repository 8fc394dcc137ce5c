// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/service_filter.hpp"

namespace rr::subscription {

/// A ServiceFilter, ready for use. Does not change.
class Filter {
 public:
  /// Throws rr::Error (invalid_argument) for a wrong regular expression.
  explicit Filter(ServiceFilter wanted);

  [[nodiscard]] std::size_t max_connections() const { return wanted_.max_connections; }
  [[nodiscard]] bool takes_scheme(std::string_view url) const;
  [[nodiscard]] bool takes_name(const std::string& service) const;
  /// The first node filter that what is known does not rule out; null without any. Before it is
  /// connected, what is not known of a node is zero or empty.
  struct Choice {
    bool is_wanted = true;
    const NodeFilter* node = nullptr;
  };
  [[nodiscard]] Choice choose_node(const NodeId& id, const std::string& name,
                                   bool is_connected) const;
  /// Attributes and predicate, of a service of which all is known: what does not match; empty when
  /// all does. Runs code of the program.
  [[nodiscard]] std::string refusal(const FoundService& service) const;

 private:
  // A group whose expressions have been compiled.
  struct Group {
    struct Test {
      AttributeTest wanted;
      std::optional<std::regex> expression;
    };
    std::vector<Test> tests;
    std::vector<Group> groups;
    Match match = Match::any_of;
    bool splits_at_commas = true;
  };
  static Group prepare(const AttributeGroup& group);
  static bool matches(const Group& group, const VarValue& attribute);
  static bool matches(const Group& group, const Group::Test& test, const VarValue& attribute);
  [[nodiscard]] bool attributes_match(const FoundService& service) const;

  const ServiceFilter wanted_;
  std::map<std::string, Group> attributes_;
};

}  // namespace rr::subscription
