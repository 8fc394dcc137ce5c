// SPDX-License-Identifier: Apache-2.0
#include "cli/live/table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "cli/live/commands.hpp"
#include "cli/options.hpp"

namespace robdef::live {
namespace {

template <std::string LiveOptions::*member>
std::string take_text(Options& options, const std::string& value) {
  more(options).live.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <std::string TlsFiles::*member>
std::string take_tls_text(Options& options, const std::string& value) {
  more(options).live.tls.*member = value;
  return value.empty() ? "the value is empty" : "";
}

template <std::vector<std::string> TlsFiles::*member>
std::string take_file(Options& options, const std::string& value) {
  (more(options).live.tls.*member).push_back(value);
  return value.empty() ? "the value is empty" : "";
}

template <std::optional<std::chrono::milliseconds> LiveOptions::*member>
std::string take_seconds(Options& options, const std::string& value) {
  constexpr double most = 1e9;
  double seconds = 0;
  const char* const end = value.data() + value.size();
  const auto read = std::from_chars(value.data(), end, seconds);
  if (value.empty() || read.ec != std::errc() || read.ptr != end || !(seconds > 0) ||
      seconds > most) {
    return "`" + value + "` is no number of seconds";
  }
  const auto milliseconds = static_cast<std::int64_t>(seconds * 1000);
  more(options).live.*member = std::chrono::milliseconds(std::max<std::int64_t>(milliseconds, 1));
  return "";
}

std::optional<std::vector<std::uint64_t>> numbers_in(std::string_view text) {
  std::vector<std::uint64_t> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    const auto read = std::from_chars(at, end, numbers.emplace_back());
    if (read.ec != std::errc()) return std::nullopt;
    if (read.ptr == end) return numbers;
    if (*read.ptr != ',') return std::nullopt;
    at = read.ptr + 1;
  }
}

template <std::optional<std::vector<std::uint64_t>> LiveOptions::*member>
std::string take_numbers(Options& options, const std::string& value) {
  more(options).live.*member = numbers_in(value);
  return more(options).live.*member ? "" : "`" + value + "` is no list of numbers such as 0,2";
}

std::string take_limit(Options& options, const std::string& value) {
  const auto numbers = numbers_in(value);
  if (!numbers || numbers->size() != 1) return "`" + value + "` is no number";
  more(options).live.limit = numbers->front();
  return "";
}

constexpr std::array command_rows = {
    CommandRow{Command::get, "get", "[OPTION...] URL MEMBER...",
               "print the value of a member of a service",
               "Prints the value of a property, what a wire holds, or a part of a memory: JSON,\n"
               "a line for each MEMBER.\n"},
    CommandRow{Command::set, "set", "[OPTION...] URL MEMBER JSON", "set a member of a service",
               "Sets a property, pokes a value into a wire, or writes into a memory.\n"},
    CommandRow{Command::call, "call", "[OPTION...] URL MEMBER [JSON...]",
               "call a function of a service",
               "Calls a function with arguments by position, and prints the result as a line of\n"
               "JSON. A generator prints a line for each value; what it takes stands behind the\n"
               "arguments, one for each step, or comes from standard input: write - for that.\n"},
    CommandRow{Command::watch, "watch", "[OPTION...] URL MEMBER...",
               "print values of a service as they come",
               "Prints what wires, pipes and events send: an object of JSON a line, with the\n"
               "member, the sender's time where there is one, and the value. Goes on until it is\n"
               "interrupted. Says when the connection is lost, and connects again.\n"},
    CommandRow{Command::top, "top", "[OPTION...] URL [MEMBER...]",
               "show rates, clients and latencies of a service",
               "Prints a table every second: of each wire, pipe and event, those of the root\n"
               "object if none is named, how many values come and the newest; and where the node\n"
               "tells its metrics (--robotraconteur-metrics), clients, requests, errors and\n"
               "latencies. At a terminal one table replaces the other. Goes on until it is\n"
               "interrupted, and connects again.\n"},
    CommandRow{Command::connect, "connect", "[OPTION...] URL",
               "use a service by commands, at a prompt",
               "Reads commands from the terminal, where TAB completes members, or from a file\n"
               "or pipe: get, set, call, watch, ls, cd, describe, lock, unlock, help, quit.\n"},
};

constexpr CommandRow completing_row = {Command::complete, "complete",
                                       "[OPTION...] COMMAND URL [WORD]", "",
                                       "Prints what WORD may become as a member for a command, a\n"
                                       "line each. For the completion of shells.\n"};

constexpr CommandSet connecting = {Command::breaking, Command::describe, Command::get,
                                   Command::set,      Command::call,     Command::watch,
                                   Command::top,      Command::connect,  Command::complete};

constexpr CommandSet using_tls = {Command::breaking, Command::describe, Command::get,
                                  Command::set,      Command::call,     Command::watch,
                                  Command::top,      Command::connect,  Command::complete,
                                  Command::discover, Command::bridge};

constexpr std::array option_rows = {
    OptionRow{
        "--user", "", "NAME", connecting,
        "log in at the service at a URL; the password\nis that of --password-file, else of the"
        "\nenvironment, else asked for at the terminal",
        take_text<&LiveOptions::user>},
    OptionRow{"--password-file", "", "FILE", connecting,
              "the first line of this file is the password",
              take_text<&LiveOptions::password_file>},
    OptionRow{"--timeout", "", "SECONDS", connecting,
              "how long to wait for an answer of the service;\ndefault: 15, and 5 to connect",
              take_seconds<&LiveOptions::timeout>},
    OptionRow{"--tls-authority", "", "FILE", using_tls,
              "trust nodes with certificates of this authority,\nPEM; may be repeated",
              take_file<&TlsFiles::authorities>},
    OptionRow{"--tls-revocation", "", "FILE", using_tls,
              "refuse the certificates on this list, PEM; may be\nrepeated",
              take_file<&TlsFiles::revocations>},
    OptionRow{"--tls-certificate", "", "FILE", using_tls,
              "be the node of this certificate, PEM or .p12",
              take_tls_text<&TlsFiles::certificate>},
    OptionRow{"--tls-key", "", "FILE", using_tls, "its key, if it is not in the same file",
              take_tls_text<&TlsFiles::key>},
    OptionRow{"--require-tls", "", "", using_tls,
              "connect to nobody, and let nobody in, without\nTLS",
              [](Options& taken, const std::string&) {
                more(taken).live.tls.is_required = true;
                return std::string();
              }},
    OptionRow{"--at",
              "",
              "NUMBERS",
              {Command::get, Command::set},
              "where in a memory, one number a dimension:\n0,2; default: the beginning",
              take_numbers<&LiveOptions::position>},
    OptionRow{"--count",
              "",
              "NUMBERS",
              {Command::get},
              "how much of a memory, likewise; default: all\nfrom there on, 64 MiB at most",
              take_numbers<&LiveOptions::counts>},
    OptionRow{"--count",
              "",
              "NUMBER",
              {Command::call, Command::watch, Command::top},
              "end after so many values; top: tables",
              take_limit},
    OptionRow{"--for",
              "",
              "SECONDS",
              {Command::watch, Command::top},
              "end after this time",
              take_seconds<&LiveOptions::duration>},
    OptionRow{"--every",
              "",
              "SECONDS",
              {Command::top},
              "time between two tables; default: 1",
              take_seconds<&LiveOptions::period>},
};

}  // namespace

const std::string_view help_notes =
    "\nMEMBER begins at the service's root object and goes through objrefs:\n"
    "lights[0].lamp.color. Values are JSON (docs/howto/dynamic.md), so a string is\n"
    "'\"text\"'.\n"
    "\nEnvironment:\n"
    "  ROBDEF_PASSWORD  password of --user\n"
    "\nExit status: 0 fine, 1 errors, 2 used wrongly, 3 a fault of robdef itself.\n";

std::span<const CommandRow> commands() { return command_rows; }
std::span<const OptionRow> options() { return option_rows; }
const CommandRow& completing_command() { return completing_row; }

std::string missing_to_connect(const Options& options) {
  if (!more(options).live.password_file.empty() && more(options).live.user.empty()) {
    return "`--password-file` needs `--user`";
  }
  if (!more(options).live.tls.key.empty() && more(options).live.tls.certificate.empty()) {
    return "`--tls-key` needs `--tls-certificate`";
  }
  return "";
}

std::string missing(const Options& options) {
  const std::size_t count = options.inputs.size();
  const bool completes = options.command == Command::complete;
  const std::size_t at = completes ? 1 : 0;
  if (count <= at || !is_url(options.inputs[at])) {
    return (count <= at ? "no URL given" : "`" + options.inputs[at] + "` is no URL") +
           std::string("; an example: rr+tcp://localhost:6257/?service=mount");
  }
  if (std::string complaint = missing_to_connect(options); !complaint.empty()) return complaint;
  switch (options.command) {
    case Command::get:
    case Command::call:
    case Command::watch:
      return count < 2 ? "no member given" : "";
    case Command::set:
      return count == 3 ? "" : "give a member and a value";
    case Command::connect:
      return count == 1 ? "" : "one URL at a time";
    case Command::describe:
      return count <= 2 ? "" : "give one path at a time";
    case Command::complete:
      return count <= 3 ? "" : "give one word at a time";
    default:
      return "";
  }
}

}  // namespace robdef::live
