// SPDX-License-Identifier: Apache-2.0
#include "gateway/access_list.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/topics.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

struct VerbAccess {
  Verb verb;
  unsigned access;  // any of these
};
constexpr std::array<VerbAccess, 9> verbs_of_members{{{Verb::get, reading},
                                                      {Verb::stream, reading},
                                                      {Verb::confirm, reading},
                                                      {Verb::set, writing},
                                                      {Verb::poke, writing},
                                                      {Verb::send, writing},
                                                      {Verb::call, calling},
                                                      {Verb::next, calling},
                                                      {Verb::connect, reading | writing}}};

/// A level of a filter for a pattern of an export file.
std::string level_of(const std::string& pattern) {
  return pattern.find('*') == std::string::npos ? pattern : "+";
}

/// Each path from the first step of a rule's path to the whole of it, as levels.
std::vector<std::string> path_prefixes(const std::string& path) {
  std::vector<std::string> prefixes;
  std::string levels;
  for (std::size_t begin = 0; begin < path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    levels += "/" + level_of(path.substr(begin, end - begin));
    prefixes.push_back(levels);
    begin = end + 1;
  }
  return prefixes;
}

class Collector {
 public:
  void add(const ExportFile& file) {
    const std::string& robot = file.broker.user;
    const std::string name = file.site + "/" + file.node;
    if (robot.empty()) {
      throw Error(ErrorCode::invalid_configuration, name + ": `broker.user` is missing");
    }
    if (!robots_.insert(robot).second) {
      throw Error(ErrorCode::invalid_configuration,
                  name + ": another robot has the user `" + robot + "`, too");
    }
    const std::string node = node_topic(file.site, file.node);
    AccessRights& own = list_.users[robot];
    own.publish.insert(node + "/#");
    own.receive.insert({node + "/$life", node + "/$claim"});
    for (const ExportedServiceOptions& service : file.services) {
      const ServiceAddress address{file.site, file.node, service.name};
      for (const Verb verb : all_verbs) own.receive.insert(request_filter(address, verb));
      for (const ExportRule& rule : service.rules) add_rule(address, rule, robot);
    }
  }

  AccessList take() { return std::move(list_); }

 private:
  void add_rule(const ServiceAddress& address, const ExportRule& rule, const std::string& robot) {
    if (rule.users.empty()) {
      add_rule_for(std::string(any_user), list_.everybody, address, rule);
      list_.users[robot].publish.insert("rr/$reply/#");
      add_values(list_.everybody, address, rule);
    }
    for (const std::string& user : rule.users) {
      add_rule_for(user, list_.users[user], address, rule);
      list_.users[robot].publish.insert(reply_topic(user, "#"));
    }
  }

  static void add_rule_for(const std::string& user, AccessRights& rights,
                           const ServiceAddress& address, const ExportRule& rule) {
    const std::string service = service_topic(address);
    const auto topic = [&](Verb verb, const std::string& levels) {
      return service + "/$" + std::string(verb_name(verb)) + "/" + user + levels;
    };
    const auto prefixes = path_prefixes(rule.path);
    const std::string path = prefixes.empty() ? std::string() : prefixes.back();
    for (const auto& [verb, access] : verbs_of_members) {
      if ((rule.access & access) == 0) continue;
      for (const std::string& member : rule.members) {
        rights.publish.insert(topic(verb, path + "/" + level_of(member)));
      }
    }
    if ((rule.access & locking) != 0) rights.publish.insert(topic(Verb::lock, path));
    // Locks and callbacks belong to sessions.
    if ((rule.access & (locking | calling)) != 0) rights.publish.insert(topic(Verb::session, ""));
    for (const std::string& prefix : prefixes) rights.publish.insert(topic(Verb::object, prefix));
    rights.receive.insert({node_topic(address.site, address.node) + "/$life", service + "/$life",
                           service + "/$streams", service + "/$attributes", service + "/$closed",
                           service + "/$def/#", reply_topic(user, "#")});
  }

  /// Values, packets and events, which the gateway publishes for all users or not at all.
  static void add_values(AccessRights& rights, const ServiceAddress& address,
                         const ExportRule& rule) {
    if ((rule.access & reading) == 0 || rule.path.find('*') != std::string::npos) return;
    const auto prefixes = path_prefixes(rule.path);
    for (const std::string& member : rule.members) {
      rights.receive.insert(service_topic(address) + (prefixes.empty() ? "" : prefixes.back()) +
                            "/" + level_of(member));
    }
  }

  AccessList list_;
  std::set<std::string> robots_;
};

std::string mosquitto_lines(const AccessRights& rights, const std::string& word) {
  std::string text;
  for (const std::string& topic : rights.publish) text += word + " write " + topic + "\n";
  for (const std::string& topic : rights.receive) text += word + " read " + topic + "\n";
  return text;
}

}  // namespace

AccessList access_list(const std::vector<ExportFile>& files) {
  Collector collector;
  for (const ExportFile& file : files) collector.add(file);
  return collector.take();
}

std::string mosquitto_acl(const AccessList& list) {
  std::string text;
  for (const auto& [user, rights] : list.users) {
    text += "user " + user + "\n" + mosquitto_lines(rights, "topic") + "\n";
  }
  return text + mosquitto_lines(list.everybody, "pattern");
}

}  // namespace rr::gateway
