// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

namespace robdef {

/// What `ca` is told.
struct AuthorityOptions {
  std::string folder = ".";      ///< of the authority
  std::optional<int> days;       ///< of a certificate; none: as usual
  std::optional<int> list_days;  ///< of the list of revoked certificates
  std::string name;              ///< of a certificate, or of the authority
  std::string output = ".";      ///< folder of a request
  std::string passphrase_file;   ///< empty: from the environment, or asked
  bool has_passphrase = false;   ///< init: ask for one
  bool is_renewal = false;       ///< for who has a certificate, and with its key
  bool takes_new_key = false;    ///< but with another key
  bool revokes_earlier = false;  ///< what was issued for the node before
};

}  // namespace robdef
