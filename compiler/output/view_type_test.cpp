// SPDX-License-Identifier: Apache-2.0
#include "compiler/output/view_type.hpp"

#include <gtest/gtest.h>

namespace robdef {
namespace {

struct LeafView {
  std::string name;
};
struct TreeView {
  bool is_old = false;
  LeafView top;
  std::optional<LeafView> bottom;
  std::vector<LeafView> leaves;
  std::vector<std::string> words;
};

}  // namespace

template <>
const ViewType& view_type<LeafView>() {
  static const ViewType type{view_field<&LeafView::name>("name")};
  return type;
}
template <>
const ViewType& view_type<TreeView>() {
  static const ViewType type{
      view_field<&TreeView::is_old>("is_old"), view_field<&TreeView::top>("top"),
      view_field<&TreeView::bottom>("bottom"), view_field<&TreeView::leaves>("leaves"),
      view_field<&TreeView::words>("words")};
  return type;
}

namespace {

TEST(ViewType, WritesAViewAsJsonInTheOrderOfItsTable) {
  const TreeView tree{.is_old = true,
                      .top = {"t"},
                      .bottom = std::nullopt,
                      .leaves = {{"a"}, {"b"}},
                      .words = {"x", "y"}};
  EXPECT_EQ(view_json(tree),
            R"({
  "is_old": true,
  "top": {
    "name": "t"
  },
  "bottom": null,
  "leaves": [
    {
      "name": "a"
    },
    {
      "name": "b"
    }
  ],
  "words": [
    "x",
    "y"
  ]
}
)");
}

}  // namespace
}  // namespace robdef
