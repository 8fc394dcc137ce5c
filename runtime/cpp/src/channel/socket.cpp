// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/socket.hpp"

#include <set>

#include "rr/error.hpp"
#include "runtime/cpp/src/platform/interfaces.hpp"

namespace rr::channel {
namespace {

using platform::IpAddress;
using platform::LookUp;

// One address for each interface that is up, for a link-local address that names none.
std::vector<Address> with_each_scope(const Address& address, IpAddress ip) {
  std::set<unsigned> scopes;
  for (const platform::LocalAddress& local : platform::local_addresses()) {
    if (local.is_v6()) scopes.insert(local.interface_number);
  }
  std::vector<Address> addresses;
  for (const unsigned scope : scopes) {
    ip.scope = scope;
    addresses.push_back(platform::address_of(ip, address.port()));
  }
  return addresses;
}

}  // namespace

std::vector<Address> resolve(const std::string& host, std::uint16_t port) {
  // Digits first: they need no name server, whose configuration would be read otherwise.
  std::vector<Address> found = platform::look_up(host, LookUp::digits);
  if (found.empty()) found = platform::look_up(host, LookUp::configured);
  // Without any interface but the loopback there is no configured family for `localhost`.
  if (found.empty()) found = platform::look_up(host, LookUp::all);
  if (found.empty()) {
    throw Error(ErrorCode::connection_error, "cannot find the host `" + host + "`");
  }
  std::vector<Address> addresses;
  for (Address& address : found) {
    address.set_port(port);
    const auto ip = address.ip();
    if (ip && ip->is_link_local() && ip->scope == 0) {
      const std::vector<Address> scoped = with_each_scope(address, *ip);
      addresses.insert(addresses.end(), scoped.begin(), scoped.end());
    } else {
      addresses.push_back(address);
    }
  }
  return addresses;
}

std::vector<Address> resolve_for_listening(const std::string& host, std::uint16_t port) {
  const bool is_any = host.empty() || host == "*";
  const bool is_own = host == "localhost";  // which needs nobody to look it up
  std::vector<Address> addresses =
      is_any || is_own ? platform::look_up({}, is_any ? LookUp::everywhere : LookUp::own)
                       : resolve(host, port);
  for (Address& address : addresses) address.set_port(port);
  return addresses;
}

std::string url_of(const Address& address, std::string_view scheme) {
  if (address.size == 0 || address.family() == Family::local) return {};
  return std::string(scheme) + "://" + address.text();
}

}  // namespace rr::channel
