// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/filters.hpp"

#include <utility>

#include "runtime/c/src/border.hpp"
#include "runtime/c/src/found.hpp"
#include "runtime/c/src/node.hpp"

namespace rr::capi {
namespace {

constexpr int deepest_group = 16;

Match read_match(std::uint32_t match, Match otherwise) {
  switch (match) {
    case RR_MATCH_DEFAULT:
      return otherwise;
    case RR_MATCH_ANY:
      return Match::any_of;
    case RR_MATCH_ALL:
      return Match::all_of;
    case RR_MATCH_NONE:
      return Match::none_of;
    case RR_MATCH_NOT_ALL:
      return Match::not_all_of;
    default:
      refuse_argument("there is no such RR_MATCH_...");
  }
}

template <class T>
const T& item(const T* items, std::size_t place, const char* none) {
  return (&need(items, none))[place];
}

AttributeGroup read_group(const rr_attribute_group& given, int depth) {
  if (depth > deepest_group) refuse_argument("groups of attribute tests are nested too deep");
  AttributeGroup group;
  group.match = read_match(given.match, Match::any_of);
  group.splits_at_commas = given.keeps_commas == 0;
  for (std::size_t i = 0; i < given.test_count; ++i) {
    const rr_attribute_test& test = item(given.tests, i, "there are no attribute tests");
    group.tests.push_back({.value = std::string(text(test.value)),
                           .is_expression = test.is_expression != 0,
                           .name = std::string(text(test.name))});
  }
  for (std::size_t i = 0; i < given.group_count; ++i) {
    group.groups.push_back(
        read_group(item(given.groups, i, "there are no groups of attribute tests"), depth + 1));
  }
  return group;
}

NodeFilter read_node(const rr_node_filter& given) {
  NodeFilter node;
  node.id = id_of(given.id);
  node.name = text(given.name);
  node.username = text(given.username);
  if (given.credentials.count != 0) {
    node.credentials = read_map(given.credentials);
  } else if (!node.username.empty()) {
    node.credentials.emplace("password", std::string(text(given.password)));
  }
  return node;
}

}  // namespace

ServiceFilter read_filter(const rr_service_filter* given) {
  ServiceFilter filter;
  if (given == nullptr) return filter;
  const auto functions = take_handler(given);
  const rr_service_filter& terms = **functions;
  for (std::size_t i = 0; i < terms.node_count; ++i) {
    filter.nodes.push_back(read_node(item(terms.nodes, i, "there are no nodes in the filter")));
  }
  filter.service_names = read_texts(terms.service_names, terms.service_name_count,
                                    "there are no names of services in the filter");
  filter.transport_schemes = read_texts(terms.transport_schemes, terms.transport_scheme_count,
                                        "there are no schemes in the filter");
  for (std::size_t i = 0; i < terms.attribute_count; ++i) {
    const rr_attribute_group& group = item(terms.attributes, i, "there are no attributes");
    const std::string name(text(group.attribute));
    if (name.empty()) refuse_argument("an attribute in the filter has no name");
    if (!filter.attributes.emplace(name, read_group(group, 1)).second) {
      refuse_argument("an attribute is in the filter twice");
    }
  }
  filter.attributes_match = read_match(terms.attributes_match, Match::all_of);
  filter.max_connections = terms.max_connections;
  if (terms.predicate != nullptr) {
    filter.predicate = [functions](const FoundService& service) {
      const FoundServiceView view(service);
      return (*functions)->predicate((*functions)->context, &view.info()) != 0;
    };
  }
  return filter;
}

}  // namespace rr::capi
