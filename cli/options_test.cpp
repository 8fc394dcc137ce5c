// SPDX-License-Identifier: Apache-2.0
#include "cli/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/commands.hpp"
#include "compiler/driver/command_table.hpp"
#include "compiler/driver/program.hpp"

namespace robdef {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Options understood(const std::vector<std::string>& arguments, std::string_view variable = "") {
  const auto parsed = parse_options(arguments, variable, all_commands());
  if (const auto* error = std::get_if<UsageError>(&parsed)) ADD_FAILURE() << error->text;
  return std::holds_alternative<Options>(parsed) ? std::get<Options>(parsed) : Options{};
}

std::string complaint(const std::vector<std::string>& arguments) {
  const auto parsed = parse_options(arguments, "", all_commands());
  return std::holds_alternative<UsageError>(parsed) ? std::get<UsageError>(parsed).text : "";
}

std::string answer(const std::vector<std::string>& arguments) {
  const auto parsed = parse_options(arguments, "", all_commands());
  return std::holds_alternative<Answer>(parsed) ? std::get<Answer>(parsed).text : "";
}

TEST(Options, ValuesMayStandBehindABlankAnEqualsSignOrTheLetter) {
  const Options options = understood({"generate", "--lang=cpp", "-Ifirst", "-I", "second", "-o",
                                      "out", "a.robdef", "--import-path", "third", "b.robdef"});
  EXPECT_EQ(options.command, Command::generate);
  EXPECT_THAT(options.languages, ElementsAre("cpp"));
  EXPECT_EQ(options.output_folder, "out");
  EXPECT_THAT(options.search_path.folders, ElementsAre("first", "second", "third"));
  EXPECT_THAT(options.inputs, ElementsAre("a.robdef", "b.robdef"));
}

TEST(Options, FoldersOfTheEnvironmentComeAfterThoseOfTheCommandLine) {
  const Options options = understood({"check", "-I", "own", "a.robdef"}, "x:y;;z");
  EXPECT_THAT(options.search_path.folders, ElementsAre("own", "x", "y", "z"));
}

TEST(Options, BehindTwoDashesEverythingIsAFile) {
  EXPECT_THAT(understood({"check", "--", "--strict"}).inputs, ElementsAre("--strict"));
}

TEST(Options, AWarningIsTurnedOffByItsCodeInEitherCase) {
  const Levels levels = understood({"check", "--no-warning=r0610", "--allow", "R0611", "a"}).levels;
  EXPECT_EQ(levels.find(Code::R0610), Level::allow);
  EXPECT_EQ(levels.find(Code::R0611), Level::allow);
  EXPECT_EQ(levels.find(Code::R0612), std::nullopt);
}

TEST(Options, AnErrorCannotBeTurnedOff) {
  EXPECT_THAT(complaint({"check", "--no-warning=R0203", "a"}),
              HasSubstr("`R0203` is an error; only warnings can be turned off"));
}

TEST(Options, WhatIsMisspelledIsGuessed) {
  EXPECT_THAT(complaint({"genrate", "a"}), HasSubstr("did you mean `generate`?"));
  EXPECT_THAT(complaint({"check", "--stric", "a"}), HasSubstr("did you mean `--strict`?"));
  EXPECT_THAT(complaint({"generate", "--lang", "cp", "a"}), HasSubstr("did you mean `cpp`?"));
}

TEST(Options, AnOptionOfAnotherCommandIsNamedAsSuch) {
  EXPECT_THAT(complaint({"model", "--lang", "cpp", "a"}),
              HasSubstr("`robdef model` has no option `--lang`"));
}

TEST(Options, WhatIsMissingIsNamed) {
  EXPECT_THAT(complaint({}), HasSubstr("no command given"));
  EXPECT_THAT(complaint({"format"}), HasSubstr("no file given"));
  EXPECT_THAT(complaint({"explain"}), HasSubstr("no code given"));
  EXPECT_THAT(complaint({"generate", "a", "--lang"}), HasSubstr("`--lang` needs a value: LANG"));
  EXPECT_THAT(complaint({"generate", "--lang", "cpp", "--depfile-target", "x", "a"}),
              HasSubstr("`--depfile-target` needs `--depfile`"));
  EXPECT_THAT(complaint({"generate", "--lang", "csharp", "--rename", "a.B", "a"}),
              HasSubstr("`a.B` is not PATH=NAME"));
  EXPECT_THAT(complaint({"check", "--config", "x.toml", "--no-config", "a"}),
              HasSubstr("give either `--config` or `--no-config`"));
}

TEST(Options, ASwitchTakesNoValueAndAFormatOnlyKnownOnes) {
  EXPECT_THAT(complaint({"check", "--strict=yes", "a"}), HasSubstr("`--strict` takes no value"));
  EXPECT_THAT(complaint({"check", "--format=xml", "a"}),
              HasSubstr("known: `text`, `line`, `json`"));
  EXPECT_THAT(complaint({"explain", "--list", "R0203"}), HasSubstr("`--list` takes no codes"));
}

TEST(Options, HelpOfACommandShowsEachOfItsOptions) {
  for (const CommandRow& command : all_commands().commands) {
    const std::string text = answer({std::string(command.name), "--help"});
    EXPECT_EQ(text, answer({"help", std::string(command.name)}));
    for (const OptionRow& option : all_commands().options) {
      const bool is_shown =
          text.find("  " + std::string(option.title()) + " ") != std::string::npos ||
          text.find(", " + std::string(option.title()) + " ") != std::string::npos;
      // Two commands may have options of one name, each in a row of its own.
      const bool is_expected = std::any_of(
          all_commands().options.begin(), all_commands().options.end(),
          [&](const OptionRow& other) {
            return other.title() == option.title() && other.commands.contains(command.command);
          });
      EXPECT_EQ(is_shown, is_expected) << command.name << " " << option.title();
    }
  }
}

TEST(Options, HelpFitsAnEightyColumnTerminal) {
  std::string text = answer({"--help"});
  for (const CommandRow& command : all_commands().commands)
    text += help_of(command, all_commands());
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = text.find('\n', begin);
    EXPECT_LE(end - begin, 80U) << text.substr(begin, end - begin);
    begin = end + 1;
  }
}

TEST(Options, GeneralHelpNamesCommandsLanguagesAndExitStatus) {
  const std::string text = answer({"--help"});
  for (const CommandRow& command : all_commands().commands) {
    EXPECT_THAT(text, HasSubstr("\n  " + std::string(command.name) + " "));
  }
  EXPECT_THAT(text, HasSubstr("\n  cpp "));
  EXPECT_THAT(text, HasSubstr("Exit status: 0 fine, 1 errors found, 2 used wrongly"));
  EXPECT_EQ(text, answer({"-h"}));
}

TEST(Options, ManualAndCompletionKnowEachCommandAndOption) {
  std::string manual;
  for (const char letter : read_text(ROBDEF_MANUAL)) {
    if (letter != '\\') manual += letter;
  }
  const std::string completion = read_text(ROBDEF_COMPLETION);
  for (const CommandRow& command : all_commands().commands) {
    EXPECT_THAT(manual, HasSubstr(".B " + std::string(command.name) + "\n"));
    EXPECT_THAT(completion, HasSubstr(std::string(command.name)));
  }
  for (const OptionRow& option : all_commands().options) {
    EXPECT_THAT(manual, HasSubstr(std::string(option.name)));
    EXPECT_THAT(completion, HasSubstr(std::string(option.name)));
  }
}

}  // namespace
}  // namespace robdef
