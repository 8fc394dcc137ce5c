// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "rr/error.hpp"
#include "rr/users.hpp"

namespace rr::stress {

/// Anybody with the right password, and everybody may lock.
class Everybody final : public Users {
 public:
  [[nodiscard]] User authenticate(const std::string& name,
                                  const std::map<std::string, VarValue>& credentials,
                                  const NodeId& /*node*/) const override {
    const auto password = credentials.find("password");
    if (password == credentials.end() || !(password->second == password_of(name))) {
      throw Error(ErrorCode::authentication_error, "wrong password");
    }
    return {name, {std::string(lock_privilege)}};
  }

  static VarValue password_of(const std::string& name) { return {"of " + name}; }
};

}  // namespace rr::stress
