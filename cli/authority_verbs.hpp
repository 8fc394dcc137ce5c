// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "compiler/driver/options.hpp"

/// What `robdef ca` can do, and with what.
namespace robdef {

enum class AuthorityVerb { init, issue, request, sign, revoke, refresh, list, passphrase };

struct AuthorityVerbRow {
  AuthorityVerb verb{};
  std::string_view name;
  std::string_view object;  ///< what it is done with; empty: nothing
  bool needs_object = true;
};

/// Null when there is none.
const AuthorityVerbRow* find_authority_verb(std::string_view name);

/// What is wrong with the arguments and options of `ca`; empty when nothing is.
std::string missing_for_authority(const Options& options);

}  // namespace robdef
