// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/discovery/interfaces.hpp"

namespace rr::discovery {

std::vector<std::string> reachable_urls(const std::string& base,
                                        const std::vector<LocalAddress>& addresses) {
  const bool is_any_v4 = base.find("://0.0.0.0:") != std::string::npos;
  const bool is_any_v6 = base.find("://[::]:") != std::string::npos;
  if (!is_any_v4 && !is_any_v6) {
    const std::size_t scope = base.find('%');
    if (scope == std::string::npos) return {base};
    return {base.substr(0, scope) + base.substr(base.find(']', scope))};
  }
  std::vector<std::string> urls;
  for (const LocalAddress& address : addresses) {
    if (address.is_v6() != is_any_v6) continue;
    urls.push_back(base.substr(0, base.find("://") + 3) + address.host() +
                   base.substr(base.rfind(':')));
  }
  return urls;
}

}  // namespace rr::discovery
