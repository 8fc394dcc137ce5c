// SPDX-License-Identifier: Apache-2.0
#include "rr/registry.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <span>

#include "rr/time_spec.hpp"
#include "runtime/cpp/src/value/conformance_types.hpp"

namespace rr {
namespace {

using conformance::types::rr_definition;
using conformance::types::rr_Stats;

extern const Definition arm;
constexpr Definition hand{.name = "example.hand",
                          .text = {},
                          .version = {},
                          .imports = {},
                          .records = {},
                          .exceptions = {},
                          .objects = {}};
// Two definitions that import each other end the walk all the same.
constexpr const Definition* arm_imports[] = {&rr_definition, &hand, &arm};
constexpr ExceptionType arm_exceptions[] = {{"example.arm.Stuck", nullptr}};
constexpr ObjectType arm_object{.name = "example.arm.Arm",
                                .definition = arm,
                                .implements = {},
                                .members = {},
                                .make_stub = nullptr};
constexpr const ObjectType* arm_objects[] = {&arm_object};
constinit const Definition arm{.name = "example.arm",
                               .text = {},
                               .version = {},
                               .imports = arm_imports,
                               .records = {},
                               .exceptions = arm_exceptions,
                               .objects = arm_objects};

TEST(TypeRegistry, KnowsADefinitionAndItsImports) {
  const TypeRegistry types(arm);
  EXPECT_EQ(types.find_definition("example.arm"), &arm);
  EXPECT_EQ(types.find_definition("example.hand"), &hand);
  EXPECT_TRUE(types.knows_service("conformance.types"));
  EXPECT_EQ(types.find_record("conformance.types.Stats"), &rr_Stats);
  EXPECT_EQ(types.find_object("example.arm.Arm"), &arm_object);
  EXPECT_EQ(types.find_exception("example.arm.Stuck"), &arm_exceptions[0]);
}

TEST(TypeRegistry, FindsInTheOneItContinuesIn) {
  const TypeRegistry later(rr_definition);
  TypeRegistry first;
  EXPECT_EQ(first.find_definition(rr_definition.name), nullptr);
  first.continue_in(later);
  EXPECT_EQ(first.find_definition(rr_definition.name), &rr_definition);
  const TypeRegistry copy = first;
  EXPECT_EQ(copy.find_definition(rr_definition.name), &rr_definition);
}

std::shared_ptr<Stub> no_stub() { return nullptr; }
constexpr ObjectType arm_with_stub{.name = "example.arm.Arm",
                                   .definition = arm,
                                   .implements = {},
                                   .members = {},
                                   .make_stub = no_stub};
constexpr ObjectType claw{.name = "example.arm.Claw",
                          .definition = arm,
                          .implements = {},
                          .members = {},
                          .make_stub = nullptr};
constexpr ObjectType other_arm = arm_with_stub;
constexpr const ObjectType* objects_with_stub[] = {&arm_with_stub, &claw};
constexpr const ObjectType* other_objects[] = {&other_arm};

constexpr Definition arm_of(std::span<const ObjectType* const> objects) {
  return {.name = "example.arm",
          .text = {},
          .version = {},
          .imports = {},
          .records = {},
          .exceptions = {},
          .objects = objects};
}

TEST(TypeRegistry, TakesStubsFromTheFirstDefinitionThatHasThem) {
  static constexpr Definition with_stub = arm_of(objects_with_stub);
  static constexpr Definition other = arm_of(other_objects);
  TypeRegistry types(arm);
  types.add(with_stub);
  EXPECT_EQ(types.find_definition("example.arm"), &arm);
  EXPECT_EQ(types.find_object("example.arm.Arm"), &arm_with_stub);
  EXPECT_EQ(types.find_object("example.arm.Claw"), &claw);
  types.add(other);
  EXPECT_EQ(types.find_object("example.arm.Arm"), &arm_with_stub);
}

TEST(TypeRegistry, FindsNothingElse) {
  const TypeRegistry types(arm);
  EXPECT_EQ(types.find_definition("example.leg"), nullptr);
  EXPECT_FALSE(types.knows_service("example"));
  EXPECT_EQ(types.find_record("example.arm.Stats"), nullptr);
  EXPECT_EQ(types.find_record("Stats"), nullptr);
  EXPECT_EQ(types.find_object("example.arm.Stuck"), nullptr);
  EXPECT_EQ(types.find_exception("example.arm.Arm"), nullptr);
}

TEST(TypeRegistry, KnowsTheTypeOfTheProtocolItself) {
  const TypeRegistry types;
  EXPECT_EQ(types.find_record("RobotRaconteur.TimeSpec"), &time_spec_type);
  EXPECT_TRUE(types.knows_service("RobotRaconteur"));
}

}  // namespace
}  // namespace rr
