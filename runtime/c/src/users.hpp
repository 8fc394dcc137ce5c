// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "rr/users.hpp"
#include "runtime/c/include/rr.h"

struct rr_users {
  std::shared_ptr<const rr::Users> users;
};
