// SPDX-License-Identifier: Apache-2.0
#include "compiler/model/rename.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "compiler/model/compiled.hpp"

namespace robdef::model {
namespace {

const std::string base =
    "service example\nstdver 0.10\nconstant double LIMIT 3\nexception Lost\n"
    "enum mode\n  off = 0\nend\nstruct Pose\n  constant int32 SIZE 1\n  field double x\nend\n"
    "object Arm\n  constant double REACH 1\n  property double nectarAnchor\n"
    "  property double nectar_anchor\n"
    "  function void turn(double angle, double{generator} steps)\nend\n";
const std::string derived =
    "service example.more\nstdver 0.10\nimport example\nobject LongArm\n  implements example.Arm\n"
    "  property double nectarAnchor\n  property double nectar_anchor\n  property double "
    "length\n  function void turn(double angle, double{generator} steps)\nend\n";

// What `rename` says of all wishes.
std::string renamed(Model& model, const std::vector<Rename>& renames) {
  std::string text;
  for (const RenameFault& fault : rename(model, renames)) text += fault.text();
  return text;
}

// What it says of one.
std::string fault(const std::string& path, const std::string& name) {
  Compiled compiled = model::compiled({base, derived});
  return renamed(compiled.model, {{path, name}});
}

TEST(Rename, ReachesEachKindOfName) {
  Compiled compiled = model::compiled({base, derived});
  ASSERT_TRUE(compiled.errors().empty());
  const std::vector<Rename> renames{{"example.LIMIT", "top"},
                                    {"example.mode", "state"},
                                    {"example.mode.off", "idle"},
                                    {"example.Pose", "Place"},
                                    {"example.Pose.x", "east"},
                                    {"example.Pose.SIZE", "extent"},
                                    {"example.Lost", "Astray"},
                                    {"example.Arm", "Limb"},
                                    {"example.Arm.REACH", "range"},
                                    {"example.more.LongArm", "Boom"},
                                    {"example.more.LongArm.length", "size"}};
  EXPECT_EQ(renamed(compiled.model, renames), "");
  const Definition& definition = compiled.definition(0);
  EXPECT_EQ(code_name(definition.constants[0]), "top");
  EXPECT_EQ(code_name(definition.enums[0]), "state");
  EXPECT_EQ(code_name(definition.enums[0].values[0]), "idle");
  EXPECT_EQ(code_name(compiled.record("Pose")), "Place");
  EXPECT_EQ(code_name(compiled.record("Pose").fields[0]), "east");
  EXPECT_EQ(code_name(compiled.record("Pose").constants[0]), "extent");
  EXPECT_EQ(code_name(definition.exceptions[0]), "Astray");
  EXPECT_EQ(code_name(compiled.object("Arm")), "Limb");
  EXPECT_EQ(code_name(compiled.object("Arm").constants[0]), "range");
  EXPECT_EQ(code_name(compiled.object("LongArm")), "Boom");
  EXPECT_EQ(code_name(compiled.member("LongArm", "length")), "size");
  // What is on the wire stays.
  EXPECT_EQ(compiled.object("Arm").name, "Arm");
}

TEST(Rename, OfAMemberHoldsForWhatImplementsItsObject) {
  Compiled compiled = model::compiled({base, derived});
  const std::vector<Rename> renames{{"example.Arm.nectar_anchor", "second_anchor"}};
  EXPECT_EQ(renamed(compiled.model, renames), "");
  EXPECT_EQ(code_name(compiled.member("Arm", "nectar_anchor")), "second_anchor");
  EXPECT_EQ(code_name(compiled.member("Arm", "nectarAnchor")), "nectarAnchor");
  EXPECT_EQ(code_name(compiled.member("LongArm", "nectar_anchor")), "second_anchor");
}

TEST(Rename, ReachesParametersAndTheLastOneOfAGenerator) {
  Compiled compiled = model::compiled({base, derived});
  ASSERT_TRUE(compiled.errors().empty());
  EXPECT_EQ(renamed(compiled.model,
                    {{"example.Arm.turn.angle", "by"}, {"example.Arm.turn.steps", "each"}}),
            "");
  for (const char* object : {"Arm", "LongArm"}) {
    const Member& turn = compiled.member(object, "turn");
    EXPECT_EQ(code_name(turn.parameters.front()), "by");
    EXPECT_EQ(turn.parameters.front().name, "angle");
    EXPECT_EQ(code_name(*turn.generator_parameter), "each");
  }
}

TEST(Rename, ForgetsTheNamesOfAnEarlierCall) {
  Compiled compiled = model::compiled({base, derived});
  EXPECT_EQ(renamed(compiled.model, {{"example.Arm", "Limb"},
                                     {"example.Pose.x", "east"},
                                     {"example.Arm.turn.angle", "by"}}),
            "");
  EXPECT_EQ(renamed(compiled.model, {{"example.mode.off", "idle"}}), "");
  EXPECT_EQ(code_name(compiled.object("Arm")), "Arm");
  EXPECT_EQ(code_name(compiled.record("Pose").fields[0]), "x");
  EXPECT_EQ(code_name(compiled.member("LongArm", "turn").parameters[0]), "angle");
  EXPECT_EQ(code_name(compiled.definition(0).enums[0].values[0]), "idle");
}

TEST(Rename, SaysWhatIsWrongWithAPath) {
  EXPECT_EQ(fault("example.more.LongArm.nectar_anchor", "other"),
            "cannot rename `example.more.LongArm.nectar_anchor`: it is declared by `example.Arm`; "
            "rename it there");
  EXPECT_EQ(fault("example.Arm.nectar_ancor", "other"),
            "cannot rename `example.Arm.nectar_ancor`: there is no `nectar_ancor` in example.Arm; "
            "did you mean `nectar_anchor`?");
  EXPECT_EQ(fault("example.Leg.x", "other"),
            "cannot rename `example.Leg.x`: there is no `Leg` in example");
  EXPECT_EQ(fault("other.Arm", "other"),
            "cannot rename `other.Arm`: it begins with no definition that is read");
  EXPECT_EQ(fault("example.Arm.REACH", "2nd"),
            "cannot rename `example.Arm.REACH`: `2nd` is no name");
  EXPECT_EQ(fault("example.Arm.REACH", ""), "cannot rename `example.Arm.REACH`: `` is no name");
  EXPECT_EQ(fault("example.Arm.REACH", "get_it"),
            "cannot rename `example.Arm.REACH`: `get_it` begins with a reserved prefix");
  EXPECT_EQ(fault("example.Arm.turn.angel", "other"),
            "cannot rename `example.Arm.turn.angel`: there is no `angel` in example.Arm.turn; "
            "did you mean `angle`?");
  EXPECT_EQ(fault("example.Arm.tun.angle", "other"),
            "cannot rename `example.Arm.tun.angle`: there is no `tun` in example.Arm; "
            "did you mean `turn`?");
  EXPECT_EQ(fault("example.more.LongArm.turn.angle", "other"),
            "cannot rename `example.more.LongArm.turn.angle`: it is declared by `example.Arm`; "
            "rename it there");
  EXPECT_EQ(fault("exmaple.Arm", "other"),
            "cannot rename `exmaple.Arm`: it begins with no definition that is read; did you mean "
            "`example`?");
  EXPECT_EQ(fault("example", "other"),
            "cannot rename `example`: it begins with no definition that is read");
}

}  // namespace
}  // namespace robdef::model
