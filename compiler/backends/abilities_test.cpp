// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "compiler/backends/backend.hpp"

namespace robdef {
namespace {

model::Member member_of(model::MemberKind kind) {
  model::Member member;
  member.kind = kind;
  return member;
}

TEST(Abilities, AreOfKinds) {
  const Abilities abilities{.properties = true, .wires = true};
  EXPECT_TRUE(abilities.serve(member_of(model::MemberKind::property)));
  EXPECT_TRUE(abilities.serve(member_of(model::MemberKind::wire)));
  for (const auto kind :
       {model::MemberKind::function, model::MemberKind::event, model::MemberKind::objref,
        model::MemberKind::pipe, model::MemberKind::callback, model::MemberKind::memory}) {
    EXPECT_FALSE(abilities.serve(member_of(kind))) << model::name_of(kind);
  }
}

TEST(Abilities, TellGeneratorsFromFunctions) {
  model::Member member = member_of(model::MemberKind::function);
  EXPECT_TRUE(Abilities{.functions = true}.serve(member));
  member.generator = model::GeneratorForm::returns;
  EXPECT_FALSE(Abilities{.functions = true}.serve(member));
  EXPECT_TRUE(Abilities{.generators = true}.serve(member));
}

TEST(Abilities, TellMemoriesInContainers) {
  model::Member member = member_of(model::MemberKind::memory);
  EXPECT_TRUE(Abilities{.memories = true}.serve(member));
  member.type.container = model::ContainerForm::list;
  EXPECT_FALSE(Abilities{.memories = true}.serve(member));
  EXPECT_TRUE(Abilities{.contained_memories = true}.serve(member));
}

}  // namespace
}  // namespace robdef
