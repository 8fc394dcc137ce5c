// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/harness/broker.hpp"
#include "conformance/harness/captures.hpp"
#include "conformance/harness/channels.hpp"
#include "conformance/harness/recorder.hpp"
#include "conformance/harness/suite.hpp"

namespace {

constexpr std::string_view usage =
    R"(usage: conformance_harness play --captures DIR (--runner PROGRAM | --connect HOST:PORT | --listen PORT)
                           [--language NAME] [--roles ROLES] [--jobs N] [--only REGEX] [--before COMMAND]
                           [--channels NAMES] [--gateway PROGRAM] [--expected FILE]
                           [--deviations FILE | --borrowed-deviations FILE] [--json FILE]
       conformance_harness definitions --captures DIR --output DIR
       conformance_harness record --captures DIR --runner PROGRAM --plan NAME --version v2|v4|v4st

play: plays a folder of captures. With --runner, a language's runner is the service and the client, and
  decodes and encodes; with --connect, a service that runs elsewhere is tested, and COMMAND (a shell
  command) brings it to its first state before each scenario; with --listen, a client. Deviations are
  borrowed when the list was written for other captures: not each of them must occur.
  --channels are those that a runner is played over, tcp without it: tcp local shm ws tls rrs+ws wss intra,
  and mqtt and nats, which need the program robdef-gateway (--gateway).
  --jobs scenarios are played with the runner at once (1).
  --roles leaves out what a language does not have: it plays these of decode, encode, service, client.
definitions: writes the service definitions of the folder, for a compiler.
record: plays a plan of the folder with a runner on both ends and writes it down as a scenario.
Exit code: 0 when all holds, 1 when not, 2 when used wrongly.
)";

struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

int port_of(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), port);
  if (error != std::errc{} || end != text.end() || port < 1 || port > 65535) {
    throw UsageError("no port: " + std::string(text));
  }
  return port;
}

std::size_t count_of(std::string_view text) {
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(text.begin(), text.end(), count);
  if (error != std::errc{} || end != text.end() || count < 1 || count > 256) {
    throw UsageError("no number of jobs: " + std::string(text));
  }
  return count;
}

rr::conformance::Address address_of(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) throw UsageError("no HOST:PORT: " + std::string(text));
  return {std::string(text.substr(0, colon)), port_of(text.substr(colon + 1))};
}

std::vector<std::string> channels_of(const std::string& text) {
  const std::vector<std::string>& known = rr::conformance::channel_names();
  std::vector<std::string> channels;
  std::istringstream words(text);
  for (std::string word; words >> word; channels.push_back(word)) {
    if (std::ranges::find(known, word) == known.end()) throw UsageError("no channel: " + word);
  }
  if (channels.empty()) throw UsageError("--channels names none");
  return channels;
}

// `client`, or several with blanks between them.
std::vector<rr::conformance::Role> roles_of(const std::string& text) {
  using rr::conformance::Role;
  std::vector<Role> roles;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::size_t before = roles.size();
    for (const Role role : {Role::decode, Role::encode, Role::service, Role::client}) {
      if (name_of(role) == word) roles.push_back(role);
    }
    if (roles.size() == before) throw UsageError("no role: " + word);
  }
  return roles;
}

struct CommandLine {
  rr::conformance::Options options;
  std::string output;
  std::string plan;
  std::string version;
};

void take_option(CommandLine& line, const std::string& name, const std::string& value) {
  rr::conformance::Options& options = line.options;
  const std::map<std::string_view, std::function<void()>> known = {
      {"--captures", [&] { options.captures = value; }},
      {"--output", [&] { line.output = value; }},
      {"--plan", [&] { line.plan = value; }},
      {"--version", [&] { line.version = value; }},
      {"--runner", [&] { options.runner = {value}; }},
      {"--roles", [&] { options.roles = roles_of(value); }},
      {"--channels", [&] { options.channels = channels_of(value); }},
      {"--gateway", [&] { options.gateway = value; }},
      {"--language", [&] { options.language = value; }},
      {"--connect", [&] { options.connect = address_of(value); }},
      {"--before", [&] { options.before = value; }},
      {"--listen", [&] { options.listen = port_of(value); }},
      {"--jobs", [&] { options.jobs = count_of(value); }},
      {"--only", [&] { options.only = value; }},
      {"--expected", [&] { options.expected = value; }},
      {"--deviations", [&] { options.deviations = value; }},
      {"--borrowed-deviations",
       [&] {
         options.deviations = value;
         options.deviations_are_borrowed = true;
       }},
      {"--json", [&] { options.json = value; }},
  };
  const auto option = known.find(name);
  if (option == known.end()) throw UsageError("unknown option " + name);
  option->second();
}

int run(const std::vector<std::string>& words) {
  if (words.empty()) throw UsageError("no command");
  CommandLine line;
  for (std::size_t i = 1; i < words.size(); i += 2) {
    if (i + 1 == words.size()) throw UsageError(words[i] + " needs a value");
    take_option(line, words[i], words[i + 1]);
  }
  const rr::conformance::Options& options = line.options;
  if (options.captures.empty()) throw UsageError("--captures is missing");
  if (words[0] == "definitions") {
    if (line.output.empty()) throw UsageError("--output is missing");
    for (const auto& file : rr::conformance::write_definitions(options.captures, line.output)) {
      std::cout << file << "\n";
    }
    return 0;
  }
  if (words[0] == "record") {
    if (line.plan.empty() || line.version.empty() || options.runner.empty()) {
      throw UsageError("record needs --plan, --version and --runner");
    }
    rr::conformance::record(options.captures, line.plan, line.version, options.runner);
    return 0;
  }
  if (words[0] != "play") throw UsageError("unknown command " + words[0]);
  if (options.runner.empty() && !options.connect && !options.listen) {
    throw UsageError("one of --runner, --connect and --listen is needed");
  }
  const bool needs_gateway = std::ranges::any_of(options.channels, rr::conformance::is_over_broker);
  if (needs_gateway && options.gateway.empty()) throw UsageError("--gateway is missing");
  return rr::conformance::run_suite(options) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const UsageError& error) {
    std::cerr << error.what() << "\n" << usage;
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "conformance: " << error.what() << "\n";
    return 1;
  }
}
