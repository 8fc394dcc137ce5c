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

// What views of several languages say alike, and one of these.
struct PlantFacts {
  using Facts = PlantFacts;
  std::string wire_name;
  bool is_green = false;

  template <class View>
  static ViewType fields() {
    return {ROBDEF_VIEW_FIELDS(View, wire_name, is_green)};
  }
};
struct PlantView : PlantFacts {
  std::string doc;
  LeafView top;
};

}  // namespace

ROBDEF_VIEW_TYPE(LeafView, name);
ROBDEF_VIEW_TYPE(TreeView, is_old, top, bottom, leaves, words);
ROBDEF_VIEW_TYPE(PlantView, doc, top);

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

TEST(ViewType, PutsFactsBeforeTheFieldsOfTheirView) {
  PlantView plant;
  plant.wire_name = "fern";
  plant.is_green = true;
  plant.doc = "d";
  plant.top = {"t"};
  EXPECT_EQ(view_json(plant),
            R"({
  "wire_name": "fern",
  "is_green": true,
  "doc": "d",
  "top": {
    "name": "t"
  }
}
)");
}

}  // namespace
}  // namespace robdef
