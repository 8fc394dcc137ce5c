// SPDX-License-Identifier: Apache-2.0
// Runs the built program with plug-ins: scripts, and that of examples/plugin.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "compiler/driver/program.hpp"

namespace robdef {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class PluginCommand : public testing::Test {
 protected:
  PluginCommand() {
    folder_.write("example.t.robdef",
                  "service example.t\nstdver 0.10\n\nobject O\n    property double x\nend\n");
  }

  // A script of the shell that reads everything and prints this answer.
  void write_plugin(const std::string& name, const std::string& answer) const {
    write_script(name, "cat >/dev/null\ncat <<'END'\n" + answer + "\nEND\n");
  }
  void write_script(const std::string& name, const std::string& script) const {
    fs::permissions(folder_.write(name, "#!/bin/sh\n" + script), fs::perms::owner_all);
  }
  Ended run(const std::vector<std::string>& arguments) { return run_robdef(folder_, arguments); }
  Ended generate(const std::string& plugin) {
    return run({"generate", "--plugin", plugin, "-o", "out", "example.t.robdef"});
  }
  [[nodiscard]] bool has(const std::string& file) const {
    return fs::exists(folder_.path() / file);
  }

  TemporaryFolder folder_;
};

TEST_F(PluginCommand, WritesTheFilesOfTheAnswer) {
  write_plugin("p", R"({"files":[{"path":"a/b.txt","content":"text\n"}]})");
  const Ended ended = generate("./p");
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(read_text(folder_ / "out/a/b.txt"), "text\n");
  EXPECT_THAT(folder_.files(), ElementsAre("example.t.robdef", "out/a/b.txt", "p"));
  EXPECT_EQ(run({"generate", "--plugin", "./p", "--list-outputs", "example.t.robdef"}).out,
            "a/b.txt\n");
  EXPECT_EQ(run({"generate", "--plugin", "./p", "-o", "out", "--depfile", "d", "example.t.robdef"})
                .status,
            0);
  EXPECT_EQ(read_text(folder_ / "d"), "out/a/b.txt: \\\n  example.t.robdef \\\n  ./p\n");
}

TEST_F(PluginCommand, FindingsAreThoseOfTheCompiler) {
  const std::string at = R"("at":{"file":"example.t.robdef","line":5,"column":21,"length":1}})";
  write_plugin("p", R"({"files":[{"path":"a","content":""}],"findings":[{"level":"error",)"
                    R"("message":"x is no name",)" +
                        at + "]}");
  const Ended ended = generate("./p");
  EXPECT_EQ(ended.status, 1);
  EXPECT_EQ(ended.err,
            "error[R1001]: x is no name\n --> example.t.robdef:5:21\n  |\n"
            "5 |     property double x\n  |                     ^\n"
            "  = note: said by the plug-in `./p`\n\n1 error\n");
  EXPECT_FALSE(has("out"));
  write_plugin("p", R"({"files":[{"path":"a","content":""}],"findings":[{"level":"warning",)"
                    R"("message":"all is short"}]})");
  const Ended warned = generate("./p");
  EXPECT_EQ(warned.status, 0);
  EXPECT_THAT(warned.err, AllOf(StartsWith("warning[R1002]: all is short\n"),
                                HasSubstr("example.t.robdef:1:9"), EndsWith("\n1 warning\n")));
  EXPECT_TRUE(has("out/a"));
  EXPECT_EQ(run({"generate", "--plugin", "./p", "--deny", "R1002", "example.t.robdef"}).status, 1);
  EXPECT_EQ(run({"generate", "--plugin", "./p", "--allow", "R1002", "example.t.robdef"}).err, "");
}

TEST_F(PluginCommand, AFailingPluginWritesNothing) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"exit 3", "failed with exit status 3"},
      {"kill -15 $$", "was ended by signal 15 (Terminated)"},
      {"echo Hello",
       ": its answer is no JSON, at byte 1; what is for people belongs to standard error"},
      {"cat >/dev/null", ": it printed no answer"},
      {"cat >/dev/null; echo '{\"files\":[{\"path\":\"../x\",\"content\":\"\"}]}'",
       ": its path `../x` leads out of the output folder"},
  };
  for (const auto& [script, fault] : cases) {
    write_script("p", script + "\n");
    const Ended ended = generate("./p");
    EXPECT_EQ(ended.status, 1) << script;
    EXPECT_THAT(ended.err, AllOf(StartsWith("robdef: the plug-in `./p`"), HasSubstr(fault)));
    EXPECT_THAT(folder_.files(), ElementsAre("example.t.robdef", "p"));
  }
  EXPECT_EQ(generate("./q").err,
            "robdef: the plug-in `./q` cannot be started: No such file or directory\n");
  EXPECT_EQ(generate("no-such-program-anywhere").status, 1);
  folder_.write("p", "no program");
  EXPECT_THAT(generate("./example.t.robdef").err,
              HasSubstr("cannot be started: Permission denied"));
}

TEST_F(PluginCommand, DefinitionsWithErrorsDoNotReachIt) {
  folder_.write("example.t.robdef",
                "service example.t\nstdver 0.10\nstruct S\n    field X y\nend\n");
  write_script("p", "touch ran");
  EXPECT_EQ(generate("./p").status, 1);
  EXPECT_FALSE(has("ran"));
}

TEST_F(PluginCommand, WhatItSaysIsShownAndItIsTold) {
  write_script("p", "cat >request; echo 'one' >&2; printf 'two\\033' >&2; echo '{\"files\":[]}'\n");
  const Ended ended =
      run({"generate", "--plugin", "./p", "--plugin-option", "b=2", "--plugin-option", "a=x=y",
           "--rename", "example.t.O.x=z", "example.t.robdef"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.err, "one\ntwo \n");
  EXPECT_THAT(read_text(folder_ / "request"),
              AllOf(StartsWith(R"({"robdef_plugin":1,"options":{"a":"x=y","b":"2"},)"),
                    HasSubstr(R"("name":"x","code_name":"z")")));
}

TEST_F(PluginCommand, OptionsThatDoNotFitAreRefused) {
  const auto complaint = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "generate");
    arguments.emplace_back("example.t.robdef");
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 2);
    return ended.err.substr(0, ended.err.find('\n'));
  };
  EXPECT_EQ(complaint({"--plugin", "p", "--lang", "cpp"}),
            "robdef: give either `--lang` or `--plugin`");
  EXPECT_EQ(complaint({"--plugin-option", "a=b", "--lang", "cpp"}),
            "robdef: `--plugin-option` needs `--plugin`");
  EXPECT_EQ(complaint({"--plugin", "p", "--templates", "t"}),
            "robdef: `--templates` is for languages, not for plug-ins");
  EXPECT_EQ(complaint({"--plugin", "p", "--plugin-option", "a"}),
            "robdef: `--plugin-option`: `a` is not KEY=VALUE");
}

TEST_F(PluginCommand, AProjectFileHasPlugins) {
  write_plugin("tools/p", R"({"files":[{"path":"a","content":"1"},{"path":"b","content":""}]})");
  folder_.write("robdef.toml",
                "inputs = [\"*.robdef\"]\n[cpp]\noutput = \"cpp\"\n[plugin.pages]\n"
                "program = \"tools/p\"\noutput = \"pages\"\noptions = { a = \"1\", b = \"2\" }\n");
  folder_.write("deep/x", "");
  EXPECT_EQ(run({"generate"}).status, 0);
  EXPECT_TRUE(has("pages/a"));
  EXPECT_TRUE(has("cpp/example/t.hpp"));
  EXPECT_THAT(read_text(folder_ / "pages/.robdef-plugin-pages.manifest"), HasSubstr(" b\n"));

  write_script("tools/p", "cat >request; echo '{\"files\":[{\"path\":\"a\",\"content\":\"2\"}]}'");
  EXPECT_EQ(run({"generate"}).status, 0);
  EXPECT_EQ(read_text(folder_ / "pages/a"), "2");
  EXPECT_FALSE(has("pages/b")) << "it is no longer made";
  EXPECT_THAT(read_text(folder_ / "request"), HasSubstr(R"("options":{"a":"1","b":"2"})"));

  EXPECT_EQ(run({"generate", "--plugin", "pages", "--plugin-option", "b=3", "-o", "mine"}).status,
            0);
  EXPECT_TRUE(has("mine/a"));
  EXPECT_THAT(read_text(folder_ / "request"), HasSubstr(R"("options":{"a":"1","b":"3"})"));
  const std::string command = "cd '" + (folder_ / "deep") + "' && '" ROBDEF_PROGRAM "' generate";
  EXPECT_EQ(std::system(command.c_str()), 0) << "programs begin at the folder of the file";
}

TEST_F(PluginCommand, MistakesInTheProjectFileAreFindings) {
  folder_.write("robdef.toml",
                "inputs = [\"*.robdef\"]\n[plugin.pages]\noutput = \"pages\"\n[plugin.\"../x\"]\n"
                "program = \"p\"\n[plugin.more]\nprogram = \"p\"\ntemplates = \"t\"\n"
                "options = { a = 1 }\n");
  const Ended ended = run({"generate", "--format=line"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.err, AllOf(HasSubstr("(2,9): error: R0803 `[plugin.pages]` has no `program`"),
                               HasSubstr("(4,9): error: R0803 `../x` is no name of a plug-in"),
                               HasSubstr("(8,1): error: R0802 unknown key `templates`"),
                               HasSubstr("(9,17): error: R0803 `a` has a value of another type")));
}

// examples/plugin/reference.py, and what it makes of definitions.
class ReferencePlugin : public testing::Test {
 protected:
  Ended run(std::vector<std::string> arguments) {
    const std::string plugin = ROBDEF_EXAMPLE "/reference.py";
    arguments.insert(arguments.begin(),
                     {"generate", "--no-config", "--plugin", plugin, "-o", "out"});
    return run_robdef(folder_, arguments);
  }

  TemporaryFolder folder_;
};

TEST_F(ReferencePlugin, PagesAreThoseOfTheTree) {
  const Ended ended =
      run({"--plugin-option", "title=All", ROBDEF_EXAMPLE "/experimental.kinds.robdef",
           ROBDEF_EXAMPLE "/../smart_room/RobotCameraHost_interface.robdef"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  const fs::path golden = ROBDEF_EXAMPLE "/golden";
  std::vector<std::string> names = folder_.files();
  ASSERT_EQ(names.size(), 3U);
  for (const std::string& name : names) {
    const std::string made = read_text(folder_ / name);
    const fs::path file = golden / fs::path(name).filename();
    if (std::getenv("ROBDEF_UPDATE") != nullptr) std::ofstream(file) << made;
    EXPECT_EQ(made, read_text(file)) << file;
  }
}

TEST_F(ReferencePlugin, WarnsOfMembersWithoutDocumentation) {
  const Ended ended = run({"--plugin-option", "require_docs=yes", "--format=line",
                           ROBDEF_EXAMPLE "/experimental.kinds.robdef"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.err, HasSubstr("warning: R1002 `Base.name` has no documentation"));
  EXPECT_THAT(ended.err, Not(HasSubstr("`Kinds.name`"))) << "it has that from Base";
}

// One imports a service by the name of its file, which has another service line.
std::string corrected(const std::string& name, std::string text) {
  const std::string wrong = "com.robotraconteur.a1.robotics.scene";
  if (name != "com.robotraconteur.a1.robotics.planning.robdef") return text;
  for (std::size_t at = 0; (at = text.find(wrong, at)) != std::string::npos;) {
    text.replace(at, wrong.size(), "com.robotraconteur.robotics.scene");
  }
  return text;
}

TEST_F(ReferencePlugin, TakesTheStandardDefinitions) {
  const char* const standard = std::getenv("ROBDEF_STANDARD_DIR");
  if (standard == nullptr) GTEST_SKIP() << "ROBDEF_STANDARD_DIR is not set";
  const TemporaryFolder definitions;
  std::vector<std::string> arguments;
  for (const auto& entry : fs::directory_iterator(standard)) {
    if (entry.path().extension() != ".robdef") continue;
    const std::string name = entry.path().filename().string();
    arguments.push_back(definitions.write(name, corrected(name, read_text(entry.path()))));
  }
  const Ended ended = run(arguments);
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_EQ(arguments.size(), 47U);
  EXPECT_EQ(folder_.files().size(), 47U);
}

}  // namespace
}  // namespace robdef
