// SPDX-License-Identifier: Apache-2.0
// Sets the lamp of the encrypted service.
#include <cstdio>
#include <exception>

#include "experimental/lamp.hpp"
#include "rr/node.hpp"

namespace {

constexpr const char* usage =
    "usage: encrypted_client URL AUTHORITY REVOKED [CERTIFICATE]\n"
    "Sets the lamp at URL to 0.75. AUTHORITY (ca.pem), REVOKED (revoked.pem) and CERTIFICATE\n"
    "(nodes/ID.pem) are files that `robdef ca` makes.\n";

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4 && argc != 5) {
    std::fputs(usage, stderr);
    return 2;
  }
  rr::NodeOptions options;
  options.tls = {.authority_files = {argv[2]}, .revocation_files = {argv[3]}};
  if (argc == 5) options.tls.certificate_file = argv[4];
  rr::Node node(options);
  const auto lamp = node.connect<experimental::lamp::LampStub>(argv[1]);
  lamp->set_brightness(0.75);
  std::printf("the lamp is at %g\n", lamp->get_brightness());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "encrypted_client: %s\n", error.what());
  return 1;
}
