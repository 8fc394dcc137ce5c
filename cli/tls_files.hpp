// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <rr/options.hpp>
#include <string>
#include <vector>

namespace robdef {

/// What commands are told about TLS: files, as in rr::TlsOptions.
struct TlsFiles {
  std::vector<std::string> authorities;
  std::vector<std::string> revocations;
  std::string certificate;  ///< empty: none
  std::string key;          ///< empty: in the same file
  bool is_required = false;

  [[nodiscard]] rr::TlsOptions options() const {
    return {.certificate_file = certificate,
            .key_file = key,
            .authority_files = authorities,
            .revocation_files = revocations,
            .is_required = is_required};
  }
};

}  // namespace robdef
