// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/platform/interfaces.hpp"

namespace rr::platform {

bool LocalAddress::is_loopback() const { return address.ip().value_or(IpAddress()).is_loopback(); }

bool LocalAddress::is_link_local() const {
  return address.ip().value_or(IpAddress()).is_link_local();
}

std::string LocalAddress::host() const {
  const std::string text = address.ip().value_or(IpAddress()).text();
  return is_v6() ? "[" + text + "]" : text;
}

}  // namespace rr::platform
