// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "rr/node_id.hpp"
#include "rr/varvalue.hpp"
#include "rr/visibility.hpp"

/// Which services a subscription connects to (05, section 8).
namespace RR_VISIBLE rr {

/// A service that may be connected to, by what is known of it.
struct FoundService {
  /// As it is registered.
  std::string name{};
  NodeId node{};            ///< zero while unknown
  std::string node_name{};  ///< empty for none, and while unknown
  /// Ways to reach it, tried in this order.
  std::vector<std::string> urls{};
  /// Of the root object, qualified.
  std::string object_type{};
  std::vector<std::string> implements{};  ///< qualified; without object_type itself
  /// As the service gave them.
  std::map<std::string, VarValue> attributes{};

  /// Whether all fields are equal.
  bool operator==(const FoundService&) const = default;
};

/// How the answers of several tests make one: `any_of`, at least one holds; `all_of`; `none_of`;
/// `not_all_of`, at least one does not. Of no tests, all_of and any_of hold, the other two do not.
enum class Match : std::uint8_t { any_of, all_of, none_of, not_all_of };

/// One test of an attribute's texts. A text with commas is several texts; lists hold their items'
/// texts; other values have none. An attribute that a service does not have is as an empty list.
struct AttributeTest {
  /// The text, or the expression.
  std::string value{};
  /// The value is a regular expression (ECMAScript) that the whole text must match. Texts over
  /// 1,024 bytes match none.
  bool is_expression = false;
  /// In an attribute that is a map from string: which of its values. Empty: all of them.
  std::string name{};
};

/// Tests of one attribute, and groups of such tests.
struct AttributeGroup {
  /// Tests of the attribute's texts.
  std::vector<AttributeTest> tests{};
  /// Further groups of tests.
  std::vector<AttributeGroup> groups{};
  /// How the answers of tests and groups make one.
  Match match = Match::any_of;
  /// Whether a text with commas is cut there.
  bool splits_at_commas = true;
};

/// A node whose services are wanted, and who to be there.
struct NodeFilter {
  NodeId id{};         ///< zero: any
  std::string name{};  ///< empty: any
  /// Empty: as the subscription's options say.
  std::string username{};
  /// For `username`; usually `password`.
  std::map<std::string, VarValue> credentials{};
};

/// All that is filled in must hold. What a URL does not tell is looked at once connected; a service
/// that does not match is left again, which counts as a failure (service_not_found).
struct ServiceFilter {
  /// One of these. The first that fits says who logs in; to tell nodes apart before that, their
  /// URLs must name them (`nodeid=`, `nodename=`).
  std::vector<NodeFilter> nodes{};
  /// The service has one of these names; empty: any.
  std::vector<std::string> service_names{};
  /// `rr+tcp`, ...: URLs of other schemes are not tried.
  std::vector<std::string> transport_schemes{};
  /// By the attribute's name.
  std::map<std::string, AttributeGroup> attributes{};
  /// How the answers for the attributes make one.
  Match attributes_match = Match::all_of;
  /// Has the last word. Called once connected, on the thread that connects, under no lock; may be
  /// called for several services at once.
  std::function<bool(const FoundService&)> predicate{};
  /// Services that are connected, or being connected, at a time; 0: any number.
  std::size_t max_connections = 0;
};

}  // namespace rr
