// SPDX-License-Identifier: Apache-2.0
// Serves a lamp by TLS only, to clients whose certificates are of the same authority.
#include <cstdint>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include "examples/serving/serving.hpp"
#include "experimental/lamp.hpp"
#include "rr/node.hpp"

namespace {

constexpr const char* usage =
    "usage: encrypted_service CERTIFICATE AUTHORITY REVOKED [KEY [ADDRESS PORT]]\n"
    "Serves a lamp until it is interrupted. CERTIFICATE (nodes/ID.pem), AUTHORITY (ca.pem) and\n"
    "REVOKED (revoked.pem) are files that `robdef ca` makes. KEY (ID.key) is that of a "
    "certificate\n"
    "which the node has requested, or empty. Without ADDRESS and PORT it listens on the loopback\n"
    "interface, at a port that is free.\n";

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4 && argc != 5 && argc != 7) {
    std::fputs(usage, stderr);
    return 2;
  }
  serving::Stay stay(0);
  rr::NodeOptions options;
  options.name = "lamp.host";
  options.tls = {.certificate_file = argv[1],
                 .key_file = argc > 4 ? argv[4] : "",
                 .authority_files = {argv[2]},
                 .revocation_files = {argv[3]},
                 .is_required = true,
                 .must_certify_clients = true};
  options.log = [](rr::LogLevel level, std::string_view text) {
    if (level >= rr::LogLevel::warning) std::cerr << "service: " << text << std::endl;
  };
  rr::Node node(options);
  const auto service =
      node.register_service("lamp", std::make_shared<experimental::lamp::LampDefault>());
  const std::string address = argc > 5 ? argv[5] : "127.0.0.1";
  const auto wanted = static_cast<std::uint16_t>(argc > 6 ? std::stoul(argv[6]) : 0);
  const int port = node.listen_tcp(wanted, address);
  serving::announce("rrs+tcp://" + address + ":" + std::to_string(port) +
                    "/?nodeid=" + node.id().text() + "&service=lamp");
  stay.wait_for_end();
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "encrypted_service: %s\n", error.what());
  return 1;
}
