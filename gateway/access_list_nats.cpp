// SPDX-License-Identifier: Apache-2.0
// Access lists for servers of NATS.
#include <algorithm>
#include <set>

#include "gateway/access_list.hpp"
#include "gateway/fleet.hpp"
#include "gateway/kept_stream.hpp"
#include "gateway/nats_subjects.hpp"
#include "gateway/topics.hpp"
#include "rr/error.hpp"

namespace rr::gateway {
namespace {

using Subjects = std::set<std::string>;

/// With the name of the user in place of `%u`.
std::string named(std::string topic, const std::string& user) {
  const std::size_t at = topic.find(any_user);
  return at == std::string::npos ? topic : topic.replace(at, any_user.size(), user);
}

/// All subjects of a filter, with those of the beats of lives.
Subjects subjects_of(const std::string& filter) {
  Subjects all;
  for (const std::string& subject : subjects_of_filter(filter)) all.insert(subject);
  if (is_life_topic(filter)) all.insert(subjects_of_filter(beat_topic(filter))[0]);
  return all;
}

struct UserSubjects {
  Subjects publish;
  Subjects subscribe;
  Subjects denied;  ///< to subscribe to
};

/// A right to `rr.hall.r1.arm.*` lets a user subscribe to `rr.hall.r1.arm.>` as well: the server
/// compares the letters. All values there are for everybody, but requests are not.
void deny_requests(UserSubjects& all, const AccessRights& rights) {
  for (const std::string& topic : rights.receive) {
    if (!topic.ends_with("/+")) continue;
    const std::string object = topic.substr(0, topic.size() - 2);
    for (const Verb verb : all_verbs) {
      const std::string requests = subject_of(object + "/$" + std::string(verb_name(verb))) + ".>";
      if (!all.subscribe.contains(requests)) all.denied.insert(requests);
    }
  }
}

/// Those that retain messages may make the stream.
void add_rights(UserSubjects& all, const AccessRights& rights, const std::string& user) {
  for (const std::string& topic : rights.publish) {
    for (const std::string& subject : subjects_of(named(topic, user))) {
      all.publish.insert(subject);
      if (!may_be_retained(topic) || !topic.ends_with("/#")) continue;
      all.publish.insert(kept_subject(subject).value_or(subject));
      all.publish.insert(stream_create_subject());
    }
  }
  for (const std::string& topic : rights.receive) {
    for (const std::string& subject : subjects_of(named(topic, user))) {
      all.subscribe.insert(subject);
      const auto kept = kept_subject(subject);
      if (kept && may_be_retained(topic)) all.publish.insert(reader_create_subject("*", *kept));
    }
  }
}

std::string subject_list(const Subjects& subjects) {
  std::string text;
  for (const std::string& subject : subjects) {
    text += (text.empty() ? "" : ",") + std::string("\n        \"") + subject + "\"";
  }
  return "[" + text + "]";
}

std::string user_text(const std::string& user, const UserSubjects& subjects) {
  return "    {user: \"" + user + "\", password: $password_" + user +
         ", permissions: {\n      publish: " + subject_list(subjects.publish) +
         "\n      subscribe: " +
         (subjects.denied.empty() ? subject_list(subjects.subscribe)
                                  : "{allow: " + subject_list(subjects.subscribe) +
                                        ", deny: " + subject_list(subjects.denied) + "}") +
         "}}\n";
}

}  // namespace

std::string nats_authorization(const AccessList& list, const std::vector<std::string>& others,
                               const std::vector<std::string>& watchers) {
  std::set<std::string> users(others.begin(), others.end());
  users.insert(watchers.begin(), watchers.end());
  for (const auto& [user, rights] : list.users) users.insert(user);
  std::string text = "include passwords.conf\nauthorization {\n  users: [\n";
  for (const std::string& user : users) {
    // The name stands in the configuration and in subjects.
    if (!is_level_name(user)) {
      throw Error(ErrorCode::invalid_configuration,
                  "`" + user + "` is no user for NATS: 1 to 64 letters, digits, `_` or `-`");
    }
    UserSubjects subjects;
    add_rights(subjects, list.everybody, user);
    const auto own = list.users.find(user);
    if (own != list.users.end()) add_rights(subjects, own->second, user);
    // When all that the user may receive is known.
    deny_requests(subjects, list.everybody);
    if (own != list.users.end()) deny_requests(subjects, own->second);
    if (std::ranges::find(watchers, user) != watchers.end()) {
      const auto filters = Fleet::filters();
      add_rights(subjects, {{}, {filters.begin(), filters.end()}}, user);
    }
    // What the carrier itself asks and hears.
    const std::string inbox = inbox_prefix(user) + ".>";
    subjects.publish.insert(inbox);
    subjects.subscribe.insert(inbox);
    text += user_text(user, subjects);
  }
  return text + "  ]\n}\n";
}

}  // namespace rr::gateway
