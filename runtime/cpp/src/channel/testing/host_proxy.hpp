// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

namespace rr::testing {

/// Makes the certificate of a host, `localhost`, with its key in the same file; signed by itself.
void make_host_certificate(const std::string& file);

/// A web server's front, as others put it before a node: TLS with a host's certificate outside, the
/// same bytes in clear to a port of this machine inside. One connection at a time.
class HostProxy {
 public:
  HostProxy(const std::string& certificate_file, std::uint16_t target);
  ~HostProxy();
  HostProxy(const HostProxy&) = delete;
  HostProxy& operator=(const HostProxy&) = delete;

  [[nodiscard]] std::uint16_t port() const { return port_; }

 private:
  struct Context;
  void serve();
  void pass(int descriptor);

  const std::unique_ptr<Context> context_;
  const std::uint16_t target_;
  int listening_ = -1;
  std::uint16_t port_ = 0;
  std::atomic<bool> is_ended_{false};
  std::thread thread_;
};

}  // namespace rr::testing
