// SPDX-License-Identifier: Apache-2.0
// What the goldens are worth: values, tables and classes of generated code, as a user sees them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <rr/codec.hpp>
#include <type_traits>

#include "RobotCameraHost_interface.hpp"
#include "experimental/big_arrays.hpp"
#include "experimental/constants.hpp"
#include "experimental/docs.hpp"
#include "experimental/enums.hpp"
#include "experimental/exceptions.hpp"
#include "experimental/functions.hpp"
#include "experimental/implements.hpp"
#include "experimental/imports.hpp"
#include "experimental/line_ends.hpp"
#include "experimental/members.hpp"
#include "experimental/namedarrays.hpp"
#include "experimental/pods.hpp"
#include "experimental/properties.hpp"
#include "experimental/recursion.hpp"
#include "experimental/reserved_words.hpp"
#include "experimental/rr/std.hpp"
#include "experimental/structs.hpp"

namespace {

using testing::ElementsAre;

std::string text_of(const rr::Definition& definition) {
  const std::string path =
      std::string(ROBDEF_DEFINITIONS_DIR) + "/" + std::string(definition.name) + ".robdef";
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

template <class T>
T sent(const T& value, rr::MessageVersion version) {
  return rr::decode<T>(rr::encode(value, version), version);
}
template <class T>
void expect_to_travel(const T& value) {
  EXPECT_EQ(sent(value, rr::MessageVersion::v2), value);
  EXPECT_EQ(sent(value, rr::MessageVersion::v4), value);
}

std::vector<std::string> names_of(std::span<const rr::Member> members) {
  std::vector<std::string> names;
  for (const rr::Member& member : members) names.emplace_back(member.name);
  return names;
}

TEST(Generated, DefinitionsHoldTheirExactText) {
  EXPECT_EQ(experimental::docs::rr_definition.text, text_of(experimental::docs::rr_definition));
  EXPECT_EQ(experimental::line_ends::rr_definition.text,
            text_of(experimental::line_ends::rr_definition));
  EXPECT_EQ(RobotCameraHost_interface::rr_definition.text,
            text_of(RobotCameraHost_interface::rr_definition));
  EXPECT_EQ(experimental::reserved_words::rr_definition.text,
            text_of(experimental::reserved_words::rr_definition));
}

TEST(Generated, DefinitionsKnowTheirVersionImportsAndContents) {
  const rr::Definition& imports = experimental::imports::rr_definition;
  EXPECT_EQ(imports.version, (rr::DefinitionVersion{0, 10, 0, 0}));
  EXPECT_THAT(imports.imports, ElementsAre(&experimental::namedarrays::rr_definition,
                                           &experimental::enums::rr_definition));
  ASSERT_EQ(imports.records.size(), 1U);
  EXPECT_EQ(imports.records[0]->name(), "experimental.imports.Plan");
  ASSERT_EQ(imports.objects.size(), 1U);
  EXPECT_EQ(imports.objects[0]->name, "experimental.imports.Planner");
  EXPECT_EQ(&imports.objects[0]->definition, &imports);
  EXPECT_EQ(RobotCameraHost_interface::rr_definition.version, rr::DefinitionVersion{});
}

TEST(Generated, StructsTravel) {
  using namespace experimental::structs;
  expect_to_travel(Path{.name = "home",
                        .start = Point{.x = 1, .y = 2},
                        .points = {{Point{.x = 3, .y = 4}, std::nullopt}},
                        .segments = {{{"a", Segment{.number = 5, .lengths = {6, 7}}}}}});
  expect_to_travel(Path{});
  expect_to_travel(Empty{});
}

TEST(Generated, StructsThatContainThemselvesTravel) {
  using namespace experimental::recursion;
  Tree tree{.name = "root"};
  tree.left = Tree{.name = "left"};
  tree.others.emplace();
  tree.others->emplace_back(Tree{.name = "other"});
  expect_to_travel(tree);
  expect_to_travel(Even{.next = Odd{.next = Even{}}});
}

TEST(Generated, PodsAndNamedarraysTravel) {
  using namespace experimental;
  pods::Burst burst;
  burst.header.push_back(7);
  burst.grid(1, 2) = -3;
  burst.samples[2].stamp = 0.5;
  burst.rest.push_back({.sequence = 9});
  burst.corners[1].y = 4;
  expect_to_travel(burst);

  namedarrays::Pose pose{.position = {.x = 1, .y = 2, .z = 3}, .orientation = {1, 0, 0, 0}};
  expect_to_travel(pose);
  EXPECT_THAT(pose.rr_numbers(), ElementsAre(1, 2, 3, 1, 0, 0, 0));
  pose.rr_numbers()[1] = 5;
  EXPECT_EQ(pose.position.y, 5);
  EXPECT_EQ(std::as_const(pose).rr_numbers().size(), 7U);
}

TEST(Generated, LongFixedArraysHaveTheirLengthFromTheStart) {
  const experimental::big_arrays::Block block;
  EXPECT_EQ(block.exact.size(), 100000U);
  EXPECT_EQ(block.picture.items.size(), 1000000U);
  expect_to_travel(block);
}

TEST(Generated, LongFixedArraysOfAnotherLengthAreNotSent) {
  experimental::big_arrays::Block block;
  block.exact = rr::Array<double>(99999);
  EXPECT_THROW((void)rr::encode(block), rr::Error);
  block.exact = rr::Array<double>(100000);
  block.bounded = rr::Array<double>(100001);
  EXPECT_THROW((void)rr::encode(block), rr::Error);
}

TEST(Generated, ConstantsHaveTheirValues) {
  using namespace experimental::constants;
  static_assert(LOWEST == -128 && HIGHEST == 255 && ALL_BITS == 4294967295U);
  static_assert(FAR_BELOW == std::numeric_limits<std::int64_t>::min());
  static_assert(FAR_ABOVE == std::numeric_limits<std::uint64_t>::max());
  static_assert(std::is_same_v<decltype(HALF), const float> && HALF == 0.5F);
  EXPECT_THAT(WEIGHTS, ElementsAre(0.25, -0.5, 1e-3));
  EXPECT_THAT(STEPS, ElementsAre(-1, 0, 1, 127));
  EXPECT_EQ(GREETING, "Say \"hello\"\n\u00e9 \\ /");
  EXPECT_EQ(LIMITS::trim, TRIM);
  EXPECT_EQ(LIMITS::text, GREETING);
  EXPECT_EQ(Setting::START, 1.5);
  EXPECT_EQ(Machine::TITLE, "machine");
}

TEST(Generated, EnumsAreInt32) {
  using experimental::enums::State;
  static_assert(std::is_same_v<std::underlying_type_t<State>, std::int32_t>);
  EXPECT_EQ(static_cast<int>(State::running), 1);
  EXPECT_EQ(static_cast<int>(State::waiting), 16);
  EXPECT_EQ(static_cast<int>(State::failed), -1);
  expect_to_travel(std::optional(std::vector{State::idle, State::failed}));
}

TEST(Generated, ExceptionsAreThrownByTheirTable) {
  const auto exceptions = experimental::exceptions::rr_definition.exceptions;
  ASSERT_EQ(exceptions.size(), 2U);
  EXPECT_EQ(exceptions[0].name, "experimental.exceptions.ToolLost");
  const experimental::exceptions::ToolLost lost("gone", "gripper", 7);
  EXPECT_EQ(lost.code(), rr::ErrorCode::remote_error);
  EXPECT_EQ(lost.name(), "experimental.exceptions.ToolLost");
  try {
    exceptions[0].raise(lost);
    FAIL() << "did not throw";
  } catch (const experimental::exceptions::ToolLost& thrown) {
    EXPECT_EQ(thrown.message(), "gone");
    EXPECT_EQ(thrown.subname(), "gripper");
    EXPECT_EQ(thrown.parameter(), lost.parameter());
  }
}

TEST(Generated, MemberTablesSayWhatTheDefinitionSays) {
  const rr::ObjectType& board = experimental::properties::rr_object_Board;
  EXPECT_EQ(board.members.size(), 21U);
  const rr::Member& shared = board.members[17];
  EXPECT_EQ(shared.name, "shared");
  EXPECT_EQ(shared.kind, rr::MemberKind::property);
  EXPECT_EQ(shared.access, rr::nolock | rr::urgent);
  EXPECT_EQ(shared.type, &rr::type_of<double>);
  EXPECT_EQ(board.members[15].access, rr::readonly);
  EXPECT_EQ(board.members[16].access, rr::writeonly);
  EXPECT_EQ(board.members[20].access, rr::readonly | rr::perclient);

  const rr::Member& depth = experimental::big_arrays::rr_object_Store.members[3];
  ASSERT_EQ(depth.parameters.size(), 1U);
  EXPECT_EQ(depth.parameters[0].name, "raw");
  EXPECT_EQ(depth.parameters[0].type, (&rr::type_of<rr::MaximumLength<std::uint16_t, 70000>>));
}

TEST(Generated, MemberTablesKnowAllKinds) {
  using namespace experimental::members;
  const std::span<const rr::Member> pipes = rr_object_Pipes.members;
  EXPECT_EQ(pipes[4].kind, rr::MemberKind::pipe);
  EXPECT_EQ(pipes[4].access, rr::readonly | rr::unreliable | rr::nolock);
  EXPECT_EQ(pipes[4].type, &rr::type_of<Vector3>);
  EXPECT_EQ(pipes[9].type, (&rr::type_of<rr::FixedLength<double, 100000>>));

  const rr::Member& hurry = rr_object_Callbacks.members[3];
  EXPECT_EQ(hurry.kind, rr::MemberKind::callback);
  EXPECT_EQ(hurry.access, rr::urgent);
  EXPECT_EQ(hurry.type, &rr::type_of<double>);
  ASSERT_EQ(hurry.parameters.size(), 2U);
  EXPECT_EQ(hurry.parameters[0].name, "client");
  EXPECT_EQ(rr_object_Callbacks.members[0].type, nullptr);

  EXPECT_EQ(rr_object_Wires.members[5].kind, rr::MemberKind::wire);
  EXPECT_EQ(rr_object_Wires.members[5].access, rr::readonly | rr::nolock);

  const rr::Member& grid = rr_object_Memories.members[5];
  EXPECT_EQ(grid.kind, rr::MemberKind::memory);
  EXPECT_EQ(grid.access, rr::nolockread);
  EXPECT_EQ(grid.type, &rr::type_of<rr::MultiArray<Sample>>);
}

TEST(Generated, MemberTablesKnowTheFormsOfGenerators) {
  const auto members = experimental::members::rr_object_Generators.members;
  EXPECT_EQ(members[0].generator, rr::GeneratorForm::returns);
  EXPECT_EQ(members[0].generator_parameter, nullptr);
  EXPECT_EQ(members[2].generator, rr::GeneratorForm::takes);
  EXPECT_EQ(members[2].type, nullptr);
  ASSERT_EQ(members[2].parameters.size(), 1U);
  EXPECT_EQ(members[2].parameters[0].name, "label");
  EXPECT_EQ(members[4].generator, rr::GeneratorForm::both);
  EXPECT_EQ(members[4].generator_parameter, &rr::type_of<double>);
  EXPECT_EQ(members[5].access, rr::nolock);
}

TEST(Generated, ClassesFollowImplements) {
  using namespace experimental::implements;
  static_assert(std::is_base_of_v<NamedStub, DriveStub> &&
                std::is_base_of_v<DeviceStub, DriveStub>);
  static_assert(std::is_base_of_v<experimental::objrefs::JointStub, DriveStub>);
  static_assert(std::is_base_of_v<NamedSkeleton, DriveSkeleton>);
  static_assert(std::is_base_of_v<experimental::objrefs::JointSkeleton, DriveSkeleton>);
  EXPECT_THAT(rr_object_Drive.implements,
              ElementsAre("Device", "Powered", "Named", "experimental.objrefs.Joint"));
  EXPECT_THAT(names_of(rr_object_Drive.members),
              ElementsAre("name", "renamed", "reset", "on", "angle", "torque", "part"));
}

TEST(Generated, StubsAreMadeByTheirType) {
  const std::shared_ptr<rr::Stub> stub = experimental::implements::rr_object_Drive.make_stub();
  EXPECT_NE(std::dynamic_pointer_cast<experimental::implements::DriveStub>(stub), nullptr);
  EXPECT_NE(std::dynamic_pointer_cast<experimental::objrefs::JointStub>(stub), nullptr);
  EXPECT_EQ(&stub->rr_object_type(), &experimental::implements::rr_object_Drive);
}

TEST(Generated, DefaultClassesStoreProperties) {
  experimental::properties::BoardDefault board;
  board.set_gain(2.5);
  board.set_label("front");
  board.set_settings({{{"depth", 3.0}}});
  EXPECT_EQ(board.get_gain(), 2.5);
  EXPECT_EQ(board.get_label(), "front");
  EXPECT_EQ(board.get_settings()->at("depth"), rr::VarValue(3.0));
  EXPECT_EQ(board.get_serial_number(), 0);
  EXPECT_FALSE(board.get_names().has_value());
  board.set_page(3);  // outside of a request: what clients start with
  EXPECT_EQ(board.get_page(), 3);
  EXPECT_EQ(experimental::big_arrays::StoreDefault().get_exact().size(), 100000U);
}

TEST(Generated, ObjectsOfFunctionsOnlyHaveDefaultClasses) {
  class Machine : public experimental::functions::MachineDefault {
   public:
    double speed() override { return 2.5; }
  };
  Machine machine;
  EXPECT_EQ(machine.speed(), 2.5);
  try {
    machine.stop();
    FAIL() << "did not throw";
  } catch (const rr::Error& error) {
    EXPECT_EQ(error.code(), rr::ErrorCode::not_implemented_error);
  }
}

TEST(Generated, DefaultClassesFailWhereThereIsNothing) {
  experimental::docs::ShuttersDefault shutters;
  try {
    (void)shutters.move(1, 0.5);
    FAIL() << "did not throw";
  } catch (const rr::Error& error) {
    EXPECT_EQ(error.code(), rr::ErrorCode::not_implemented_error);
  }
  try {
    (void)shutters.get_part(1);
    FAIL() << "did not throw";
  } catch (const rr::Error& error) {
    EXPECT_EQ(error.code(), rr::ErrorCode::object_not_found);
  }
}

}  // namespace
