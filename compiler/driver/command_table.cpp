// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/command_table.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <optional>
#include <vector>

#include "compiler/backends/backend.hpp"
#include "compiler/diagnostics/spelling.hpp"
#include "compiler/driver/live/table.hpp"
#include "runtime/cpp/src/replay/words.hpp"

namespace robdef {

namespace {

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& letter : upper) {
    letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  }
  return upper;
}

std::string take_language(Options& options, const std::string& value) {
  if (find_backend(value) != nullptr) {
    options.language = value;
    return "";
  }
  std::string known;
  std::vector<std::string_view> names;
  for (const Backend* backend : backends()) {
    known += (known.empty() ? "`" : ", `") + std::string(backend->name()) + "`";
    names.push_back(backend->name());
  }
  const std::string_view near = nearest(value, names);
  return "unknown language `" + value + "`; " +
         (near.empty() ? "known: " + known : "did you mean `" + std::string(near) + "`?");
}

std::string take_format(Options& options, const std::string& value) {
  if (value == "text") {
    options.format = Format::text;
  } else if (value == "line") {
    options.format = Format::line;
  } else if (value == "json") {
    options.format = Format::json;
  } else {
    return "unknown format `" + value + "`; known: `text`, `line`, `json`";
  }
  return "";
}

std::string take_silenced(Options& options, const std::string& value) {
  const CodeEntry* entry = find_code(upper_case(value));
  if (entry == nullptr) return "there is no code `" + value + "`; see `robdef explain --list`";
  if (entry->severity == Severity::error) {
    return "`" + std::string(entry->name) + "` is an error; only warnings can be turned off";
  }
  options.silenced.push_back(entry->code);
  return "";
}

template <std::string Options::*member>
std::string take_text(Options& options, const std::string& value) {
  options.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <bool Options::*member>
std::string take_switch(Options& options, const std::string&) {
  options.*member = true;
  return "";
}

std::string take_import_folder(Options& options, const std::string& value) {
  options.search_path.folders.push_back(value);
  return value.empty() ? "the value is empty" : "";
}

template <bool RecordingOptions::*member>
std::string take_recording_switch(Options& options, const std::string&) {
  options.recording.*member = true;
  return "";
}

std::string take_entry_types(Options& options, const std::string& value) {
  std::size_t begin = 0;
  while (begin <= value.size()) {
    const std::size_t end = std::min(value.find(',', begin), value.size());
    const std::string name = value.substr(begin, end - begin);
    const auto type = rr::replay::entry_type_of(name);
    if (!type) return "`" + name + "` is no type of an entry";
    options.recording.entry_types.insert(static_cast<std::uint16_t>(*type));
    begin = end + 1;
  }
  return "";
}

template <std::string RecordingOptions::*member>
std::string take_recording_text(Options& options, const std::string& value) {
  options.recording.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, number);
  if (text.empty() || result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return number;
}

std::string take_connection(Options& options, const std::string& value) {
  options.recording.connection = number_in<std::uint32_t>(value);
  return options.recording.connection ? "" : "`" + value + "` is no number of a connection";
}

std::string take_port(Options& options, const std::string& value) {
  options.recording.port = number_in<std::uint16_t>(value);
  return options.recording.port ? "" : "`" + value + "` is no port";
}

std::string take_discover_format(Options& options, const std::string& value) {
  const std::string complaint = take_format(options, value);
  if (!complaint.empty() || options.format != Format::line) return complaint;
  return "known here: `text`, `json`";
}

std::string take_discovery_port(Options& options, const std::string& value) {
  const auto port = number_in<std::uint16_t>(value);
  options.discover.port = port.value_or(0);
  return options.discover.port != 0 ? "" : "`" + value + "` is no port";
}

std::string take_wait(Options& options, const std::string& value) {
  const auto seconds = number_in<std::uint16_t>(value);
  options.discover.wait = std::chrono::seconds(seconds.value_or(0));
  return seconds ? "" : "`" + value + "` is no number of seconds";
}

std::string take_interface(Options& options, const std::string& value) {
  options.discover.interfaces.push_back(value);
  return value.empty() ? "the value is empty" : "";
}

std::string take_days(Options& options, const std::string& value) {
  options.days = number_in<int>(value);
  const bool is_right = options.days && *options.days > 0 && *options.days <= 36500;
  return is_right ? "" : "`" + value + "` is no number of days from 1 to 36500";
}

constexpr CommandSet reading = {Command::generate, Command::check, Command::describe,
                                Command::model, Command::view};

constexpr std::array commands = {
    CommandRow{Command::generate, "generate", "--lang LANG [-o DIR] [OPTION...] FILE...",
               "make the source files of a language",
               "Checks the definitions, and everything they import, and writes the code for the\n"
               "given files below the output folder. Nothing is generated for imports.\n"
               "Nothing is written unless everything can be, and a file whose text stays the\n"
               "same is not touched.\n"},
    CommandRow{Command::check, "check", "[OPTION...] FILE...",
               "report errors and warnings, write nothing",
               "Checks the definitions and everything they import. All errors of all files are\n"
               "reported in one run.\n"},
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
               "that they have on the wire. A file that is cut off is read up to there.\n"},
    CommandRow{Command::record, "record", "--connect HOST:PORT --listen PORT -o FILE [OPTION...]",
               "record the messages between clients and a service",
               "Listens at a port, connects each client that comes there to a service, passes\n"
               "on every byte as it is, and records the messages until it is interrupted.\n"
               "Clients and services of any implementation will do. The recording has\n"
               "everything that was sent, credentials too.\n"},
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
    CommandRow{Command::ca, "ca", "init DIR | issue NODE | revoke NODE [OPTION...]",
               "make and use an authority for nodes' certificates",
               "init makes an authority in a folder; issue makes the certificate and key of a\n"
               "node there, below nodes, and revoke adds the certificate to the list of revoked\n"
               "ones. A node is its id, or a file that has it. Nodes trust the authority that\n"
               "are given its ca.pem. Keep ca.key to yourself.\n"},
    CommandRow{Command::bridge, "bridge", "BOARD... --listen PORT [--everywhere]",
               "offer boards behind serial ports as services",
               "A BOARD is the path of a port, as /dev/ttyACM0, perhaps with the rate and the\n"
               "name of its service: /dev/ttyUSB0?baud=9600&name=lamp. The rate is 115200 if\n"
               "nothing is said, the name that of the object which the sketch serves. Goes on\n"
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
    OptionRow{"--output",
              "-o",
              "DIR",
              {Command::generate},
              "folder to write below, made when missing;\ndefault: the current folder",
              take_text<&Options::output_folder>},
    OptionRow{"--import-path", "-I", "DIR", reading,
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
    OptionRow{"--templates",
              "",
              "DIR",
              {Command::generate},
              "take templates from here: those of the same\nname replace the language's own; with"
              " a file\noutputs.txt they are all that is generated",
              take_text<&Options::template_folder>},
    OptionRow{"--list-outputs",
              "",
              "",
              {Command::generate},
              "print the paths that would be written, one\na line, and write nothing",
              take_switch<&Options::lists_outputs>},
    OptionRow{"--depfile",
              "",
              "FILE",
              {Command::generate},
              "write a make rule there that names every file\nthat was read",
              take_text<&Options::depfile>},
    OptionRow{"--depfile-target",
              "",
              "NAME",
              {Command::generate},
              "target of that rule; default: the outputs",
              take_text<&Options::depfile_target>},
    OptionRow{"--format", "", "FORM", reading,
              "form of the findings: text (default), line\n(one line each) or json; json goes to"
              " standard\noutput unless the command prints there itself",
              take_format},
    OptionRow{"--no-warning", "", "CODE", reading, "do not report this warning; may be repeated",
              take_silenced},
    OptionRow{"--list",
              "",
              "",
              {Command::explain},
              "print all codes with their rules",
              take_switch<&Options::lists_codes>},
    OptionRow{"--json",
              "",
              "",
              {Command::explain, Command::inspect},
              "print JSON; inspect: an object a line",
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
    OptionRow{"--fast",
              "",
              "",
              {Command::replay},
              "send as soon as the answers before have come,\nnot at the recorded times",
              take_recording_switch<&RecordingOptions::is_fast>},
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
              take_text<&Options::authority_folder>},
    OptionRow{"--days",
              "",
              "NUMBER",
              {Command::ca},
              "how long it is valid; default: 825, of an\nauthority 3650",
              take_days},
};

/// `text` in a column that begins behind `indent` blanks; the first line stands there already.
std::string hanging(std::string_view text, std::size_t indent) {
  std::string lines;
  for (const char letter : text) {
    lines += letter;
    if (letter == '\n') lines.append(indent, ' ');
  }
  return lines + "\n";
}

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.resize(width, ' ');
  return text;
}

std::string option_line(std::string_view short_name, std::string_view name, std::string_view value,
                        std::string_view help) {
  constexpr std::size_t column = 28;
  std::string left = short_name.empty() ? "      " : "  " + std::string(short_name) + ", ";
  left += name;
  if (!value.empty()) left += " " + std::string(value);
  if (left.size() > column - 2) left += "\n" + std::string(column, ' ');
  return padded(std::move(left), column) + hanging(help, column);
}

std::string languages() {
  std::string text = "\nLanguages:\n";
  for (const Backend* backend : backends()) {
    text +=
        "  " + padded(std::string(backend->name()), 12) + std::string(backend->summary()) + "\n";
  }
  return text;
}

template <class Row, std::size_t size>
std::vector<Row> with(const std::array<Row, size>& rows, std::span<const Row> others) {
  std::vector<Row> all(rows.begin(), rows.end());
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

constexpr std::string_view environment_and_exit =
    "\nEnvironment:\n"
    "  ROBOTRACONTEUR_ROBDEF_PATH  folders searched for imports after those of -I,\n"
    "                              separated by : or ;\n"
    "\nExit status: 0 fine, 1 errors found, 2 used wrongly, 3 a fault of robdef itself.\n";

}  // namespace

std::span<const CommandRow> command_rows() {
  static const std::vector<CommandRow> all = with(commands, live::commands());
  return all;
}
std::span<const OptionRow> option_rows() {
  static const std::vector<OptionRow> all = with(options, live::options());
  return all;
}

std::string general_help() {
  std::string text =
      "usage: robdef COMMAND [OPTION...] FILE...\n"
      "\n"
      "Compiles service definitions (.robdef), the language of Robot Raconteur, into\n"
      "clients and services.\n"
      "\n"
      "Commands:\n";
  for (const CommandRow& row : command_rows()) {
    text += "  " + padded(std::string(row.name), 12) + std::string(row.summary) + "\n";
  }
  text +=
      "\n"
      "  robdef COMMAND --help       the options of a command\n"
      "  robdef --version            the version of this program\n"
      "\n"
      "Examples:\n"
      "  robdef check experimental.mount.robdef\n"
      "  robdef generate --lang cpp -o generated -I shared experimental.mount.robdef\n"
      "  robdef explain R0203\n";
  text += languages();
  text += environment_and_exit;
  return text;
}

std::string help_of(const CommandRow& command) {
  std::string text = "usage: robdef " + std::string(command.name) + " " +
                     std::string(command.arguments) + "\n\n" + std::string(command.description) +
                     "\nOptions:\n";
  bool has_language = false;
  for (const OptionRow& row : option_rows()) {
    if (!row.commands.contains(command.command)) continue;
    text += option_line(row.short_name, row.name, row.value, row.help);
    has_language = has_language || row.name == "--lang";
  }
  text += option_line("-h", "--help", "", "print this");
  if (has_language) text += languages();
  if (reading.contains(command.command)) {
    text += environment_and_exit;
  } else if (command.command == Command::explain) {
    text += "\nExit status: 0 fine, 2 no such code.\n";
  } else {
    if (command.command >= Command::get) text += live::environment_help;
    text += "\nExit status: 0 fine, 1 errors, 2 used wrongly, 3 a fault of robdef itself.\n";
  }
  return text;
}

}  // namespace robdef
