// SPDX-License-Identifier: Apache-2.0
// What an editor gets for definitions, by value.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "compiler/lsp/testing.hpp"

namespace robdef::lsp {
namespace {

using ::testing::Contains;
using testing::Editor;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::with_edits;

const std::string geometry =
    "service example.geometry\nstdver 0.10\n\n## A pose.\nstruct Pose\n    field double x\nend\n"
    "object Base\n    property double speed\nend\n";
const std::string arm =
    "service example.arm\nstdver 0.10\nimport example.geometry\n"
    "using example.geometry.Pose as P\n\nenum Mode\n    idle = 4,\n    moving\nend\n\n"
    "object Arm\n    implements example.geometry.Base\n"
    "    property double speed\n"
    "    property P where [readonly]\n"
    "    function void go(example.geometry.Pose to, Mode mode)\nend\n";

std::vector<std::string> labels(const Json& list) {
  std::vector<std::string> all;
  for (const Json& item : list["items"]) all.push_back(item["label"]);
  return all;
}

// Both files, the second one open.
class Features : public ::testing::Test {
 protected:
  Features() {
    editor.write("example.geometry.robdef", geometry);
    editor.open("example.arm.robdef", arm);
  }

  // What is offered behind a line that is put below line 10, within the object.
  std::vector<std::string> offered(const std::string& line, std::uint32_t at = 11) {
    editor.edit("example.arm.robdef", {{at, 0}, {at, 0}}, line + "\n");
    return labels(editor.at("textDocument/completion", "example.arm.robdef",
                            {at, static_cast<std::uint32_t>(line.size())}));
  }

  Editor editor;
};

TEST_F(Features, AGoodFileHasNoDiagnostics) {
  EXPECT_THAT(editor.codes("example.arm.robdef"), IsEmpty());
}

TEST_F(Features, DiagnosticsComeWhileTypingAndGo) {
  editor.edit("example.arm.robdef", {{13, 13}, {13, 14}}, "Q");
  const Json all = editor.diagnostics("example.arm.robdef");
  ASSERT_EQ(all.size(), 1) << all;
  EXPECT_EQ(all[0]["code"], "R0203");
  EXPECT_EQ(all[0]["severity"], 1);
  EXPECT_EQ(range_from(all[0]["range"]), (Range{{13, 13}, {13, 14}}));
  editor.edit("example.arm.robdef", {{13, 13}, {13, 14}}, "P");
  EXPECT_THAT(editor.codes("example.arm.robdef"), IsEmpty());
}

TEST_F(Features, ADiagnosticNamesItsOtherPlaces) {
  editor.edit("example.arm.robdef", {{7, 4}, {7, 10}}, "idle");
  const Json all = editor.diagnostics("example.arm.robdef");
  ASSERT_EQ(all.size(), 1) << all;
  const Json& other = all[0]["relatedInformation"][0]["location"];
  EXPECT_EQ(other["uri"], editor.uri("example.arm.robdef"));
  EXPECT_EQ(range_from(other["range"]), (Range{{6, 4}, {6, 8}}));
}

TEST_F(Features, AnOpenFileStandsInPlaceOfTheOneOnTheDisk) {
  EXPECT_THAT(editor.codes("example.arm.robdef"), IsEmpty());
  editor.open("example.geometry.robdef", geometry);
  EXPECT_THAT(editor.codes("example.arm.robdef"), IsEmpty());
  editor.edit("example.geometry.robdef", {{4, 7}, {4, 11}}, "Place");
  EXPECT_THAT(editor.codes("example.arm.robdef"), ElementsAre("R0508", "R0203"));
  editor.close("example.geometry.robdef");
  EXPECT_THAT(editor.codes("example.arm.robdef"), IsEmpty());
  EXPECT_EQ(editor.diagnostics("example.geometry.robdef"), Json::array());
}

TEST_F(Features, LevelsAndFoldersAreThoseOfTheProjectFile) {
  editor.write("p/robdef.toml", "import-path = [\"far\"]\n[levels]\nR0610 = \"deny\"\n");
  editor.write("p/far/example.far.robdef", "service example.far\n");
  editor.open(
      "p/example.p.robdef",
      "service example.p\nimport example.far\nobject O\nproperty double a [strange]\nend\n");
  const Json all = editor.diagnostics("p/example.p.robdef");
  ASSERT_EQ(all.size(), 1) << all;
  EXPECT_EQ(all[0]["code"], "R0610");
  EXPECT_EQ(all[0]["severity"], 1);
}

TEST_F(Features, AnImportThatAppearsIsFound) {
  editor.open("example.b.robdef", "service example.b\nimport example.new\n");
  EXPECT_THAT(editor.codes("example.b.robdef"), ElementsAre("R0505"));
  editor.write("example.new.robdef", "service example.new\n");
  editor.notify("workspace/didChangeWatchedFiles", {{"changes", Json::array()}});
  EXPECT_THAT(editor.codes("example.b.robdef"), IsEmpty());
}

TEST_F(Features, CompletesStatementsOfTheBlock) {
  EXPECT_THAT(offered("    pro"), Contains("property"));
  EXPECT_THAT(offered("    "), Not(Contains("field")));
  EXPECT_THAT(offered("", 5), Contains("struct"));
  EXPECT_THAT(offered("", 5), Not(Contains("wire")));
}

TEST_F(Features, CompletesTypes) {
  const auto types = offered("    property ");
  for (const char* type : {"double", "Mode", "P", "varvalue"}) EXPECT_THAT(types, Contains(type));
  for (const char* other : {"void", "Arm", "varobject"}) EXPECT_THAT(types, Not(Contains(other)));
  EXPECT_THAT(offered("    function "), Contains("void"));
  EXPECT_THAT(offered("    function void g(Mo"), Contains("Mode"));
  EXPECT_THAT(offered("    objref "), Contains("Arm"));
  EXPECT_THAT(offered("    objref "), Contains("example.geometry.Base"));
  EXPECT_THAT(offered("    property double "), IsEmpty());
}

TEST_F(Features, CompletesModifiersOfTheKind) {
  EXPECT_THAT(offered("    pipe double p ["), Contains("unreliable"));
  EXPECT_THAT(offered("    property double p ["), Not(Contains("unreliable")));
  EXPECT_THAT(offered("    property double p [readonly, "), Not(Contains("readonly")));
  EXPECT_THAT(offered("    property double{"), ElementsAre("list", "int32", "string"));
}

TEST_F(Features, CompletesImportsAndUsing) {
  editor.write("example.other.robdef", "service example.other\n");
  EXPECT_THAT(offered("import ", 2), ElementsAre("example.other"));
  EXPECT_THAT(offered("using example.", 5), Contains("example.geometry.Pose"));
}

TEST_F(Features, ACompletionReplacesTheDottedWord) {
  editor.edit("example.arm.robdef", {{11, 0}, {11, 0}}, "    objref example.ge\n");
  const Json list = editor.at("textDocument/completion", "example.arm.robdef", {11, 21});
  for (const Json& item : list["items"]) {
    EXPECT_EQ(range_from(item["textEdit"]["range"]), (Range{{11, 11}, {11, 21}}));
  }
}

TEST_F(Features, HoverShowsSignatureAndDocumentation) {
  const Json hover = editor.at("textDocument/hover", "example.arm.robdef", {14, 40});
  const std::string text = hover["contents"]["value"];
  EXPECT_THAT(text, HasSubstr("struct Pose"));
  EXPECT_THAT(text, HasSubstr("A pose."));
  EXPECT_EQ(range_from(hover["range"]), (Range{{14, 38}, {14, 42}}));
  const Json alias = editor.at("textDocument/hover", "example.arm.robdef", {13, 13});
  EXPECT_THAT(alias["contents"]["value"].get<std::string>(),
              HasSubstr("`P` stands for `example.geometry.Pose`"));
  const Json value = editor.at("textDocument/hover", "example.arm.robdef", {7, 5});
  EXPECT_THAT(value["contents"]["value"].get<std::string>(), HasSubstr("value 5"));
  const Json word = editor.at("textDocument/hover", "example.arm.robdef", {13, 24});
  EXPECT_THAT(word["contents"]["value"].get<std::string>(), HasSubstr("Clients can read"));
  EXPECT_TRUE(editor.at("textDocument/hover", "example.arm.robdef", {4, 0}).is_null());
}

TEST_F(Features, DefinitionsAreInOtherFiles) {
  const Json place = editor.at("textDocument/definition", "example.arm.robdef", {13, 13});
  EXPECT_EQ(place["uri"], editor.uri("example.geometry.robdef"));
  EXPECT_EQ(range_from(place["range"]), (Range{{4, 7}, {4, 11}}));
}

TEST_F(Features, ReferencesAreFoundInAllFiles) {
  editor.open("example.geometry.robdef", geometry);
  const auto count = [&](bool with_declaration) {
    return editor
        .at("textDocument/references", "example.geometry.robdef", {4, 8},
            {{"context", {{"includeDeclaration", with_declaration}}}})
        .size();
  };
  EXPECT_EQ(count(false), 3) << "using, by its alias, by its full name";
  EXPECT_EQ(count(true), 4);
}

TEST_F(Features, HighlightsAreThoseOfTheFile) {
  EXPECT_EQ(editor.at("textDocument/documentHighlight", "example.arm.robdef", {5, 6}).size(), 2);
}

TEST_F(Features, TheOutlineHasTheParts) {
  const Json all = editor.of("textDocument/documentSymbol", "example.arm.robdef");
  ASSERT_EQ(all.size(), 2) << all;
  EXPECT_EQ(all[0]["name"], "Mode");
  EXPECT_EQ(range_from(all[0]["range"]), (Range{{5, 0}, {8, 3}}));
  EXPECT_EQ(all[1]["children"].size(), 3);
  EXPECT_EQ(all[1]["children"][2]["name"], "go");
  const Json folds = editor.of("textDocument/foldingRange", "example.arm.robdef");
  EXPECT_EQ(folds[0], (Json{{"startLine", 5}, {"endLine", 8}}));
}

TEST_F(Features, SymbolsOfTheWorkspaceAreFoundByTheirLetters) {
  const Json all = editor.call("workspace/symbol", {{"query", "ps"}})["result"];
  ASSERT_EQ(all.size(), 1) << all;
  EXPECT_EQ(all[0]["name"], "Pose");
  EXPECT_EQ(all[0]["containerName"], "example.geometry");
}

Json rename(Editor& editor, std::string_view file, Place place, const std::string& name) {
  return editor.call("textDocument/rename", {{"textDocument", {{"uri", editor.uri(file)}}},
                                             {"position", to_json(place)},
                                             {"newName", name}});
}

TEST_F(Features, RenamesInOpenAndClosedFiles) {
  const Json edit = rename(editor, "example.arm.robdef", {14, 40}, "Position")["result"];
  const Json& changes = edit["changes"];
  EXPECT_THAT(with_edits(geometry, changes[editor.uri("example.geometry.robdef")]),
              HasSubstr("struct Position\n"));
  const std::string after = with_edits(arm, changes[editor.uri("example.arm.robdef")]);
  EXPECT_THAT(after, HasSubstr("using example.geometry.Position as P\n"));
  EXPECT_THAT(after, HasSubstr("go(example.geometry.Position to"));
  EXPECT_THAT(after, HasSubstr("property P where"));
}

TEST_F(Features, RenamesTheMembersThatImplementEachOther) {
  const Json edit = rename(editor, "example.arm.robdef", {12, 22}, "velocity")["result"];
  EXPECT_EQ(edit["changes"].size(), 2);
  EXPECT_THAT(with_edits(geometry, edit["changes"][editor.uri("example.geometry.robdef")]),
              HasSubstr("property double velocity"));
}

TEST_F(Features, RefusesNamesThatCannotBe) {
  const auto refused = [&](Place place, const std::string& name) {
    const Json answer = rename(editor, "example.arm.robdef", place, name);
    return at_path(answer, {"error", "code"}) == Json(-32803);
  };
  EXPECT_TRUE(refused({5, 6}, "Arm")) << "another declaration";
  EXPECT_TRUE(refused({5, 6}, "P")) << "an alias";
  EXPECT_TRUE(refused({6, 5}, "moving")) << "another value";
  EXPECT_TRUE(refused({12, 22}, "go")) << "another member";
  EXPECT_TRUE(refused({14, 45}, "mode")) << "another parameter";
  EXPECT_TRUE(refused({5, 6}, "a b"));
  EXPECT_TRUE(refused({5, 6}, ""));
  EXPECT_TRUE(refused({5, 6}, "struct"));
  EXPECT_TRUE(refused({0, 10}, "other")) << "a service";
  EXPECT_TRUE(refused({4, 0}, "other")) << "no name";
  EXPECT_FALSE(refused({5, 6}, "State"));
}

TEST_F(Features, PrepareRenameGivesTheName) {
  const Json found = editor.at("textDocument/prepareRename", "example.arm.robdef", {5, 6});
  EXPECT_EQ(found["placeholder"], "Mode");
  EXPECT_EQ(range_from(found["range"]), (Range{{5, 5}, {5, 9}}));
}

TEST_F(Features, LaysOutAsTheFormatCommandDoes) {
  editor.edit("example.arm.robdef", {{13, 0}, {13, 4}}, " ");
  const Json edits = editor.call("textDocument/formatting",
                                 {{"textDocument", {{"uri", editor.uri("example.arm.robdef")}}},
                                  {"options", Json::object()}})["result"];
  std::string changed = arm;
  changed.replace(changed.find("    property P"), 4, " ");
  std::string wanted = arm;
  for (const char* line : {"stdver", "import", "using"}) wanted.insert(wanted.find(line), "\n");
  EXPECT_EQ(with_edits(changed, edits), wanted);
}

Json fixes(Editor& editor, std::string_view file, std::uint32_t line) {
  editor.diagnostics(file);
  return editor.call("textDocument/codeAction",
                     {{"textDocument", {{"uri", editor.uri(file)}}},
                      {"range", to_json(Range{{line, 0}, {line, 99}})},
                      {"context", {{"diagnostics", Json::array()}}}})["result"];
}

TEST_F(Features, AQuickFixDoesWhatTheHelpSays) {
  editor.edit("example.arm.robdef", {{14, 47}, {14, 51}}, "Mod");
  const Json actions = fixes(editor, "example.arm.robdef", 14);
  ASSERT_EQ(actions.size(), 1) << actions;
  EXPECT_EQ(actions[0]["title"], "Write `Mode`");
  EXPECT_EQ(actions[0]["kind"], "quickfix");
  const Json& edits = actions[0]["edit"]["changes"][editor.uri("example.arm.robdef")];
  EXPECT_EQ(edits[0]["newText"], "Mode");
  EXPECT_EQ(range_from(edits[0]["range"]), (Range{{14, 47}, {14, 50}}));
}

TEST_F(Features, AQuickFixCanHaveSeveralPlaces) {
  editor.write("example.far.robdef", "service example.far\nimport example.geometry\n");
  const std::string text =
      "service example.c\r\nimport example.far\r\nobject O\r\nproperty Pose p\r\nend\r\n";
  editor.open("example.c.robdef", text);
  const Json actions = fixes(editor, "example.c.robdef", 3);
  ASSERT_EQ(actions.size(), 1) << actions;
  EXPECT_EQ(with_edits(text, actions[0]["edit"]["changes"][editor.uri("example.c.robdef")]),
            "service example.c\r\nimport example.far\r\nimport example.geometry\r\nobject O\r\n"
            "property example.geometry.Pose p\r\nend\r\n");
}

TEST_F(Features, ModifiersAndKeywordsHaveQuickFixes) {
  const std::string text = "service example.m\nobject O\nfield double a [readonli]\nend\n";
  editor.open("example.m.robdef", text);
  const Json field = fixes(editor, "example.m.robdef", 2);
  ASSERT_EQ(field.size(), 1) << field;
  const std::string after =
      with_edits(text, field[0]["edit"]["changes"][editor.uri("example.m.robdef")]);
  EXPECT_EQ(after, "service example.m\nobject O\nproperty double a [readonli]\nend\n");
  editor.open("example.m.robdef", after);
  const Json modifier = fixes(editor, "example.m.robdef", 2);
  ASSERT_EQ(modifier.size(), 1) << modifier;
  EXPECT_EQ(with_edits(after, modifier[0]["edit"]["changes"][editor.uri("example.m.robdef")]),
            "service example.m\nobject O\nproperty double a [readonly]\nend\n");
}

TEST_F(Features, ColoursHaveTheirPlaces) {
  editor.open("example.t.robdef",
              "service example.t\n# c\nstruct S\nfield double[3] a [readonly]\nend\n");
  const Json tokens = editor.of("textDocument/semanticTokens/full", "example.t.robdef")["data"];
  // Line, character, length, type, modifiers.
  const Json expected = {0,  0, 7, 11, 0, 0, 8, 9, 0, 1,  1,  0, 3, 13, 0, 1,  0, 6, 11,
                         0,  0, 7, 1,  4, 1, 1, 0, 5, 11, 0,  0, 6, 6,  1, 4,  0, 7, 1,
                         15, 0, 0, 3,  1, 6, 1, 0, 3, 8,  12, 0, 1, 0,  3, 11, 0};
  EXPECT_EQ(tokens, expected);
}

}  // namespace
}  // namespace robdef::lsp
