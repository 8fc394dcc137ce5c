// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/command_table.hpp"

#include <array>
#include <vector>

#include "compiler/driver/option_values.hpp"

namespace robdef {

namespace {

constexpr std::array commands = {
    CommandRow{Command::generate, "generate",
               "[--lang LANG | --plugin PROGRAM] [OPTION...] [FILE...]",
               "make the source files of a language",
               "Checks the definitions, and everything they import, and writes the code for the\n"
               "given files below the output folder. Nothing is generated for imports. Without\n"
               "--lang all outputs of robdef.toml are written, without FILE for its inputs.\n"
               "Nothing is written unless everything can be, and a file whose text stays the\n"
               "same is not touched.\n"},
    CommandRow{Command::check, "check", "[OPTION...] [FILE...]",
               "report errors and warnings, write nothing",
               "Checks the definitions and everything they import. All errors of all files are\n"
               "reported in one run. The file - is standard input. Without FILE the inputs of\n"
               "robdef.toml are checked.\n"},
    CommandRow{Command::format, "format", "[--check] FILE...",
               "lay out definitions: blanks, indentation, blank lines",
               "Lays out the given files in their places, all of them or none. Only blanks and\n"
               "blank lines change. A line that cannot be read stays as it is, and is named.\n"
               "The file - is standard input, whose layout goes to standard output.\n"},
    CommandRow{Command::breaking, "breaking", "[OPTION...] OLD NEW",
               "tell what in a new version breaks users of the old one",
               "Compares two versions of definitions: what between old programs and new ones is\n"
               "refused or misread (wire), what no longer compiles with code that is generated\n"
               "anew (source), and what works but means something else (behaviour). Each of OLD\n"
               "and NEW is a file, - for standard input, or a folder of definitions; or a\n"
               "revision of git and a path in it, such as HEAD~1:definitions.\n"
               "docs/reference/breaking.md has all rules.\n"},
    CommandRow{Command::docs, "docs", "[--format html|markdown] -o DIR [OPTION...] [FILE...]",
               "write reference pages of definitions, for browsers or as Markdown",
               "Writes a page for each definition and everything it imports, and an index, below\n"
               "the output folder. Each page can be read without network and without the others;\n"
               "types are links, and the search box finds names and words of all pages. Without\n"
               "FILE the inputs of robdef.toml are taken. Nothing is written unless everything\n"
               "can be, and a file whose text stays the same is not touched.\n"},
    CommandRow{Command::describe, "describe", "[OPTION...] FILE...",
               "print a readable outline of definitions",
               "Prints what the definitions offer: types with their sizes, objects with their\n"
               "members, each with its documentation.\n"},
    CommandRow{Command::model, "model", "[OPTION...] FILE...", "print the resolved model as JSON",
               "Prints the given definitions and their imports as JSON: names resolved,\n"
               "constants evaluated, sizes computed. The same input gives the same bytes.\n"},
    CommandRow{Command::view, "view", "--lang LANG [OPTION...] FILE...",
               "print what the templates of a language are given, as JSON",
               "Prints the view of the given definitions as JSON: every value that a template\n"
               "of the language can print. Read it when writing a template folder.\n"},
    CommandRow{Command::explain, "explain", "CODE... | --list",
               "explain a code such as R0203, or list them all",
               "Explains codes (R0203), or all codes of a rule (V12) of the language\n"
               "description.\n"},
    CommandRow{Command::lsp, "lsp", "[--stdio] [-I DIR...]",
               "serve an editor: the language server protocol",
               "Speaks the language server protocol over standard input and output, for an\n"
               "editor that starts it: diagnostics while typing, completion, hover,\n"
               "definitions, references, rename, layout, quick fixes, colours. Imports are\n"
               "found as robdef check finds them. docs/howto/editors.md shows how to set up\n"
               "editors.\n"},
};

constexpr std::array options = {
    OptionRow{"--lang",
              "",
              "LANG",
              {Command::generate, Command::view},
              "target language; see the list below",
              take_language},
    OptionRow{"--lang",
              "",
              "LANGS",
              {Command::check},
              "report what these languages cannot have, too:\nnames that collide in them, for"
              " instance;\nseparated by commas",
              take_languages},
    OptionRow{"--output",
              "-o",
              "DIR",
              {Command::generate},
              "folder to write below, made when missing;\ndefault: the current folder",
              take_text<&Options::output_folder>},
    OptionRow{"--output",
              "-o",
              "DIR",
              {Command::docs},
              "folder to write below, made when missing",
              take_text<&Options::output_folder>},
    OptionRow{"--import-path",
              "-I",
              "DIR",
              {Command::generate, Command::check, Command::docs, Command::describe, Command::model,
               Command::view, Command::breaking, Command::lsp},
              "look here for imported definitions; may be\nrepeated. An import a.b is the file\n"
              "a.b.robdef: beside the importing file, in\nthese folders, then in those of the\n"
              "environment",
              take_import_folder},
    OptionRow{"--strict",
              "",
              "",
              {Command::check},
              "every file must declare version 0.9.2 or\nlater, as published ones do",
              take_switch<&Options::is_strict>},
    OptionRow{"--check",
              "",
              "",
              {Command::format},
              "write nothing; print what would change, one\nplace a line; exit status 1 if "
              "anything would",
              take_switch<&Options::checks_only>},
    OptionRow{"--templates",
              "",
              "DIR",
              {Command::generate},
              "take templates from here: those of the same\nname replace the language's own; with"
              " a file\noutputs.txt they are all that is generated",
              take_text<&Options::template_folder>},
    OptionRow{"--plugin",
              "",
              "PROGRAM",
              {Command::generate},
              "let this program make the files, instead of a\nlanguage; or the plug-in of this name"
              " in\nrobdef.toml; docs/howto/plugins.md describes them",
              take_text<&Options::plugin>},
    OptionRow{"--plugin-option",
              "",
              "KEY=VALUE",
              {Command::generate},
              "tell the plug-in this; may be repeated",
              take_plugin_option},
    OptionRow{"--rename",
              "",
              "PATH=NAME",
              {Command::generate, Command::view},
              "call a type, member, parameter, field, value or\nconstant another name in the code, "
              "as example.\n"
              "arm.Arm.move=go_to; its name on the wire stays;\nmay be repeated",
              take_rename},
    OptionRow{"--list-outputs",
              "",
              "",
              {Command::generate, Command::docs},
              "print the paths that would be written, one\na line, and write nothing",
              take_switch<&Options::lists_outputs>},
    OptionRow{"--depfile",
              "",
              "FILE",
              {Command::generate, Command::docs},
              "write a make rule there that names every file\nthat was read",
              take_text<&Options::depfile>},
    OptionRow{"--depfile-target",
              "",
              "NAME",
              {Command::generate, Command::docs},
              "target of that rule; default: the outputs",
              take_text<&Options::depfile_target>},
    OptionRow{
        "--format", "", "FORM", {Command::docs}, "html (default) or markdown", take_docs_form},
    OptionRow{"--format",
              "",
              "FORM",
              {Command::generate, Command::check, Command::describe, Command::model, Command::view},
              "form of the findings: text (default), line\n(one line each) or json; json goes to"
              " standard\noutput unless the command prints there itself",
              take_format},
    OptionRow{"--format",
              "",
              "FORM",
              {Command::breaking},
              "text (default), json, or github: annotations for\na workflow",
              take_breaking_form},
    OptionRow{
        "--category",
        "",
        "NAMES",
        {Command::breaking},
        "only what breaks in these ways: wire, source,\nbehaviour, separated by commas; may be"
        " repeated",
        take_categories},
    OptionRow{"--allow",
              "",
              "CODE",
              {Command::breaking},
              "do not report changes of this code; may be\nrepeated",
              take_allowed},
    OptionRow{"--deny", "", "NAME", reading_definitions,
              "make a warning an error: a code, or a group that\nrobdef explain --list shows; may"
              " be repeated",
              take_level<Level::deny>},
    OptionRow{"--warn", "", "NAME", reading_definitions,
              "report a warning that robdef.toml turns off, or\nmakes an error",
              take_level<Level::warn>},
    OptionRow{"--allow", "", "NAME", reading_definitions,
              "do not report a warning; may be repeated", take_level<Level::allow>},
    OptionRow{"--no-warning", "", "CODE", reading_definitions, "the same as --allow",
              take_level<Level::allow>},
    OptionRow{"--config", "", "FILE", reading_definitions,
              "the project file; default: robdef.toml in the\ncurrent folder or the nearest one"
              " above it",
              take_text<&Options::config_file>},
    OptionRow{"--no-config", "", "", reading_definitions, "read no project file",
              take_switch<&Options::ignores_config>},
    OptionRow{"--list",
              "",
              "",
              {Command::explain},
              "print all codes with their rules",
              take_switch<&Options::lists_codes>},
    OptionRow{"--json", "", "", {Command::explain}, "print JSON", take_switch<&Options::is_json>},
    OptionRow{"--stdio",
              "",
              "",
              {Command::lsp},
              "standard input and output, as without it: some\neditors add it",
              [](Options&, const std::string&) { return std::string(); }},
};

}  // namespace

CommandTable compiler_commands() {
  return {.commands = {commands.begin(), commands.end()},
          .options = {options.begin(), options.end()}};
}

}  // namespace robdef
