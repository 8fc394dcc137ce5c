// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/authority.hpp"

#include <fstream>
#include <optional>
#include <ostream>
#include <rr/authority.hpp>
#include <rr/error.hpp>
#include <rr/node_id.hpp>
#include <string>

namespace robdef {
namespace {

// An id, or the first word of a file.
std::optional<rr::NodeId> node_in(const std::string& text) {
  if (const auto id = rr::NodeId::parse(text)) return id;
  std::string word;
  std::ifstream(text) >> word;
  return rr::NodeId::parse(word);
}

}  // namespace

ExitStatus run_authority(const Options& options, std::ostream& out, std::ostream& err) {
  const std::string& verb = options.inputs.front();
  const std::string& object = options.inputs.back();
  using Days = rr::Authority::Days;
  try {
    if (verb == "init") {
      const auto made =
          rr::Authority::create(object, "Robdef nodes", Days(options.days.value_or(3650)));
      out << made.certificate_file() << '\n';
      return exit_fine;
    }
    if (verb != "issue" && verb != "revoke") {
      err << "robdef: `ca` knows `init`, `issue` and `revoke`, not `" << verb << "`\n";
      return exit_usage;
    }
    const auto node = node_in(object);
    if (!node || node->is_any()) {
      err << "robdef: `" << object << "` is no node id and no file that has one\n";
      return exit_usage;
    }
    rr::Authority authority(options.authority_folder);
    if (verb == "issue") {
      out << authority.issue(*node, Days(options.days.value_or(825))) << '\n';
    } else {
      authority.revoke(*node);
      out << authority.revocation_file() << '\n';
    }
    return exit_fine;
  } catch (const rr::Error& error) {
    err << "robdef: " << error.message() << '\n';
    return exit_errors;
  }
}

}  // namespace robdef
