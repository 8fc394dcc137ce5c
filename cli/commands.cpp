// SPDX-License-Identifier: Apache-2.0
#include "cli/commands.hpp"

#include <algorithm>
#include <any>
#include <array>
#include <fstream>
#include <ostream>
#include <rr/error.hpp>
#include <rr/printable.hpp>
#include <utility>

#include "cli/authority.hpp"
#include "cli/authority_verbs.hpp"
#include "cli/discover.hpp"
#include "cli/inspect_page.hpp"
#include "cli/live/commands.hpp"
#include "cli/live/pulled_definitions.hpp"
#include "cli/live/table.hpp"
#include "cli/option_values.hpp"
#include "cli/recorded_definitions.hpp"
#include "cli/recordings.hpp"
#include "compiler/driver/version_error.hpp"

namespace robdef {
namespace {

constexpr std::array command_rows = {
    CommandRow{Command::inspect, "inspect", "[OPTION...] FILE... | --page [URL]",
               "print what a recording holds, or open a page that shows devices",
               "Prints a line for each message of a recording: the time since its beginning,\n"
               "the connection, > to the service or < to the client, the entries with their\n"
               "service path, member, request id and error, and the elements with the types\n"
               "that they have on the wire. A file that is cut off is read up to there. The\n"
               "file - is standard input.\n"
               "With --page, prints the address of the inspector for the service at a URL, and\n"
               "opens it in a browser when there is a display and standard output is a\n"
               "terminal: the page of its node, if that serves one, or the installed file.\n"},
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
    CommandRow{Command::bridge, "bridge", "BOARD... --listen PORT [--everywhere]",
               "offer boards, at serial ports or over TCP, as services",
               "A BOARD is the path of a port, as /dev/ttyACM0, perhaps with the rate and the\n"
               "name of its service: /dev/ttyUSB0?baud=9600&name=lamp. The rate is 115200 if\n"
               "nothing is said, the name that of the object which the sketch serves. A board\n"
               "with a network is tcp://192.168.1.20:4000, perhaps with ?name=lamp. Goes on\n"
               "when boards are reset, or unplugged and plugged in again, until it is\n"
               "interrupted.\n"},
};

constexpr std::array option_rows = {
    OptionRow{"--json",
              "",
              "",
              {Command::inspect, Command::ca},
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
    OptionRow{"--page",
              "",
              "",
              {Command::inspect},
              "print, and open, the address of a page that\nshows the service at a URL",
              take_recording_switch<&RecordingOptions::is_page>},
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
    OptionRow{
        "--tolerance",
        "",
        "NUMBER",
        {Command::replay},
        "floating-point numbers may differ by so much,\nand by so many parts of those above 1;"
        " default: 0",
        take_tolerance},
    OptionRow{
        "--ignore",
        "",
        "PATH",
        {Command::replay},
        "do not compare this member, or object with all\nbelow it, as arm.state; may be repeated",
        [](Options& taken, const std::string& value) {
          more(taken).recording.ignored.push_back(value);
          return std::string(value.empty() ? "the value is empty" : "");
        }},
    OptionRow{"--once",
              "",
              "",
              {Command::discover},
              "wait a while, print what there is, and end",
              [](Options& taken, const std::string&) {
                more(taken).discover.is_once = true;
                return std::string();
              }},
    OptionRow{"--type",
              "",
              "TYPE",
              {Command::discover},
              "only services whose root object has this\nqualified type, or implements it",
              [](Options& taken, const std::string& value) {
                more(taken).discover.type = value;
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
                more(taken).discover.uses_ipv4 = true;
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

bool has_url(const Options& options) {
  return std::any_of(options.inputs.begin(), options.inputs.end(), is_url);
}

bool describes_a_service(const Options& options) {
  return options.command == Command::describe && !options.inputs.empty() &&
         is_url(options.inputs.front());
}

std::string missing_to_record(const Options& options) {
  const RecordingOptions& wanted = more(options).recording;
  if (!options.inputs.empty()) return "`robdef record` takes no files; name one with `-o`";
  if (wanted.connect.empty()) return "`--connect` is missing";
  if (!wanted.port) return "`--listen` is missing";
  return wanted.output.empty() ? "`--output` is missing" : "";
}

std::string missing_to_replay(const Options& options) {
  const RecordingOptions& wanted = more(options).recording;
  if (options.inputs.empty()) return "no file given";
  if (options.inputs.size() != 1) return "one file at a time can be played";
  if (wanted.connect.empty() == !wanted.port) return "give either `--connect` or `--listen`";
  return "";
}

std::string missing_to_inspect(const Options& options) {
  if (more(options).recording.is_page) {
    return options.inputs.size() > 1 ? "one URL at a time can be shown" : "";
  }
  return options.inputs.empty() ? "no file given" : "";
}

std::string missing_to_bridge(const Options& options) {
  if (options.inputs.empty()) return "no board given";
  return more(options).recording.port ? "" : "`--listen` is missing";
}

// Of versions that are all in files the compiler knows what is missing.
std::optional<std::string> missing_to_compare(const Options& options) {
  if (options.inputs.size() != 2) return std::nullopt;
  if (has_url(options)) return live::missing_to_connect(options);
  if (more(options).live.user.empty()) return std::nullopt;
  return "`--user` is for the URL of a service";
}

std::optional<std::string> missing(const Options& options) {
  switch (options.command) {
    case Command::record:
      return missing_to_record(options);
    case Command::replay:
      return missing_to_replay(options);
    case Command::bridge:
      return missing_to_bridge(options);
    case Command::ca:
      return missing_for_authority(options);
    case Command::discover:
      return options.inputs.empty() ? "" : "`robdef discover` takes no files";
    case Command::inspect:
      return missing_to_inspect(options);
    case Command::breaking:
      return missing_to_compare(options);
    case Command::get:
    case Command::set:
    case Command::call:
    case Command::watch:
    case Command::top:
    case Command::connect:
    case Command::complete:
      return live::missing(options);
    default:
      if (describes_a_service(options)) return live::missing(options);
      return std::nullopt;
  }
}

std::optional<ExitStatus> run_command(const Options& options, std::ostream& out,
                                      std::ostream& err) {
  switch (options.command) {
    case Command::inspect:
      if (more(options).recording.is_page) return show_page(options, out, err);
      return inspect(options, out, err);
    case Command::record:
      return record(options, out, err);
    case Command::replay:
      return replay(options, out, err);
    case Command::bridge:
      return bridge(options, out, err);
    case Command::ca:
      return run_authority(options, out, err);
    case Command::discover:
      return discover(options, out, err);
    case Command::get:
    case Command::set:
    case Command::call:
    case Command::watch:
    case Command::top:
    case Command::connect:
    case Command::complete:
      return run_live(options, out, err);
    default:
      if (describes_a_service(options)) return run_live(options, out, err);
      return std::nullopt;
  }
}

constexpr std::string_view breaking_notes =
    "\nEnvironment:\n"
    "  ROBOTRACONTEUR_ROBDEF_PATH  folders searched for imports after those of -I,\n"
    "                              separated by : or ;\n"
    "  ROBDEF_PASSWORD             password of --user\n"
    "\nExit status: 0 nothing breaks, 1 something does, 2 used wrongly, or a version\n"
    "cannot be read, 3 a fault of robdef itself.\n";

std::string_view notes(Command command) {
  if (command == Command::breaking) return breaking_notes;
  return command >= Command::get ? live::help_notes : std::string_view();
}

bool is_recording(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string begin(recording_mark.size(), '\0');
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) &&
         begin == recording_mark;
}

bool is_sent(const std::string& version) { return is_recording(version) || is_url(version); }

std::vector<ast::NamedText> read_sent(const std::string& version, const Options& options,
                                      std::ostream& err) {
  try {
    return is_recording(version) ? recorded_definitions(version, err)
                                 : live::pulled_definitions(more(options).live, version);
  } catch (const rr::Error& error) {
    throw VersionError(rr::printable(error.message(), longest_message));
  } catch (const VersionError& error) {
    throw VersionError(rr::printable(error.what(), longest_message));
  }
}

CommandTable made() {
  CommandTable table = compiler_commands();
  for (CommandRow& row : table.commands) {
    if (row.command == Command::describe) {
      row.arguments = "[OPTION...] FILE... | URL [PATH]";
      row.description =
          "Prints what the definitions offer: types with their sizes, objects with their\n"
          "members, each with its documentation. With the URL of a service: what that\n"
          "offers, or one of its objects or members; --format=json prints JSON then.\n";
    } else if (row.command == Command::breaking) {
      row.description =
          "Compares two versions of definitions: what between old programs and new ones is\n"
          "refused or misread (wire), what no longer compiles with code that is generated\n"
          "anew (source), and what works but means something else (behaviour). Each of OLD\n"
          "and NEW is a file, - for standard input, or a folder of definitions; a revision\n"
          "of git and a path in it, such as HEAD~1:definitions; a recording; or the URL of\n"
          "a running service. docs/reference/breaking.md has all rules.\n";
    }
  }
  const auto add = [](auto& rows, const auto& others) {
    rows.insert(rows.end(), others.begin(), others.end());
  };
  add(table.commands, command_rows);
  add(table.commands, live::commands());
  add(table.options, option_rows);
  add(table.options, live::options());
  table.hidden = {live::completing_command()};
  table.missing = missing;
  table.run = run_command;
  table.notes = notes;
  table.is_sent = is_sent;
  table.read_sent = read_sent;
  return table;
}

}  // namespace

MoreOptions& more(Options& options) {
  if (!options.more.has_value()) options.more = MoreOptions();
  return std::any_cast<MoreOptions&>(options.more);
}

const MoreOptions& more(const Options& options) {
  static const MoreOptions none;
  const auto* const told = std::any_cast<MoreOptions>(&options.more);
  return told == nullptr ? none : *told;
}

const CommandTable& all_commands() {
  static const CommandTable table = made();
  return table;
}

}  // namespace robdef
