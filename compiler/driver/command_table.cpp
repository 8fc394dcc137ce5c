// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/command_table.hpp"

#include <array>
#include <vector>

#include "cli/live/table.hpp"
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
               "and NEW is a file, - for standard input, or a folder of definitions; a revision\n"
               "of git and a path in it, such as HEAD~1:definitions; a recording; or the URL of\n"
               "a running service. docs/breaking.md has all rules.\n"},
    CommandRow{Command::docs, "docs", "[--format html|markdown] -o DIR [OPTION...] [FILE...]",
               "write reference pages of definitions, for browsers or as Markdown",
               "Writes a page for each definition and everything it imports, and an index, below\n"
               "the output folder. Each page can be read without network and without the others;\n"
               "types are links, and the search box finds names and words of all pages. Without\n"
               "FILE the inputs of robdef.toml are taken. Nothing is written unless everything\n"
               "can be, and a file whose text stays the same is not touched.\n"},
    CommandRow{Command::describe, "describe", "[OPTION...] FILE... | URL [PATH]",
               "print a readable outline of definitions",
               "Prints what the definitions offer: types with their sizes, objects with their\n"
               "members, each with its documentation. With the URL of a service: what that\n"
               "offers, or one of its objects or members; --format=json prints JSON then.\n"},
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
    CommandRow{Command::inspect, "inspect", "[OPTION...] FILE...",
               "print what a recording of messages holds",
               "Prints a line for each message of a recording: the time since its beginning,\n"
               "the connection, > to the service or < to the client, the entries with their\n"
               "service path, member, request id and error, and the elements with the types\n"
               "that they have on the wire. A file that is cut off is read up to there. The\n"
               "file - is standard input.\n"},
    CommandRow{Command::record, "record", "--connect HOST:PORT --listen PORT -o FILE [OPTION...]",
               "record the messages between clients and a service",
               "Listens at a port, connects each client that comes there to a service, passes\n"
               "on every byte as it is, and records the messages until it is interrupted.\n"
               "Clients and services of any implementation will do. The recording has\n"
               "everything that was sent but for the credentials of logins, which are masked.\n"},
    CommandRow{Command::replay, "replay", "FILE --connect HOST:PORT | --listen PORT [OPTION...]",
               "play one side of a recording to a live other side",
               "With --connect the recorded clients are played to a service, with --listen the\n"
               "recorded service to the clients that come there. Prints what the other side\n"
               "does otherwise than in the recording. Endpoints, node ids, message, request and\n"
               "generator numbers, and the times of wire values may differ; values of wires may\n"
               "be missing.\n"},
    CommandRow{Command::discover, "discover", "[OPTION...]",
               "show the nodes and services that can be found",
               "Listens to the announcements of nodes and asks them for their services. Prints\n"
               "nodes and services with + when they come, * when they change and - when they\n"
               "are lost, until it is interrupted.\n"},
    CommandRow{Command::ca, "ca", "init DIR | VERB [NODE | FILE | SERIAL] [OPTION...]",
               "make and use a certificate authority for nodes",
               "  init DIR      make an authority in a folder\n"
               "  issue NODE    make the certificate and key of a node there, below nodes\n"
               "  request NODE  on the node's machine: make its key, and a request\n"
               "  sign FILE     issue a certificate for a request; the key stays where it is\n"
               "  revoke NODE | SERIAL | FILE   revoke all certificates of a node, or one\n"
               "  refresh       sign the list of revoked certificates anew, before it runs out\n"
               "  list [NODE]   print what was issued, a line each\n"
               "  passphrase    give the authority's key another passphrase\n"
               "A node is its id, or a file that has it. Nodes trust the authority that are\n"
               "given its ca.pem. Keep ca.key to yourself. Its passphrase is asked for at the\n"
               "terminal, unless --passphrase-file or ROBDEF_CA_PASSPHRASE has it.\n"},
    CommandRow{Command::lsp, "lsp", "[--stdio] [-I DIR...]",
               "serve an editor: the language server protocol",
               "Speaks the language server protocol over standard input and output, for an\n"
               "editor that starts it: diagnostics while typing, completion, hover,\n"
               "definitions, references, rename, layout, quick fixes, colours. Imports are\n"
               "found as robdef check finds them. docs/editors.md shows how to set up editors.\n"},
    CommandRow{Command::bridge, "bridge", "BOARD... --listen PORT [--everywhere]",
               "offer boards, at serial ports or over TCP, as services",
               "A BOARD is the path of a port, as /dev/ttyACM0, perhaps with the rate and the\n"
               "name of its service: /dev/ttyUSB0?baud=9600&name=lamp. The rate is 115200 if\n"
               "nothing is said, the name that of the object which the sketch serves. A board\n"
               "with a network is tcp://192.168.1.20:4000, perhaps with ?name=lamp. Goes on\n"
               "when boards are reset, or unplugged and plugged in again, until it is\n"
               "interrupted.\n"},
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
              " in\nrobdef.toml; docs/plugins.md describes them",
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
    OptionRow{"--json",
              "",
              "",
              {Command::explain, Command::inspect, Command::ca},
              "print JSON; inspect: an object a line; ca: of\nwhat list prints",
              take_switch<&Options::is_json>},
    OptionRow{"--entries",
              "",
              "TYPES",
              {Command::inspect},
              "only messages with entries of these types:\nnames such as PropertyGetReq, or"
              " numbers,\nseparated by commas; may be repeated",
              take_entry_types},
    OptionRow{"--path",
              "",
              "PATH",
              {Command::inspect},
              "only messages to and from the object at this\nservice path, and those below it",
              take_recording_text<&RecordingOptions::path>},
    OptionRow{"--connection",
              "",
              "NUMBER",
              {Command::inspect, Command::replay},
              "only this connection",
              take_connection},
    OptionRow{"--summary",
              "",
              "",
              {Command::inspect},
              "print counts, bytes and rates of entries and\nthe times of requests instead",
              take_recording_switch<&RecordingOptions::is_summary>},
    OptionRow{"--connect",
              "",
              "HOST:PORT",
              {Command::record, Command::replay},
              "where the service is; a URL will do, too",
              take_recording_text<&RecordingOptions::connect>},
    OptionRow{"--listen",
              "",
              "PORT",
              {Command::record, Command::replay, Command::bridge},
              "port to listen at; 0: any, which is printed",
              take_port},
    OptionRow{"--everywhere",
              "",
              "",
              {Command::record, Command::replay, Command::bridge},
              "accept connections of other machines, too",
              take_recording_switch<&RecordingOptions::listens_everywhere>},
    OptionRow{"--output",
              "-o",
              "FILE",
              {Command::record},
              "file to write; one that is there is replaced",
              take_recording_text<&RecordingOptions::output>},
    OptionRow{"--drop",
              "",
              "",
              {Command::record},
              "leave messages out, and count them, when the\ndisk is too slow, instead of waiting"
              " for it",
              take_recording_switch<&RecordingOptions::drops>},
    OptionRow{"--keep-credentials",
              "",
              "",
              {Command::record},
              "write passwords of logins into the file, too;\notherwise they are masked",
              take_recording_switch<&RecordingOptions::keeps_credentials>},
    OptionRow{"--fast",
              "",
              "",
              {Command::replay},
              "send as soon as the answers before have come,\nnot at the recorded times",
              take_recording_switch<&RecordingOptions::is_fast>},
    OptionRow{"--stdio",
              "",
              "",
              {Command::lsp},
              "standard input and output, as without it: some\neditors add it",
              [](Options&, const std::string&) { return std::string(); }},
    OptionRow{"--once",
              "",
              "",
              {Command::discover},
              "wait a while, print what there is, and end",
              [](Options& taken, const std::string&) {
                taken.discover.is_once = true;
                return std::string();
              }},
    OptionRow{"--type",
              "",
              "TYPE",
              {Command::discover},
              "only services whose root object has this\nqualified type, or implements it",
              [](Options& taken, const std::string& value) {
                taken.discover.type = value;
                return std::string(value.empty() ? "the value is empty" : "");
              }},
    OptionRow{"--format",
              "",
              "FORM",
              {Command::discover},
              "text (default) or json: one document with\n--once, otherwise an object a line",
              take_discover_format},
    OptionRow{"--wait",
              "",
              "SECONDS",
              {Command::discover},
              "how long --once waits; default: 3",
              take_wait},
    OptionRow{"--ipv4",
              "",
              "",
              {Command::discover},
              "ask by broadcasts of IPv4, too",
              [](Options& taken, const std::string&) {
                taken.discover.uses_ipv4 = true;
                return std::string();
              }},
    OptionRow{"--interface",
              "",
              "NAME",
              {Command::discover},
              "ask on this interface only; may be repeated",
              take_interface},
    OptionRow{"--port",
              "",
              "PORT",
              {Command::discover},
              "port of discovery; default: 48653",
              take_discovery_port},
    OptionRow{"--ca",
              "",
              "DIR",
              {Command::ca},
              "folder of the authority; default: the current\nfolder",
              take_authority_text<&AuthorityOptions::folder>},
    OptionRow{"--days",
              "",
              "NUMBER",
              {Command::ca},
              "how long it is valid; default: 825, of an\nauthority 3650",
              take_days<&AuthorityOptions::days>},
    OptionRow{
        "--list-days",
        "",
        "NUMBER",
        {Command::ca},
        "init, refresh: how long lists of revoked\ncertificates are valid; default: 7, then as\n"
        "before",
        take_days<&AuthorityOptions::list_days>},
    OptionRow{"--name",
              "",
              "TEXT",
              {Command::ca},
              "issue, sign: what list shows beside the node;\ninit: of the authority",
              take_authority_text<&AuthorityOptions::name>},
    OptionRow{"--renew",
              "",
              "",
              {Command::ca},
              "issue, request: for a node that has a\ncertificate, with its key",
              take_authority_switch<&AuthorityOptions::is_renewal>},
    OptionRow{"--new-key",
              "",
              "",
              {Command::ca},
              "issue --renew: with another key",
              take_authority_switch<&AuthorityOptions::takes_new_key>},
    OptionRow{"--revoke-old",
              "",
              "",
              {Command::ca},
              "issue, sign: revoke the node's earlier\ncertificates",
              take_authority_switch<&AuthorityOptions::revokes_earlier>},
    OptionRow{"--passphrase",
              "",
              "",
              {Command::ca},
              "init: ask for a passphrase for the key",
              take_authority_switch<&AuthorityOptions::has_passphrase>},
    OptionRow{
        "--passphrase-file",
        "",
        "FILE",
        {Command::ca},
        "the first line of this file is the passphrase\nof the key; /dev/fd/N for a descriptor",
        take_authority_text<&AuthorityOptions::passphrase_file>},
    OptionRow{"--output",
              "-o",
              "DIR",
              {Command::ca},
              "request: folder of the key and the request;\ndefault: the current folder",
              take_authority_text<&AuthorityOptions::output>},
};

template <class Row, std::size_t size>
std::vector<Row> with(const std::array<Row, size>& rows, std::span<const Row> others) {
  std::vector<Row> all(rows.begin(), rows.end());
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace

std::span<const CommandRow> command_rows() {
  static const std::vector<CommandRow> all = with(commands, live::commands());
  return all;
}
std::span<const OptionRow> option_rows() {
  static const std::vector<OptionRow> all = with(options, live::options());
  return all;
}

}  // namespace robdef
