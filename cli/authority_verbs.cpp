// SPDX-License-Identifier: Apache-2.0
#include "cli/authority_verbs.hpp"

#include <array>

#include "cli/options.hpp"

namespace robdef {
namespace {

using Verb = AuthorityVerb;

constexpr std::array verbs = {
    AuthorityVerbRow{Verb::init, "init", "DIR"},
    AuthorityVerbRow{Verb::issue, "issue", "NODE"},
    AuthorityVerbRow{Verb::request, "request", "NODE"},
    AuthorityVerbRow{Verb::sign, "sign", "FILE"},
    AuthorityVerbRow{Verb::revoke, "revoke", "NODE|SERIAL|FILE"},
    AuthorityVerbRow{Verb::refresh, "refresh", "", false},
    AuthorityVerbRow{Verb::list, "list", "NODE", false},
    AuthorityVerbRow{Verb::passphrase, "passphrase", "", false},
};

// `init DIR`, `issue NODE`, and so on.
std::string known_verbs() {
  std::string text;
  for (const AuthorityVerbRow& row : verbs) {
    text += text.empty() ? "`" : &row == &verbs.back() ? " or `" : ", `";
    text += row.name;
    if (row.needs_object) text += ' ' + std::string(row.object);
    text += '`';
  }
  return text;
}

std::string misplaced(const AuthorityVerbRow& row, const AuthorityOptions& options) {
  const Verb verb = row.verb;
  const bool issues = verb == Verb::issue || verb == Verb::sign;
  const auto unless = [&](bool fits, std::string_view option) {
    return fits ? std::string()
                : "`ca " + std::string(row.name) + "` takes no `" + std::string(option) + "`";
  };
  std::string wrong;
  const auto look = [&](bool is_given, bool fits, std::string_view option) {
    if (wrong.empty() && is_given) wrong = unless(fits, option);
  };
  look(options.days.has_value(), issues || verb == Verb::init, "--days");
  look(options.list_days.has_value(), verb == Verb::init || verb == Verb::refresh, "--list-days");
  look(!options.name.empty(), issues || verb == Verb::init, "--name");
  look(options.output != ".", verb == Verb::request, "--output");
  look(options.has_passphrase, verb == Verb::init, "--passphrase");
  look(options.is_renewal, verb == Verb::issue || verb == Verb::request, "--renew");
  look(options.takes_new_key, verb == Verb::issue, "--new-key");
  look(options.revokes_earlier, issues, "--revoke-old");
  look(!options.passphrase_file.empty(), verb != Verb::request && verb != Verb::list,
       "--passphrase-file");
  if (wrong.empty() && options.takes_new_key && !options.is_renewal) {
    return "`--new-key` needs `--renew`; without that a certificate has a new key anyway";
  }
  return wrong;
}

}  // namespace

const AuthorityVerbRow* find_authority_verb(std::string_view name) {
  for (const AuthorityVerbRow& row : verbs) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

std::string missing_for_authority(const Options& options) {
  if (options.inputs.empty()) return "give " + known_verbs();
  const AuthorityVerbRow* const row = find_authority_verb(options.inputs.front());
  if (row == nullptr) {
    return "`ca` knows " + known_verbs() + ", not `" + options.inputs.front() + "`";
  }
  const std::size_t most = row->object.empty() ? 1 : 2;
  if (options.inputs.size() > most || (row->needs_object && options.inputs.size() < 2)) {
    return "give `" + std::string(row->name) +
           (row->object.empty() ? ""
                                : (row->needs_object ? " " : " [") + std::string(row->object)) +
           (row->needs_object || row->object.empty() ? "`" : "]`");
  }
  if (options.is_json && row->verb != Verb::list) return "`--json` belongs to `ca list`";
  return misplaced(*row, more(options).authority);
}

}  // namespace robdef
