// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "gateway/testing/folder.hpp"

namespace rr::gateway::testing {

/// A certificate authority that is made for a test.
class TestAuthority {
 public:
  explicit TestAuthority(const std::string& name = "Ours") {
    run(request + " -x509 -days 2 -subj '/CN=" + name + "'" + " -keyout " + path("ca.key") +
        " -out " + file());
  }

  /// Its certificate.
  [[nodiscard]] std::string file() const { return path("ca.pem"); }
  /// A certificate with its key in the same file. `names` as `DNS:hub,IP:127.0.0.1`; `subject` is
  /// the common name. Days of less than nothing make one that has run out.
  [[nodiscard]] std::string issue(const std::string& subject, const std::string& names,
                                  int days = 2) const {
    const std::string to = path(subject);
    run(request + " -subj '/CN=" + subject + "' -keyout " + to + ".key -out " + to + ".csr");
    run("printf 'subjectAltName=" + names + "' >" + to + ".names");
    run("openssl x509 -req -in " + to + ".csr -CA " + file() + " -CAkey " + path("ca.key") +
        " -CAcreateserial -days " + std::to_string(days) + " -extfile " + to + ".names -out " + to +
        ".pem");
    run("cat " + to + ".key >> " + to + ".pem");
    return to + ".pem";
  }

 private:
  inline static const std::string request =
      "openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes";

  [[nodiscard]] std::string path(const std::string& name) const {
    return folder_.path() + "/" + name;
  }
  static void run(const std::string& command) {
    if (std::system((command + " 2>/dev/null").c_str()) != 0) {
      throw std::runtime_error("no certificate was made: " + command);
    }
  }

  Folder folder_;
};

}  // namespace rr::gateway::testing
