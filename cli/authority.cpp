// SPDX-License-Identifier: Apache-2.0
#include "cli/authority.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <ostream>
#include <rr/authority.hpp>
#include <rr/error.hpp>
#include <rr/node_id.hpp>
#include <string>

#include "cli/authority_verbs.hpp"
#include "cli/options.hpp"
#include "cli/secret_words.hpp"
#include "compiler/output/json.hpp"

namespace robdef {
namespace {

using Days = rr::Authority::Days;
using Clock = std::chrono::system_clock;

constexpr const char* passphrase_variable = "ROBDEF_CA_PASSPHRASE";
constexpr const char* new_passphrase_variable = "ROBDEF_CA_NEW_PASSPHRASE";
constexpr int node_days = 825;
constexpr int authority_days = 3650;

struct UsageFault {
  std::string text;
};

std::string text_of(Clock::time_point time) {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(Clock::to_time_t(time)));
}

// An id, or the first word of a file.
std::optional<rr::NodeId> node_in(const std::string& text) {
  if (const auto id = rr::NodeId::parse(text)) return id;
  std::string word;
  std::ifstream(text) >> word;
  return rr::NodeId::parse(word);
}

rr::NodeId wanted_node(const std::string& text) {
  const auto node = node_in(text);
  if (!node || node->is_any())
    throw UsageFault{"`" + text + "` is no node id and no file that has one"};
  return *node;
}

bool is_certificate_file(const std::string& path) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("-----BEGIN CERTIFICATE-----")) return true;
  }
  return false;
}

std::string new_passphrase(const char* variable) {
  if (const char* const value = std::getenv(variable)) return value;
  const std::string otherwise = "no passphrase: set " + std::string(variable);
  std::string first = ask_silently("new passphrase", otherwise);
  if (first != ask_silently("again", otherwise)) {
    throw rr::Error(rr::ErrorCode::authentication_error, "these are two different passphrases");
  }
  return first;
}

void write_issued(JsonWriter& json, const rr::IssuedCertificate& issued, const std::string& state) {
  json.begin_object().member("serial", issued.serial).member("node", issued.node.text());
  json.member("name", issued.name).member("not_before", text_of(issued.not_before));
  json.member("not_after", text_of(issued.not_after)).member("state", state);
  if (issued.revoked) json.member("revoked", text_of(*issued.revoked));
  json.end_object();
}

std::string issued_line(const rr::IssuedCertificate& issued, const std::string& state) {
  std::string line = issued.serial + ' ' + issued.node.text() + ' ' + text_of(issued.not_before) +
                     ' ' + text_of(issued.not_after) + ' ' + state;
  if (!issued.name.empty()) line += ' ' + issued.name;
  return line;
}

// One run of `robdef ca`.
class AuthorityRun {
 public:
  AuthorityRun(const Options& options, std::ostream& out, std::ostream& err)
      : options_(options),
        wanted_(more(options).authority),
        object_(options.inputs.size() > 1 ? options.inputs[1] : std::string()),
        out_(out),
        err_(err) {}

  void init() {
    std::string passphrase;
    if (!wanted_.passphrase_file.empty()) {
      passphrase = first_line(wanted_.passphrase_file);
    } else if (wanted_.has_passphrase || std::getenv(passphrase_variable) != nullptr) {
      passphrase = new_passphrase(passphrase_variable);
    }
    const bool is_empty_wanted = wanted_.has_passphrase || !wanted_.passphrase_file.empty();
    if (passphrase.empty() && is_empty_wanted) {
      throw rr::Error(rr::ErrorCode::invalid_argument, "the passphrase is empty");
    }
    rr::Authority made = rr::Authority::create(
        object_, wanted_.name.empty() ? "Robdef nodes" : wanted_.name,
        Days(more(options_).authority.days.value_or(authority_days)), passphrase);
    if (wanted_.list_days) made.refresh(Days(*wanted_.list_days));
    out_ << made.certificate_file() << '\n';
    if (passphrase.empty()) hint(object_);
  }

  void issue() {
    const rr::NodeId node = wanted_node(object_);
    rr::Authority authority = open();
    std::string file;
    if (wanted_.is_renewal) {
      using Key = rr::Authority::RenewedKey;
      file = authority.renew(node, wanted_.takes_new_key ? Key::another : Key::same, days(),
                             wanted_.name);
    } else {
      file = authority.issue(node, days(), wanted_.name);
    }
    end_issuing(authority, node, file);
  }

  void sign() {
    const auto [node, fingerprint] = rr::read_certificate_request(object_);
    err_ << "robdef: a certificate for node " << node.text() << ", public key SHA-256 "
         << fingerprint << '\n';
    rr::Authority authority = open();
    end_issuing(authority, node, authority.sign(object_, days(), wanted_.name));
  }

  void request() {
    const rr::CertificateRequest made =
        rr::request_certificate(wanted_.output, wanted_node(object_), wanted_.is_renewal);
    out_ << made.key_file << '\n' << made.request_file << '\n';
    err_ << "robdef: public key SHA-256 " << made.fingerprint << '\n';
  }

  void revoke() {
    rr::Authority authority = open();
    if (const auto id = rr::NodeId::parse(object_)) {
      authority.revoke(*id);
    } else if (is_certificate_file(object_)) {
      authority.revoke_file(object_);
    } else if (std::error_code error; std::filesystem::exists(object_, error)) {
      authority.revoke(wanted_node(object_));
    } else {
      authority.revoke_serial(object_);
    }
    say_list(authority);
  }

  void refresh() {
    rr::Authority authority = open();
    authority.refresh(wanted_.list_days ? std::optional(Days(*wanted_.list_days)) : std::nullopt);
    say_list(authority);
  }

  void list() {
    const rr::Authority authority(wanted_.folder);
    std::optional<rr::NodeId> only;
    if (!object_.empty()) only = wanted_node(object_);
    const auto now = Clock::now();
    JsonWriter json;
    json.begin_array();
    for (const rr::IssuedCertificate& each : authority.issued()) {
      if (only && each.node != *only) continue;
      const std::string state = each.revoked            ? "revoked"
                                : each.not_after <= now ? "expired"
                                                        : "valid";
      write_issued(json, each, state);
      if (!options_.is_json) out_ << issued_line(each, state) << '\n';
    }
    if (options_.is_json) out_ << std::move(json.end_array()).text();
    const auto end = authority.list_runs_out();
    err_ << "robdef: the list of revoked certificates is valid until " << text_of(end)
         << (end <= now ? ", which is over: `robdef ca refresh`" : "") << '\n';
  }

  void passphrase() {
    rr::Authority authority = open(false);
    const std::string chosen = new_passphrase(new_passphrase_variable);
    authority.set_passphrase(chosen);
    out_ << wanted_.folder << "/ca.key\n";
    if (chosen.empty()) hint(wanted_.folder);
  }

 private:
  // Asks before the folder is locked.
  rr::Authority open(bool hints = true) {
    if (!rr::Authority::has_passphrase(wanted_.folder)) {
      rr::Authority authority(wanted_.folder);
      if (hints) hint(wanted_.folder);
      return authority;
    }
    std::string passphrase;
    if (!wanted_.passphrase_file.empty()) {
      passphrase = first_line(wanted_.passphrase_file);
    } else if (const char* const value = std::getenv(passphrase_variable)) {
      passphrase = value;
    } else {
      passphrase = ask_silently(
          "passphrase of " + wanted_.folder + "/ca.key",
          "no passphrase: give `--passphrase-file`, or set " + std::string(passphrase_variable));
    }
    return rr::Authority(wanted_.folder, std::move(passphrase));
  }

  void end_issuing(rr::Authority& authority, const rr::NodeId& node, const std::string& file) {
    out_ << file << '\n';
    if (!wanted_.revokes_earlier) return;
    authority.revoke_earlier(node);
    out_ << authority.revocation_file() << '\n';
  }

  void say_list(const rr::Authority& authority) {
    out_ << authority.revocation_file() << '\n';
    err_ << "robdef: valid until " << text_of(authority.list_runs_out())
         << "; nodes refuse connections then, unless they get a newer list\n";
  }

  void hint(const std::string& folder) {
    err_ << "robdef: `" << folder << "/ca.key` has no passphrase; `robdef ca passphrase --ca "
         << folder << "` gives it one\n";
  }

  [[nodiscard]] Days days() const { return Days(wanted_.days.value_or(node_days)); }

  const Options& options_;
  const AuthorityOptions& wanted_;
  const std::string object_;
  std::ostream& out_;
  std::ostream& err_;
};

void run_verb(AuthorityVerb verb, AuthorityRun& run) {
  switch (verb) {
    case AuthorityVerb::init:
      return run.init();
    case AuthorityVerb::issue:
      return run.issue();
    case AuthorityVerb::request:
      return run.request();
    case AuthorityVerb::sign:
      return run.sign();
    case AuthorityVerb::revoke:
      return run.revoke();
    case AuthorityVerb::refresh:
      return run.refresh();
    case AuthorityVerb::list:
      return run.list();
    case AuthorityVerb::passphrase:
      return run.passphrase();
  }
}

}  // namespace

ExitStatus run_authority(const Options& options, std::ostream& out, std::ostream& err) {
  try {
    AuthorityRun run(options, out, err);
    run_verb(find_authority_verb(options.inputs.front())->verb, run);
    return exit_fine;
  } catch (const UsageFault& fault) {
    err << "robdef: " << fault.text << '\n';
    return exit_usage;
  } catch (const rr::Error& error) {
    err << "robdef: " << error.message() << '\n';
    return exit_errors;
  }
}

}  // namespace robdef
