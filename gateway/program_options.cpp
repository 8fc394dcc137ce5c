// SPDX-License-Identifier: Apache-2.0
#include "gateway/program_options.hpp"

#include <map>
#include <utility>

#include "gateway/topics.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

[[noreturn]] void refuse_word(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, what + "; see robdef-gateway --help");
}

/// `site/node/service` or `site/node/service=name`.
ServedService served_service(const std::string& word) {
  const std::size_t equals = word.find('=');
  const std::string address = word.substr(0, equals);
  const std::size_t first = address.find('/');
  const std::size_t second = address.find('/', first + 1);
  if (first == std::string::npos || second == std::string::npos) {
    refuse_word("`" + word + "` is not of the form site/node/service");
  }
  ServedService service;
  service.address = {address.substr(0, first), address.substr(first + 1, second - first - 1),
                     address.substr(second + 1)};
  for (const std::string& level :
       {service.address.site, service.address.node, service.address.service}) {
    if (!is_level_name(level)) refuse_word("`" + word + "` is not of the form site/node/service");
  }
  service.name = equals == std::string::npos ? service.address.service : word.substr(equals + 1);
  return service;
}

class Words {
  using Files = std::map<std::string, std::string>;

 public:
  explicit Words(const std::vector<std::string>& words) : words_(words) {}

  ProgramOptions read() {
    while (at_ < words_.size()) take(words_[at_++]);
    if (options_.task == Task::serve) check_serve();
    if (options_.task != Task::serve && !(users_.empty() && rights_.empty())) {
      refuse_word("`--users` and `--rights` need `--serve`");
    }
    if (options_.task == Task::fleet && options_.broker.url.empty()) {
      refuse_word("`--fleet` needs `--broker`");
    }
    if (options_.is_json && options_.task != Task::fleet) refuse_word("`--json` is for `--fleet`");
    if (options_.task == Task::access_list && options_.export_files.empty()) {
      refuse_word("`--acl` needs export files");
    }
    if (!options_.list_watchers.empty() && options_.list_form != "nats") {
      refuse_word("`--watcher` is for `--acl nats`");
    }
    return std::move(options_);
  }

 private:
  using Task = ProgramOptions::Task;

  const std::string& value(const std::string& flag) {
    if (at_ == words_.size()) refuse_word("`" + flag + "` needs a value");
    return words_[at_++];
  }

  void take(const std::string& word) {
    if (word == "--help" || word == "--version") {
      options_.task = word == "--help" ? Task::help : Task::version;
      at_ = words_.size();
    } else if (word == "--serve") {
      options_.task = Task::serve;
      options_.server.services.push_back(served_service(value(word)));
    } else if (word == "--users") {
      add_file(users_, word);
    } else if (word == "--rights") {
      add_file(rights_, word);
    } else if (word == "--broker") {
      options_.broker.url = value(word);
    } else if (word == "--reader") {
      options_.server.reader = value(word);
    } else if (word == "--user") {
      options_.broker.user = value(word);
      options_.list_users.push_back(options_.broker.user);
    } else if (word == "--password-file") {
      options_.broker.password = read_secret(value(word));
    } else if (word == "--watcher") {
      options_.list_watchers.push_back(value(word));
    } else if (word == "--token-file") {
      options_.broker.token = read_secret(value(word));
    } else if (word == "--credentials") {
      options_.broker.credentials = value(word);
    } else if (word == "--authority") {
      options_.broker.authority = value(word);
    } else if (word == "--certificate") {
      options_.broker.certificate = value(word);
    } else if (word == "--key") {
      options_.broker.key = value(word);
    } else if (word == "--fleet") {
      options_.task = Task::fleet;
    } else if (word == "--json") {
      options_.is_json = true;
    } else if (word == "--acl") {
      options_.task = Task::access_list;
      options_.list_form = value(word);
      if (options_.list_form != "mosquitto" && options_.list_form != "nats") {
        refuse_word("`" + options_.list_form + "` is no form of access lists");
      }
    } else {
      take_file(word);
    }
  }

  /// `name=file`.
  void add_file(Files& files, const std::string& flag) {
    const std::string& word = value(flag);
    const std::size_t equals = word.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == word.size()) {
      refuse_word("`" + flag + " " + word + "` is not of the form name=file");
    }
    if (!files.emplace(word.substr(0, equals), word.substr(equals + 1)).second) {
      refuse_word("`" + flag + " " + word + "` is there twice");
    }
  }

  void take_file(const std::string& word) {
    const bool is_more = !options_.export_files.empty() && options_.task != Task::access_list;
    if (word.starts_with("-") || is_more) refuse_word("`" + word + "` is not expected");
    if (options_.task == Task::help) options_.task = Task::export_file;
    options_.export_files.push_back(word);
  }

  void check_serve() {
    if (!options_.export_files.empty())
      refuse_word("`" + options_.export_files[0] + "` is not expected");
    if (options_.broker.url.empty()) refuse_word("`--serve` needs `--broker`");
    if (!is_level_name(options_.server.reader))
      refuse_word("`--serve` needs `--reader` with a name");
    options_.server.user = options_.broker.user;
    for (ServedService& service : options_.server.services) {
      service.users_file = take_named(users_, service.name);
      service.rights_file = take_named(rights_, service.name);
    }
    for (const Files* rest : {&users_, &rights_}) {
      if (!rest->empty()) refuse_word("no service is served as `" + rest->begin()->first + "`");
    }
  }

  /// The file for a service, which is not among the rest then.
  static std::string take_named(Files& files, const std::string& name) {
    auto node = files.extract(name);
    return node.empty() ? std::string() : std::move(node.mapped());
  }

  const std::vector<std::string>& words_;
  std::size_t at_ = 0;
  Files users_;  // by the service's name here
  Files rights_;
  ProgramOptions options_;
};

}  // namespace

const char* const program_help =
    R"(Brings robots to a broker of MQTT 5 or NATS, and back: docs/howto/fleet.md.

  robdef-gateway FILE
      Exports services of a robot to a broker, as the export file says.
  robdef-gateway --serve SITE/NODE/SERVICE[=NAME] --broker URL --reader NAME
      Offers services of robots at a broker as ordinary services. Several --serve are allowed.
  robdef-gateway --acl mosquitto FILE...
  robdef-gateway --acl nats [--user NAME]... [--watcher NAME]... FILE...
      Prints the access list that the broker needs for these export files. That of NATS has the
      users of the files and those that are named; watchers may use --fleet.
  robdef-gateway --fleet --broker URL [--json]
      Prints which robots are alive, and how far their streams and readers are.

  --broker URL           mqtt://host:port or nats://host:port; mqtts:// or tls:// for TLS
  --reader NAME          the name by which export files declare this reader
  --users NAME=FILE      clients of the service NAME log in here, as users of the file
  --rights NAME=FILE     what these users may do at the service NAME
  --user NAME            user of the broker; without it the reader's name stands in topics
  --password-file FILE   that user's password
  --token-file FILE      NATS: a token in place of user and password
  --credentials FILE     NATS: credentials in place of user and password
  --authority FILE       certificate authorities of the broker; without it those of the system
  --certificate FILE     certificate of this side, where the broker asks for one
  --key FILE             its key, where that is not in the same file
  --robotraconteur-...   flags of the node that serves, as --robotraconteur-tcp-port=2355

It ends with SIGINT or SIGTERM.
)";

ProgramOptions read_options(const std::vector<std::string>& words) { return Words(words).read(); }

}  // namespace rr::gateway
